#include "import/gzip.h"

#include "base/mem.h"
#include "base/text.h"

#include <assert.h>
#include <errno.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

#define PIECE (1u << 20)

struct gzip {
    const char *path;
    struct place at; /* who asked */
    int fd;
    size_t file_size;
    Bytef *packed; /* [PIECE] read and not unpacked yet; NULL: a plain file */
    char *piece;
    size_t size, capacity;
    z_stream z;
    bool ended;
};

static struct gzip *open_file(const char *path, const struct place *at, struct err *err)
{
    size_t size;
    int fd = text_open_file(path, &size, at, err);
    if (fd < 0)
        return NULL;
    struct gzip *g = mem_alloc(1, sizeof *g);
    g->path = path;
    g->at = at ? *at : (struct place){path, 0, 0};
    g->file_size = size;
    g->fd = fd;
    return g;
}

struct gzip *gzip_open(const char *path, const struct place *at, struct err *err)
{
    struct gzip *g = open_file(path, at, err);
    if (!g)
        return NULL;
    if (inflateInit2(&g->z, 16 + MAX_WBITS) == Z_OK) {
        g->packed = mem_alloc(PIECE, 1);
        return g;
    }
    err_set(err, ERR_IO, at, "no memory to unpack '%s'", path);
    gzip_close(g);
    return NULL;
}

struct gzip *gzip_open_plain(const char *path, const struct place *at, struct err *err)
{
    return open_file(path, at, err);
}

void gzip_close(struct gzip *g)
{
    if (!g)
        return;
    if (g->packed)
        inflateEnd(&g->z);
    close(g->fd);
    mem_free(g->packed);
    mem_free(g->piece);
    mem_free(g);
}

size_t gzip_size_most(const struct gzip *g)
{
    if (!g->packed)
        return g->file_size;
    return g->file_size > SIZE_MAX / GZIP_RATIO ? SIZE_MAX : g->file_size * GZIP_RATIO;
}

/* As many of `most` bytes as there still are; -1, with the error, if reading fails. */
static ssize_t read_some(struct gzip *g, void *to, size_t most, struct err *err)
{
    ssize_t n;
    do
        n = read(g->fd, to, most);
    while (n < 0 && errno == EINTR);
    if (n < 0)
        err_set(err, ERR_IO, &g->at, "cannot read '%s': %s", g->path, strerror(errno));
    return n;
}

/* Leaves zlib without input only at the end of the file. */
static bool feed(struct gzip *g, struct err *err)
{
    if (g->z.avail_in > 0)
        return true;
    ssize_t n = read_some(g, g->packed, PIECE, err);
    if (n < 0)
        return false;
    g->z.next_in = g->packed;
    g->z.avail_in = (uInt)n;
    return true;
}

/* Unpacks until the piece is full or all is through. A file may be several, one behind
 * the other. */
static bool unpack(struct gzip *g, struct err *err)
{
    while (g->z.avail_out > 0) {
        if (!feed(g, err))
            return false;
        int status = inflate(&g->z, Z_NO_FLUSH);
        if (status == Z_STREAM_END) {
            if (!feed(g, err))
                return false;
            g->ended = g->z.avail_in == 0;
            if (g->ended)
                return true;
            status = inflateReset(&g->z);
        }
        if (status != Z_OK)
            return err_set(err, ERR_SYNTAX, &g->at,
                           "cannot unpack '%s': it is cut short or no gzip file",
                           g->path);
    }
    return true;
}

static bool read_packed(struct gzip *g, size_t keep, struct err *err)
{
    g->z.next_out = (Bytef *)g->piece + keep;
    g->z.avail_out = PIECE;
    if (!unpack(g, err))
        return false;
    g->size += PIECE - g->z.avail_out;
    return true;
}

/* Fills the piece behind its first `keep` bytes. */
static bool read_plain(struct gzip *g, size_t keep, struct err *err)
{
    size_t got = 0;
    while (got < PIECE && !g->ended) {
        ssize_t n = read_some(g, g->piece + keep + got, PIECE - got, err);
        if (n < 0)
            return false;
        g->ended = n == 0;
        got += (size_t)n;
    }
    g->size += got;
    return true;
}

const char *gzip_more(struct gzip *g, size_t keep, size_t *size, struct err *err)
{
    assert(keep <= g->size);
    if (g->size > 0)
        memmove(g->piece, g->piece + (g->size - keep), keep);
    g->piece = mem_grow(g->piece, &g->capacity, keep + PIECE + 1, 1);
    g->size = keep;
    if (!g->ended && !(g->packed ? read_packed(g, keep, err) : read_plain(g, keep, err)))
        return NULL;
    g->piece[g->size] = '\0';
    *size = g->size;
    return g->piece;
}

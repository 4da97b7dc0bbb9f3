#include "import/gzip.h"

#include "base/mem.h"
#include "base/text.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#define PIECE (1u << 20)

struct gzip {
    const char *path;
    struct place at;           /* who asked */
    char *packed;              /* NULL: a plain file, read from fd */
    size_t packed_size, taken; /* of which so many went to zlib */
    int fd;
    char *piece;
    size_t size, capacity;
    z_stream z;
    bool ended;
};

struct gzip *gzip_open(const char *path, const struct place *at, struct err *err)
{
    size_t size;
    char *packed = text_read_file(path, &size, at, err);
    if (!packed)
        return NULL;
    struct gzip *g = mem_alloc(1, sizeof *g);
    g->path = path;
    g->at = at ? *at : (struct place){path, 0, 0};
    g->packed = packed;
    g->packed_size = size;
    if (inflateInit2(&g->z, 16 + MAX_WBITS) == Z_OK)
        return g;
    err_set(err, ERR_IO, at, "no memory to unpack '%s'", path);
    gzip_close(g);
    return NULL;
}

struct gzip *gzip_open_plain(const char *path, const struct place *at, struct err *err)
{
    struct stat info;
    /* Opening a FIFO would otherwise wait for a writer. */
    int fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0) {
        err_set(err, ERR_IO, at, "cannot open '%s': %s", path, strerror(errno));
        return NULL;
    }
    if (fstat(fd, &info) != 0 || !S_ISREG(info.st_mode)) {
        err_set(err, ERR_IO, at, "cannot read '%s': not a regular file%s", path,
                S_ISDIR(info.st_mode) ? " but a directory" : "");
        close(fd);
        return NULL;
    }
    struct gzip *g = mem_alloc(1, sizeof *g);
    g->path = path;
    g->at = at ? *at : (struct place){path, 0, 0};
    g->packed_size = (size_t)info.st_size;
    g->fd = fd;
    return g;
}

void gzip_close(struct gzip *g)
{
    if (!g)
        return;
    if (g->packed)
        inflateEnd(&g->z);
    else
        close(g->fd);
    mem_free(g->packed);
    mem_free(g->piece);
    mem_free(g);
}

size_t gzip_size_most(const struct gzip *g)
{
    if (!g->packed)
        return g->packed_size;
    return g->packed_size > SIZE_MAX / GZIP_RATIO ? SIZE_MAX
                                                  : g->packed_size * GZIP_RATIO;
}

/* zlib counts in 32 bits. */
static void feed(struct gzip *g)
{
    size_t left = g->packed_size - g->taken;
    if (g->z.avail_in > 0 || left == 0)
        return;
    uInt part = left < 1u << 30 ? (uInt)left : 1u << 30;
    g->z.next_in = (Bytef *)g->packed + g->taken;
    g->z.avail_in = part;
    g->taken += part;
}

/* Unpacks until the piece is full or all is through. A file may be several, one behind
 * the other. */
static bool unpack(struct gzip *g)
{
    while (g->z.avail_out > 0) {
        feed(g);
        int status = inflate(&g->z, Z_NO_FLUSH);
        if (status == Z_STREAM_END) {
            feed(g);
            g->ended = g->z.avail_in == 0;
            if (g->ended)
                return true;
            status = inflateReset(&g->z);
        }
        if (status != Z_OK)
            return false;
    }
    return true;
}

/* Fills the piece behind its first `keep` bytes. */
static bool read_plain(struct gzip *g, size_t keep, struct err *err)
{
    size_t got = 0;
    while (got < PIECE) {
        ssize_t n = read(g->fd, g->piece + keep + got, PIECE - got);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            return err_set(err, ERR_IO, &g->at, "cannot read '%s': %s", g->path,
                           strerror(errno));
        g->ended = n == 0;
        if (g->ended)
            break;
        got += (size_t)n;
    }
    g->size += got;
    return true;
}

static bool read_packed(struct gzip *g, size_t keep, struct err *err)
{
    g->z.next_out = (Bytef *)g->piece + keep;
    g->z.avail_out = PIECE;
    if (!unpack(g))
        return err_set(err, ERR_SYNTAX, &g->at,
                       "cannot unpack '%s': it is cut short or no gzip file", g->path);
    g->size += PIECE - g->z.avail_out;
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

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

/* The end of a packed file: its check sum and, in the last four bytes, its size. */
enum { TRAILER = 8 };

struct gzip {
    const char *path;
    struct place at; /* who asked */
    int fd;          /* zlib closes it */
    size_t file_size;
    gzFile file;
    char *piece;
    size_t size, capacity;
    uint64_t total; /* bytes that came out so far */
    bool packed, ended;
};

static bool fail(const struct gzip *g, int status, struct err *err)
{
    if (status == Z_ERRNO)
        return err_set(err, ERR_IO, &g->at, "cannot read '%s': %s", g->path,
                       strerror(errno));
    return err_set(err, ERR_SYNTAX, &g->at,
                   "cannot unpack '%s': it is cut short or no gzip file", g->path);
}

struct gzip *gzip_open(const char *path, const struct place *at, struct err *err)
{
    size_t size;
    int fd = text_open_file(path, &size, at, err);
    if (fd < 0)
        return NULL;
    gzFile file = gzdopen(fd, "rb");
    if (!file || gzbuffer(file, PIECE / 2) != 0) {
        file ? gzclose(file) : close(fd);
        err_set(err, ERR_IO, at, "no memory to unpack '%s'", path);
        return NULL;
    }
    struct gzip *g = mem_alloc(1, sizeof *g);
    g->path = path;
    g->at = at ? *at : (struct place){path, 0, 0};
    g->fd = fd;
    g->file_size = size;
    g->file = file;
    g->packed = !gzdirect(file);
    if (g->packed || !text_ends_with(path, ".gz"))
        return g;
    fail(g, Z_DATA_ERROR, err);
    gzip_close(g);
    return NULL;
}

void gzip_close(struct gzip *g)
{
    if (!g)
        return;
    gzclose(g->file);
    mem_free(g->piece);
    mem_free(g);
}

size_t gzip_size_most(const struct gzip *g)
{
    if (!g->packed)
        return g->file_size;
    return g->file_size > SIZE_MAX / GZIP_RATIO ? SIZE_MAX : g->file_size * GZIP_RATIO;
}

/* Whether the size in the last four bytes can be that of the last member. gzread ignores
 * what follows that member; this detects anything but zeros there. */
static bool trailer_fits(const struct gzip *g)
{
    unsigned char tail[4];
    if (!g->packed)
        return true;
    if (g->file_size < TRAILER ||
        pread(g->fd, tail, sizeof tail, (off_t)(g->file_size - sizeof tail)) !=
            (ssize_t)sizeof tail)
        return false;
    uint64_t member = 0;
    for (int i = 3; i >= 0; i--)
        member = member << 8 | tail[i];
    return member <= g->total;
}

/* Fills the piece behind its first `keep` bytes, or as far as there is anything. */
static bool fill(struct gzip *g, size_t keep, struct err *err)
{
    int status = Z_OK, got = gzread(g->file, g->piece + keep, PIECE);
    if (got < (int)PIECE)
        gzerror(g->file, &status);
    if (status != Z_OK)
        return fail(g, status, err);
    g->ended = got < (int)PIECE;
    g->size += (size_t)got;
    g->total += (uint64_t)got;
    return !g->ended || trailer_fits(g) || fail(g, Z_DATA_ERROR, err);
}

const char *gzip_more(struct gzip *g, size_t keep, size_t *size, struct err *err)
{
    assert(keep <= g->size);
    if (g->size > 0)
        memmove(g->piece, g->piece + (g->size - keep), keep);
    g->piece = mem_grow(g->piece, &g->capacity, keep + PIECE + 1, 1);
    g->size = keep;
    if (!g->ended && !fill(g, keep, err))
        return NULL;
    g->piece[g->size] = '\0';
    *size = g->size;
    return g->piece;
}

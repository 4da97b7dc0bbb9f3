#include "import/gzip.h"

#include "base/mem.h"
#include "base/text.h"

#include <assert.h>
#include <stdint.h>
#include <string.h>
#include <zlib.h>

#define PIECE (1u << 20)

struct gzip {
    const char *path;
    struct place at; /* who asked */
    char *packed;
    size_t packed_size, taken; /* of which so many went to zlib */
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

void gzip_close(struct gzip *g)
{
    if (!g)
        return;
    inflateEnd(&g->z);
    mem_free(g->packed);
    mem_free(g->piece);
    mem_free(g);
}

size_t gzip_size_most(const struct gzip *g)
{
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

const char *gzip_more(struct gzip *g, size_t keep, size_t *size, struct err *err)
{
    assert(keep <= g->size);
    if (g->size > 0)
        memmove(g->piece, g->piece + (g->size - keep), keep);
    g->piece = mem_grow(g->piece, &g->capacity, keep + PIECE + 1, 1);
    g->size = keep;
    if (!g->ended) {
        g->z.next_out = (Bytef *)g->piece + keep;
        g->z.avail_out = PIECE;
        if (!unpack(g)) {
            err_set(err, ERR_SYNTAX, &g->at,
                    "cannot unpack '%s': it is cut short or no gzip file", g->path);
            return NULL;
        }
        g->size += PIECE - g->z.avail_out;
    }
    g->piece[g->size] = '\0';
    *size = g->size;
    return g->piece;
}

/* Mitsuba's .serialized: one or more zlib streams, each a mesh behind a header of four
 * bytes, and at the end of the file the table of where they start. All little-endian. The
 * layout is that of Mitsuba's manual (version 3 has no names and 32-bit offsets). */
#include "import/import.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/gzip.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <string.h>
#include <zlib.h>

#define MAGIC 0x041c

enum flag {
    HAS_NORMALS = 0x0001,
    HAS_UV = 0x0002,
    HAS_COLOURS = 0x0008,
    FACE_NORMALS = 0x0010,
    IS_DOUBLE = 0x2000,
};

#define NAME_MOST 65536

struct reader {
    const char *file;
    const unsigned char *data;
    size_t size;
    z_stream z;
    bool is_double;
};

static bool fail(const struct reader *r, const char *message, struct err *err)
{
    struct place at = {r->file, 0, 0};
    return err_set(err, ERR_VALUE, &at, "%s", message);
}

/* `bytes` of a little-endian number. */
static uint64_t little(const unsigned char *p, int bytes)
{
    uint64_t value = 0;
    for (int i = bytes; i-- > 0;)
        value = value << 8 | p[i];
    return value;
}

static int offset_width(const struct reader *r)
{
    return little(r->data + 2, 2) == 3 ? 4 : 8;
}

/* Start and end of a mesh's zlib stream in the file. */
static bool find_stream(const struct reader *r, int index, size_t *start, size_t *end,
                        struct err *err)
{
    if (r->size < 8 || little(r->data, 2) != MAGIC)
        return fail(r, "this is no .serialized mesh file", err);
    uint64_t version = little(r->data + 2, 2);
    if (version != 3 && version != 4)
        return fail(r, "only the versions 3 and 4 of .serialized are read", err);
    uint64_t count = little(r->data + r->size - 4, 4);
    size_t width = (size_t)offset_width(r);
    if (count == 0 || count > (r->size - 4) / width)
        return fail(r, "truncated: the table of meshes at the end does not fit", err);
    if (index < 0 || (uint64_t)index >= count) {
        struct place at = {r->file, 0, 0};
        return err_set(err, ERR_VALUE, &at,
                       "there is no mesh of the shape_index %d, the file holds %llu "
                       "(counted from 0)",
                       index, (unsigned long long)count);
    }
    size_t table = r->size - 4 - width * (size_t)count;
    uint64_t at = little(r->data + table + width * (size_t)index, (int)width);
    if (table < 4 || at > table - 4)
        return fail(r, "truncated: a mesh starts behind the end", err);
    if (little(r->data + at, 2) != MAGIC || little(r->data + at + 2, 2) != version)
        return fail(r, "no mesh stands where the table says", err);
    *start = (size_t)at + 4;
    *end = table;
    return true;
}

static bool inflate_bytes(struct reader *r, void *to, size_t count, struct err *err)
{
    r->z.next_out = to;
    while (count > 0) {
        uInt part = count < (1u << 30) ? (uInt)count : 1u << 30;
        r->z.avail_out = part;
        int status = inflate(&r->z, Z_SYNC_FLUSH);
        if (status != Z_OK && status != Z_STREAM_END)
            return fail(r,
                        status == Z_BUF_ERROR ? "truncated: the mesh's data ends early"
                                              : "the compressed data is corrupt",
                        err);
        count -= part - r->z.avail_out;
        if (status == Z_STREAM_END && count > 0)
            return fail(r, "truncated: the mesh's data ends early", err);
    }
    r->z.next_out = NULL; /* owned by the caller */
    return true;
}

static bool read_integer(struct reader *r, int bytes, uint64_t *value, struct err *err)
{
    unsigned char raw[8];
    if (!inflate_bytes(r, raw, (size_t)bytes, err))
        return false;
    *value = little(raw, bytes);
    return true;
}

/* Skips the name; it can be of any length, as a megabyte of file could hold a name of a
 * gigabyte. */
static bool skip_name(struct reader *r, struct err *err)
{
    uint64_t c;
    for (int i = 0; i < NAME_MOST; i++) {
        if (!read_integer(r, 1, &c, err))
            return false;
        if (c == 0)
            return true;
    }
    return fail(r, "the name of the mesh does not end", err);
}

/* `count` numbers into `to`, or nowhere if it is NULL. nonfinite: what is no finite
 * number is 0. */
static bool read_floats(struct reader *r, float *to, size_t count, bool nonfinite,
                        struct err *err)
{
    unsigned char raw[8 * 512];
    size_t width = r->is_double ? 8 : 4;
    for (size_t done = 0; done < count;) {
        size_t part = count - done < 512 ? count - done : 512;
        if (!inflate_bytes(r, raw, part * width, err))
            return false;
        for (size_t i = 0; i < part && to; i++) {
            uint64_t bits = little(raw + width * i, (int)width);
            uint32_t bits32 = (uint32_t)bits;
            double wide;
            float narrow;
            memcpy(&wide, &bits, sizeof wide);
            memcpy(&narrow, &bits32, sizeof narrow);
            wide = r->is_double ? wide : (double)narrow;
            bool finite = fabs(wide) <= (double)FLT_MAX;
            if (!finite && !nonfinite)
                return fail(r, "a vertex is not finite in single precision", err);
            to[done + i] = finite ? (float)wide : 0.0f;
        }
        done += part;
    }
    return true;
}

static bool read_indices(struct reader *r, struct mesh *mesh, struct err *err)
{
    unsigned char raw[4 * 3];
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        if (!inflate_bytes(r, raw, sizeof raw, err))
            return false;
        for (size_t k = 0; k < 3; k++) {
            mesh->index[3 * i + k] = (uint32_t)little(raw + 4 * k, 4);
            if (mesh->index[3 * i + k] >= mesh->vertex_count)
                return fail(r, "a triangle names a vertex that is not there", err);
        }
    }
    return true;
}

/* Checks that the counts of the header are possible for a stream of this size; otherwise
 * a kilobyte could demand gigabytes. */
static bool check_counts(const struct reader *r, uint64_t flags, uint64_t vertices,
                         uint64_t triangles, struct err *err)
{
    uint64_t most = ((uint64_t)r->z.avail_in + 1) * GZIP_RATIO;
    uint64_t numbers = 3u + (flags & HAS_NORMALS ? 3u : 0u) + (flags & HAS_UV ? 2u : 0u) +
                       (flags & HAS_COLOURS ? 3u : 0u);
    if (vertices == 0 || triangles == 0)
        return fail(r, "the mesh is empty", err);
    if (vertices > UINT32_MAX - 1 || triangles > UINT32_MAX - 1)
        return fail(r, "more than 2^32 vertices or triangles are not read", err);
    if (vertices * numbers * (r->is_double ? 8 : 4) + triangles * 12 > most)
        return fail(r,
                    "truncated: the header claims more vertices and triangles than the "
                    "file can hold",
                    err);
    return true;
}

static struct mesh *read_mesh(struct reader *r, uint64_t flags, struct err *err)
{
    uint64_t vertices, triangles;
    if (!read_integer(r, 8, &vertices, err) || !read_integer(r, 8, &triangles, err) ||
        !check_counts(r, flags, vertices, triangles, err))
        return NULL;
    struct mesh *mesh = mesh_create((uint32_t)vertices, (uint32_t)triangles,
                                    flags & HAS_NORMALS, flags & HAS_UV);
    size_t count = (size_t)vertices;
    /* Normals that are not finite are mended by mesh_check. */
    if (read_floats(r, mesh->p, 3 * count, false, err) &&
        (!mesh->n || read_floats(r, mesh->n, 3 * count, true, err)) &&
        (!mesh->uv || read_floats(r, mesh->uv, 2 * count, false, err)) &&
        (!(flags & HAS_COLOURS) || read_floats(r, NULL, 3 * count, true, err)) &&
        read_indices(r, mesh, err))
        return mesh;
    mesh_destroy(mesh);
    return NULL;
}

static struct mesh *read_stream(struct reader *r, struct import_serialized_flags *out,
                                struct err *err)
{
    uint64_t flags;
    if (!read_integer(r, 4, &flags, err) || (offset_width(r) == 8 && !skip_name(r, err)))
        return NULL;
    /* Single precision unless the flag is set, as in Mitsuba. */
    r->is_double = flags & IS_DOUBLE;
    out->face_normals = flags & FACE_NORMALS;
    out->colours = flags & HAS_COLOURS;
    return read_mesh(r, flags, err);
}

struct mesh *import_serialized(const char *path, int index,
                               struct import_serialized_flags *flags,
                               const struct place *at, struct err *err)
{
    struct reader r = {.file = path};
    struct mesh *mesh = NULL;
    size_t start = 0, end = 0;
    char *data = text_read_file(path, &r.size, at, err);
    if (!data)
        return NULL;
    r.data = (const unsigned char *)data;
    if (!find_stream(&r, index, &start, &end, err)) {
        mem_free(data);
        return NULL;
    }
    r.z.next_in = (Bytef *)data + start;
    r.z.avail_in = (uInt)(end - start < UINT_MAX ? end - start : UINT_MAX);
    if (inflateInit(&r.z) == Z_OK) {
        mesh = read_stream(&r, flags, err);
        inflateEnd(&r.z);
    } else {
        fail(&r, "no memory to inflate", err);
    }
    mem_free(data);
    return mesh;
}

/* Wavefront OBJ. We have our own reader, so that errors have a line, and corners that
 * share position, texture coordinate and normal become one vertex, over which Mitsuba
 * smooths. */
#include "import/import.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/mesh/polygon.h"
#include "import/number.h"
#include "import/suggest.h"

#include <float.h>
#include <math.h>
#include <string.h>

struct corner {
    uint32_t p, t, n; /* counted from 1; 0: none */
};

struct floats {
    float *data;
    size_t count, capacity; /* of numbers */
};

struct obj {
    const char *file, *at, *line_start;
    int line;
    struct floats p, t, n; /* 3, 2, 3 numbers each */
    struct corner *vertices;
    size_t vertex_count, vertex_capacity;
    uint32_t *table;   /* of vertices + 1 by hash, open addressing; 0: free */
    size_t table_size; /* a power of two, or 0 */
    uint32_t *index;
    size_t index_count, index_capacity;
    struct polygon polygon;
    struct mesh_remarks remarks;
};

static bool fail(const struct obj *o, const char *message, struct err *err)
{
    struct place at = {o->file, o->line, (int)(o->at - o->line_start) + 1};
    return err_set(err, ERR_SYNTAX, &at, "%s", message);
}

/* Blanks within the line; a backslash continues it. */
static void skip_blank(struct obj *o)
{
    for (;;) {
        if (*o->at == ' ' || *o->at == '\t' || *o->at == '\r') {
            o->at++;
        } else if (o->at[0] == '\\' && (o->at[1] == '\n' || o->at[1] == '\r')) {
            o->at += o->at[1] == '\r' && o->at[2] == '\n' ? 3 : 2;
            o->line++;
            o->line_start = o->at;
        } else {
            return;
        }
    }
}

static bool at_line_end(const struct obj *o)
{
    return *o->at == '\n' || *o->at == '\0' || *o->at == '#';
}

static void skip_line(struct obj *o)
{
    while (*o->at && *o->at != '\n') {
        if (*o->at == '\\')
            skip_blank(o);
        if (*o->at && *o->at != '\n')
            o->at++;
    }
}

/* nonfinite: allowed, and read as 0. */
static bool read_number(struct obj *o, bool nonfinite, double *value, struct err *err)
{
    const char *after = nonfinite ? number_skip_nonfinite(o->at) : NULL;
    *value = 0.0;
    if (!after)
        after = number_parse(o->at, value);
    if (!after || !strchr(" \t\r\n\\#", *after)) /* which holds the final zero, too */
        return fail(o, "expected a number", err);
    if (!(fabs(*value) <= (double)FLT_MAX))
        return fail(o, "number beyond the range of float", err);
    o->at = after;
    skip_blank(o);
    return true;
}

/* At least `least` numbers, of which `kept` are kept (absent ones are 0); what follows
 * (weights, colours) has no use here. */
static bool read_floats(struct obj *o, struct floats *to, int least, int kept,
                        struct err *err)
{
    double value = 0.0;
    int count = 0;
    bool nonfinite = to == &o->n; /* mesh_check mends such normals */
    if (to->count / (size_t)kept >= UINT32_MAX - 1)
        return fail(o, "too many vertices", err);
    to->data = mem_grow(to->data, &to->capacity, to->count + (size_t)kept,
                        sizeof *to->data);
    for (; !at_line_end(o); count++) {
        if (!read_number(o, nonfinite, &value, err))
            return false;
        if (count < kept)
            to->data[to->count + (size_t)count] = (float)value;
    }
    if (count < least)
        return fail(o, "too few numbers", err);
    for (; count < kept; count++)
        to->data[to->count + (size_t)count] = 0.0f;
    to->count += (size_t)kept;
    return true;
}

/* One index: from 1, or negative from the newest backwards. */
static bool read_index(struct obj *o, size_t have, const char *complaint, uint32_t *out,
                       struct err *err)
{
    bool negative = *o->at == '-';
    const char *start = o->at;
    uint64_t value = 0;
    o->at += negative;
    if (!(*o->at >= '0' && *o->at <= '9')) {
        o->at = start;
        return fail(o, "expected an index", err);
    }
    for (; *o->at >= '0' && *o->at <= '9'; o->at++)
        value = value > UINT32_MAX ? value : 10 * value + (uint64_t)(*o->at - '0');
    if (value == 0 || value > have) {
        o->at = start;
        return fail(o, complaint, err);
    }
    *out = (uint32_t)(negative ? have + 1 - value : value);
    return true;
}

/* Reads the index of a texture coordinate or a normal, where 0 means "none": Cinema 4D
 * writes it. */
static bool read_optional(struct obj *o, size_t have, const char *complaint,
                          uint32_t *missing, uint32_t *out, struct err *err)
{
    size_t zeros = strspn(o->at, "0");
    if (zeros == 0 || !strchr("/ \t\r\n\\#", o->at[zeros]))
        return read_index(o, have, complaint, out, err);
    o->at += zeros;
    ++*missing;
    return true;
}

/* p, p/t, p//n or p/t/n */
static bool read_corner(struct obj *o, struct corner *c, struct err *err)
{
    *c = (struct corner){0, 0, 0};
    if (!read_index(o, o->p.count / 3, "no vertex (v) of that number so far", &c->p, err))
        return false;
    if (*o->at == '/') {
        o->at++;
        if (*o->at != '/' &&
            !read_optional(o, o->t.count / 2,
                           "no texture coordinate (vt) of that number so far",
                           &o->remarks.missing_uvs, &c->t, err))
            return false;
    }
    if (*o->at == '/') {
        o->at++;
        if (!read_optional(o, o->n.count / 3, "no normal (vn) of that number so far",
                           &o->remarks.missing_normals, &c->n, err))
            return false;
    }
    if (!strchr(" \t\r\n\\#", *o->at))
        return fail(o, "expected a corner like 1, 1/2, 1//3 or 1/2/3", err);
    skip_blank(o);
    return true;
}

static size_t hash(const struct corner *c, size_t size)
{
    uint64_t h = c->p * UINT64_C(0x9e3779b97f4a7c15);
    h = (h ^ (h >> 29) ^ c->t) * UINT64_C(0xbf58476d1ce4e5b9);
    h = (h ^ (h >> 32) ^ c->n) * UINT64_C(0x94d049bb133111eb);
    return (size_t)(h >> 32) & (size - 1);
}

static size_t find_slot(const struct obj *o, const struct corner *c)
{
    size_t slot = hash(c, o->table_size);
    while (o->table[slot]) {
        const struct corner *v = &o->vertices[o->table[slot] - 1];
        if (v->p == c->p && v->t == c->t && v->n == c->n)
            break;
        slot = (slot + 1) & (o->table_size - 1);
    }
    return slot;
}

/* At most half full. */
static void grow_table(struct obj *o)
{
    if (2 * (o->vertex_count + 1) <= o->table_size)
        return;
    mem_free(o->table);
    o->table_size = o->table_size ? 2 * o->table_size : 64;
    o->table = mem_alloc(o->table_size, sizeof *o->table);
    for (size_t i = 0; i < o->vertex_count; i++)
        o->table[find_slot(o, &o->vertices[i])] = (uint32_t)i + 1;
}

static uint32_t vertex_of(struct obj *o, const struct corner *c)
{
    grow_table(o);
    size_t slot = find_slot(o, c);
    if (!o->table[slot]) {
        o->vertices = mem_grow(o->vertices, &o->vertex_capacity, o->vertex_count + 1,
                               sizeof *o->vertices);
        o->vertices[o->vertex_count++] = *c;
        o->table[slot] = (uint32_t)o->vertex_count;
    }
    return o->table[slot] - 1;
}

/* Triangulates the last polygon again if it is not convex. */
static void mend_fan(struct obj *o, size_t count)
{
    uint32_t *fan = o->index + o->index_count - 3 * (count - 2);
    struct polygon *polygon = &o->polygon;
    polygon_reserve(polygon, count);
    for (size_t i = 0; i < count; i++) {
        size_t p = (size_t)o->vertices[polygon_fan_corner(fan, i)].p - 1;
        for (size_t k = 0; k < 3; k++)
            polygon->p[i][k] = (double)o->p.data[3 * p + k];
    }
    if (!polygon_mend_fan(polygon, count, fan))
        o->remarks.crossed_faces++;
}

/* A polygon as a fan about its first corner. */
static bool read_face(struct obj *o, struct err *err)
{
    uint32_t first = 0, previous = 0;
    int count = 0;
    for (; !at_line_end(o); count++) {
        struct corner corner;
        if (!read_corner(o, &corner, err))
            return false;
        if (o->vertex_count >= UINT32_MAX - 1 || o->index_count / 3 >= UINT32_MAX - 1)
            return fail(o, "the mesh is too large", err);
        uint32_t vertex = vertex_of(o, &corner);
        if (count >= 2) {
            o->index = mem_grow(o->index, &o->index_capacity, o->index_count + 3,
                                sizeof *o->index);
            o->index[o->index_count++] = first;
            o->index[o->index_count++] = previous;
            o->index[o->index_count++] = vertex;
        }
        first = count == 0 ? vertex : first;
        previous = vertex;
    }
    if (count < 3)
        o->remarks.short_faces++;
    else if (count > 3)
        mend_fan(o, (size_t)count);
    return true;
}

/* Statements that are no surface, or name things that the scene file defines. */
static const char *const ignored[] = {
    "o",        "g",        "s",      "mtllib",     "usemtl",    "l",
    "p",        "vp",       "mg",     "bevel",      "lod",       "usemap",
    "c_interp", "d_interp", "maplib", "shadow_obj", "trace_obj", NULL};

static bool read_line(struct obj *o, struct err *err)
{
    static const char *const known[] = {"v", "vt", "vn", "f", NULL};
    char word[16];
    size_t length = strcspn(o->at, " \t\r\n\\#");
    struct place at = {o->file, o->line, (int)(o->at - o->line_start) + 1};
    length = length < sizeof word - 1 ? length : sizeof word - 1;
    memcpy(word, o->at, length);
    word[length] = '\0';
    o->at += length;
    skip_blank(o);
    if (text_equal(word, "v"))
        return read_floats(o, &o->p, 3, 3, err);
    if (text_equal(word, "vt"))
        return read_floats(o, &o->t, 1, 2, err);
    if (text_equal(word, "vn"))
        return read_floats(o, &o->n, 3, 3, err);
    if (text_equal(word, "f"))
        return read_face(o, err);
    for (int i = 0; ignored[i]; i++) {
        if (text_equal(word, ignored[i])) {
            skip_line(o);
            return true;
        }
    }
    return suggest_fail(err, &at, "statement", word, known);
}

static bool read_all(struct obj *o, const char *end, struct err *err)
{
    for (o->line = 1; o->at < end; o->line++, o->at++) {
        o->line_start = o->at;
        skip_blank(o);
        if (!at_line_end(o) && !read_line(o, err))
            return false;
        if (*o->at == '#')
            skip_line(o);
        if (*o->at == '\0' && o->at < end)
            return fail(o, "unexpected byte 0", err);
    }
    return o->index_count > 0 || o->remarks.short_faces > 0 ||
           fail(o, "the file has no faces (f)", err);
}

static struct mesh *make_mesh(const struct obj *o)
{
    bool normals = false, uvs = false;
    for (size_t i = 0; i < o->vertex_count; i++) {
        normals = normals || o->vertices[i].n;
        uvs = uvs || o->vertices[i].t;
    }
    struct mesh *mesh = mesh_create((uint32_t)o->vertex_count,
                                    (uint32_t)(o->index_count / 3), normals, uvs);
    mesh->remarks = o->remarks;
    for (size_t i = 0; i < o->index_count; i++)
        mesh->index[i] = o->index[i];
    for (size_t i = 0; i < o->vertex_count; i++) {
        const struct corner *c = &o->vertices[i];
        memcpy(mesh->p + 3 * i, o->p.data + 3 * ((size_t)c->p - 1), 3 * sizeof(float));
        if (c->n)
            memcpy(mesh->n + 3 * i, o->n.data + 3 * ((size_t)c->n - 1),
                   3 * sizeof(float));
        if (c->t)
            memcpy(mesh->uv + 2 * i, o->t.data + 2 * ((size_t)c->t - 1),
                   2 * sizeof(float));
    }
    return mesh;
}

struct mesh *import_obj(const char *path, const struct place *at, struct err *err)
{
    size_t size;
    char *data = text_read_file(path, &size, at, err);
    if (!data)
        return NULL;
    const char *begin = text_skip_mark(data);
    struct obj o = {.file = path, .at = begin, .line_start = begin};
    struct mesh *mesh = read_all(&o, data + size, err) ? make_mesh(&o) : NULL;
    mem_free(o.p.data);
    mem_free(o.t.data);
    mem_free(o.n.data);
    mem_free(o.vertices);
    mem_free(o.table);
    mem_free(o.index);
    polygon_deinit(&o.polygon);
    mem_free(data);
    return mesh;
}

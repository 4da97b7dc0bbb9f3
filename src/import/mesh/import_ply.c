#include "import/import.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/gzip.h"
#include "import/mesh/ply_cursor.h"
#include "import/mesh/polygon.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <string.h>

enum role { ROLE_X, ROLE_Y, ROLE_Z, ROLE_NX, ROLE_NY, ROLE_NZ, ROLE_U, ROLE_V, ROLES };

static const struct {
    const char *name;
    enum role role;
} role_names[] = {
    {"x", ROLE_X},         {"y", ROLE_Y},         {"z", ROLE_Z},
    {"nx", ROLE_NX},       {"ny", ROLE_NY},       {"nz", ROLE_NZ},
    {"u", ROLE_U},         {"v", ROLE_V},         {"s", ROLE_U},
    {"t", ROLE_V},         {"texture_u", ROLE_U}, {"texture_v", ROLE_V},
    {"texture_s", ROLE_U}, {"texture_t", ROLE_V},
};

struct plan {
    int role_of[PLY_PROPERTIES]; /* of the vertex's properties, -1: skipped */
    bool has[ROLES];
};

/* 16 bytes may be read at the last index, see mesh.h. */
#define INDEX_PAD 4

/* A polygon that was read before the vertices. */
struct fan {
    size_t first; /* of its indices */
    uint32_t corners;
};

struct triangles {
    uint32_t *index;
    size_t count, capacity; /* of indices */
    struct polygon polygon;
    struct fan *waiting;
    size_t waiting_count, waiting_capacity;
    struct mesh_remarks remarks;
};

static bool fail(const char *file, struct err *err, const char *message)
{
    struct place at = {file, 0, 0};
    return err_set(err, ERR_VALUE, &at, "%s", message);
}

static const struct ply_element *find_element(const struct ply_header *h,
                                              const char *name)
{
    for (int i = 0; i < h->element_count; i++)
        if (text_equal(h->elements[i].name, name))
            return &h->elements[i];
    return NULL;
}

static int role_of(const struct ply_property *p)
{
    for (size_t i = 0; i < sizeof role_names / sizeof role_names[0]; i++)
        if (!p->count_type && text_equal(p->name, role_names[i].name))
            return (int)role_names[i].role;
    return -1;
}

static bool make_plan(const struct ply_element *e, const char *file, struct plan *plan,
                      struct err *err)
{
    *plan = (struct plan){0};
    for (int i = 0; i < e->property_count; i++) {
        int role = plan->role_of[i] = role_of(&e->properties[i]);
        if (role < 0)
            continue;
        if (plan->has[role])
            return fail(file, err, "two vertex properties mean the same");
        plan->has[role] = true;
    }
    const bool *has = plan->has;
    if (!has[ROLE_X] || !has[ROLE_Y] || !has[ROLE_Z])
        return fail(file, err, "the vertices lack x, y or z");
    if (has[ROLE_NX] != has[ROLE_NY] || has[ROLE_NX] != has[ROLE_NZ])
        return fail(file, err, "the vertices lack one of nx, ny, nz");
    if (has[ROLE_U] != has[ROLE_V])
        return fail(file, err, "the vertices lack one of u, v");
    return true;
}

static bool is_normal(int role)
{
    return role >= ROLE_NX && role <= ROLE_NZ;
}

static bool read_vertices(struct ply_cursor *c, const struct ply_element *e,
                          const struct plan *plan, struct mesh *mesh, struct err *err)
{
    for (size_t v = 0; v < e->count; v++) {
        float value[ROLES] = {0};
        for (int i = 0; i < e->property_count; i++) {
            const struct ply_property *p = &e->properties[i];
            double d;
            if (plan->role_of[i] < 0) {
                if (!ply_cursor_skip(c, p, err))
                    return false;
                continue;
            }
            if (!ply_cursor_read(c, p->type, &d, err))
                return false;
            bool finite = fabs(d) <= (double)FLT_MAX,
                 normal = is_normal(plan->role_of[i]);
            if (!finite && normal)
                d = 0.0; /* mesh_check mends it */
            if (!finite && !normal)
                return ply_cursor_fail(c, ERR_VALUE,
                                       "a vertex is not finite in single precision", err);
            value[plan->role_of[i]] = (float)d;
        }
        for (int i = 0; i < 3; i++)
            mesh->p[3 * v + (size_t)i] = value[ROLE_X + i];
        for (int i = 0; i < 3 && mesh->n; i++)
            mesh->n[3 * v + (size_t)i] = value[ROLE_NX + i];
        for (int i = 0; i < 2 && mesh->uv; i++)
            mesh->uv[2 * v + (size_t)i] = value[ROLE_U + i];
    }
    return true;
}

/* Triangulates a polygon again if it is not convex. */
static void mend_fan(const struct mesh *mesh, size_t at, uint32_t corners,
                     struct triangles *t)
{
    uint32_t *fan = t->index + at;
    polygon_reserve(&t->polygon, corners);
    for (size_t i = 0; i < corners; i++)
        for (size_t k = 0; k < 3; k++)
            t->polygon.p[i][k] =
                (double)mesh->p[3 * (size_t)polygon_fan_corner(fan, i) + k];
    if (!polygon_mend_fan(&t->polygon, corners, fan))
        t->remarks.crossed_faces++;
}

/* Now, or once the vertices are there. mesh: NULL before. */
static void mend_later(const struct mesh *mesh, uint32_t corners, struct triangles *t)
{
    size_t first = t->count - 3 * ((size_t)corners - 2);
    if (mesh) {
        mend_fan(mesh, first, corners, t);
        return;
    }
    t->waiting = mem_grow(t->waiting, &t->waiting_capacity, t->waiting_count + 1,
                          sizeof *t->waiting);
    t->waiting[t->waiting_count++] = (struct fan){first, corners};
}

static bool skip_corners(struct ply_cursor *c, const struct ply_property *p,
                         uint32_t corners, double last_vertex, struct err *err)
{
    uint32_t unused;
    for (uint32_t i = 0; i < corners; i++)
        if (!ply_cursor_read_index(c, p->type, last_vertex, &unused, err))
            return false;
    return true;
}

/* One polygon as a fan about its first corner. */
static bool read_polygon(struct ply_cursor *c, const struct ply_property *p,
                         double last_vertex, const struct mesh *placed,
                         struct triangles *t, struct err *err)
{
    uint32_t corners, first, previous, next;
    if (!ply_cursor_read_index(c, p->count_type, UINT32_MAX, &corners, err))
        return false;
    if (corners < 3) {
        t->remarks.short_faces++;
        return skip_corners(c, p, corners, last_vertex, err);
    }
    if (!ply_cursor_read_index(c, p->type, last_vertex, &first, err) ||
        !ply_cursor_read_index(c, p->type, last_vertex, &previous, err))
        return false;
    for (uint32_t i = 2; i < corners; i++) {
        if (!ply_cursor_read_index(c, p->type, last_vertex, &next, err))
            return false;
        t->index = mem_grow(t->index, &t->capacity, t->count + 3, sizeof *t->index);
        t->index[t->count++] = first;
        t->index[t->count++] = previous;
        t->index[t->count++] = next;
        previous = next;
    }
    if (corners > 3)
        mend_later(placed, corners, t);
    return true;
}

static bool is_corners(const struct ply_property *p)
{
    return p->count_type && ply_type_is_integer(p->type) &&
           (text_equal(p->name, "vertex_indices") || text_equal(p->name, "vertex_index"));
}

static bool read_faces(struct ply_cursor *c, const struct ply_element *e,
                       double last_vertex, const struct mesh *placed, struct triangles *t,
                       struct err *err)
{
    for (uint64_t f = 0; f < e->count; f++) {
        for (int i = 0; i < e->property_count; i++) {
            const struct ply_property *p = &e->properties[i];
            bool read = is_corners(p) ? read_polygon(c, p, last_vertex, placed, t, err)
                                      : ply_cursor_skip(c, p, err);
            if (!read)
                return false;
        }
    }
    return true;
}

static bool skip_element(struct ply_cursor *c, const struct ply_element *e,
                         struct err *err)
{
    for (uint64_t row = 0; row < e->count; row++)
        for (int i = 0; i < e->property_count; i++)
            if (!ply_cursor_skip(c, &e->properties[i], err))
                return false;
    return true;
}

static bool check_elements(const struct ply_element *vertex,
                           const struct ply_element *face, const char *file,
                           struct err *err)
{
    if (!vertex || !face)
        return fail(file, err, "the file holds no \"vertex\" or no \"face\" elements");
    if (vertex->count == 0 || face->count == 0)
        return fail(file, err, "the mesh is empty");
    if (vertex->count > UINT32_MAX)
        return fail(file, err, "too many vertices for indices of 32 bits");
    int lists = 0;
    for (int i = 0; i < face->property_count; i++)
        lists += is_corners(&face->properties[i]);
    if (lists != 1)
        return fail(file, err,
                    "the faces want one list \"vertex_indices\" (or \"vertex_index\") of "
                    "an integer type");
    return true;
}

/* Reads all elements: vertices into the mesh, faces into *t. */
static bool read_data(struct ply_cursor *c, const struct ply_header *h,
                      const struct plan *plan, struct mesh *mesh, struct triangles *t,
                      struct err *err)
{
    double last = (double)mesh->vertex_count - 1.0;
    bool read = true, placed = false;
    for (int i = 0; read && i < h->element_count; i++) {
        const struct ply_element *e = &h->elements[i];
        if (text_equal(e->name, "vertex"))
            placed = read = read_vertices(c, e, plan, mesh, err);
        else if (text_equal(e->name, "face"))
            read = read_faces(c, e, last, placed ? mesh : NULL, t, err);
        else
            read = skip_element(c, e, err);
    }
    if (!read || !ply_cursor_finish(c, err))
        return false;
    if (t->count / 3 > UINT32_MAX)
        return ply_cursor_fail(c, ERR_VALUE, "too many triangles", err);
    for (size_t i = 0; i < t->waiting_count; i++)
        mend_fan(mesh, t->waiting[i].first, t->waiting[i].corners, t);
    return true;
}

/* The number of triangles is known only now. The indices move to the mesh: of large ones
 * there is no room for a copy. */
static void move_triangles(struct triangles *t, struct mesh *mesh)
{
    assert(t->index); /* reserve made room */
    mem_free(mesh->index);
    mesh->index = mem_resize(t->index, t->count + INDEX_PAD, sizeof *t->index);
    memset(mesh->index + t->count, 0, INDEX_PAD * sizeof *t->index);
    mesh->triangle_count = (uint32_t)(t->count / 3);
    mesh->remarks = t->remarks;
    t->index = NULL;
}

/* Reserves a triangle for each face of the header; polygons make it grow. */
static void reserve(struct triangles *t, const struct ply_element *face)
{
    size_t need = 3 * (size_t)face->count + INDEX_PAD;
    t->index = mem_resize(NULL, need, sizeof *t->index);
    t->capacity = need;
}

/* data: the first piece of the file. */
static struct mesh *parse(const char *data, size_t size, struct gzip *file,
                          const char *path, struct err *err)
{
    struct ply_header h;
    struct plan plan;
    if (!ply_header_parse(data, size, gzip_size_most(file), path, &h, err))
        return NULL;
    const struct ply_element *vertex = find_element(&h, "vertex");
    const struct ply_element *face = find_element(&h, "face");
    if (!check_elements(vertex, face, path, err) || !make_plan(vertex, path, &plan, err))
        return NULL;
    struct ply_cursor cursor;
    struct triangles triangles = {0};
    ply_cursor_init(&cursor, data, size, file, path, &h);
    struct mesh *mesh = mesh_create((uint32_t)vertex->count, 1, plan.has[ROLE_NX],
                                    plan.has[ROLE_U]);
    reserve(&triangles, face);
    if (read_data(&cursor, &h, &plan, mesh, &triangles, err))
        move_triangles(&triangles, mesh);
    else {
        mesh_destroy(mesh);
        mesh = NULL;
    }
    mem_free(triangles.index);
    mem_free(triangles.waiting);
    polygon_deinit(&triangles.polygon);
    return mesh;
}

struct mesh *import_ply(const char *path, const struct place *at, struct err *err)
{
    size_t size;
    struct gzip *file = gzip_open(path, at, err);
    const char *data = file ? gzip_more(file, 0, &size, err) : NULL;
    struct mesh *mesh = data ? parse(data, size, file, path, err) : NULL;
    gzip_close(file);
    return mesh;
}

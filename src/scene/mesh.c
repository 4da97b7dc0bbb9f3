#include "scene/mesh.h"

#include "base/mem.h"
#include "math/vec3.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

/* Height over longest edge below which a triangle has no normal left in floats. */
#define MESH_DEGENERATE 0x1p-22

struct mesh *mesh_create(uint32_t vertices, uint32_t triangles, bool normals, bool uvs)
{
    struct mesh *mesh = mem_alloc(1, sizeof *mesh);
    mesh->vertex_count = vertices;
    mesh->triangle_count = triangles;
    mesh->p = mem_alloc((size_t)vertices * 3 + 4, sizeof(float));
    mesh->index = mem_alloc((size_t)triangles * 3 + 4, sizeof(uint32_t));
    if (normals)
        mesh->n = mem_alloc((size_t)vertices * 3 + 1, sizeof(float));
    if (uvs)
        mesh->uv = mem_alloc((size_t)vertices * 2 + 1, sizeof(float));
    return mesh;
}

struct mesh *mesh_copy(const struct mesh *mesh)
{
    struct mesh *copy = mesh_create(mesh->vertex_count, mesh->triangle_count,
                                    mesh->n != NULL, mesh->uv != NULL);
    size_t vertices = mesh->vertex_count;
    copy->remarks = mesh->remarks;
    memcpy(copy->p, mesh->p, 3 * vertices * sizeof(float));
    memcpy(copy->index, mesh->index, 3 * (size_t)mesh->triangle_count * sizeof(uint32_t));
    if (mesh->n)
        memcpy(copy->n, mesh->n, 3 * vertices * sizeof(float));
    if (mesh->uv)
        memcpy(copy->uv, mesh->uv, 2 * vertices * sizeof(float));
    return copy;
}

void mesh_destroy(struct mesh *mesh)
{
    if (!mesh)
        return;
    mem_free(mesh->p);
    mem_free(mesh->n);
    mem_free(mesh->uv);
    mem_free(mesh->index);
    mem_free(mesh);
}

static struct vec3 mesh_get(const float *array, size_t i)
{
    return vec3(array[3 * i], array[3 * i + 1], array[3 * i + 2]);
}

static void mesh_put(float *array, size_t i, struct vec3 v)
{
    array[3 * i] = v.x;
    array[3 * i + 1] = v.y;
    array[3 * i + 2] = v.z;
}

/* Unit length without overflow; false for zero (and what is not finite). */
static bool mesh_normalize(struct vec3 *v)
{
    double x = (double)v->x, y = (double)v->y, z = (double)v->z;
    double length = sqrt(x * x + y * y + z * z);
    if (!(length > 0.0) || !isfinite(length))
        return false;
    *v = vec3((float)(x / length), (float)(y / length), (float)(z / length));
    return true;
}

void mesh_transform(struct mesh *mesh, const struct xform *xform)
{
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        mesh_put(mesh->p, i, xform_point(xform, mesh_get(mesh->p, i)));
        if (mesh->n) {
            struct vec3 n = xform_normal(xform, mesh_get(mesh->n, i));
            mesh_normalize(&n);
            mesh_put(mesh->n, i, n);
        }
    }
}

static bool mesh_check_finite(const float *array, size_t vertices, size_t components,
                              const char *what, const struct place *at, struct err *err)
{
    for (size_t i = 0; array && i < vertices * components; i++)
        if (!isfinite(array[i]))
            return err_set(err, ERR_VALUE, at,
                           "the %s of vertex %zu is not finite (counted from 0)", what,
                           i / components);
    return true;
}

static bool mesh_check_indices(const struct mesh *mesh, const struct place *at,
                               struct err *err)
{
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++)
        if (mesh->index[i] >= mesh->vertex_count)
            return err_set(err, ERR_VALUE, at,
                           "triangle %zu names vertex %u, but the mesh has %u vertices "
                           "(counted from 0)",
                           i / 3, (unsigned)mesh->index[i], (unsigned)mesh->vertex_count);
    return true;
}

/* (p1-p0) x (p2-p0) of one triangle in double; returns the longest edge squared. */
static double mesh_cross(const struct mesh *mesh, const uint32_t *index, double cross[3])
{
    double e[3][3], longest = 0.0;
    for (int j = 0; j < 3; j++) {
        const float *a = mesh->p + 3 * (size_t)index[j];
        const float *b = mesh->p + 3 * (size_t)index[(j + 1) % 3];
        double sum = 0.0;
        for (int k = 0; k < 3; k++) {
            e[j][k] = (double)b[k] - (double)a[k];
            sum += e[j][k] * e[j][k];
        }
        longest = fmax(longest, sum);
    }
    for (int k = 0; k < 3; k++) {
        int a = (k + 1) % 3, b = (k + 2) % 3;
        cross[k] = e[0][a] * e[1][b] - e[0][b] * e[1][a];
    }
    return longest;
}

double mesh_area(const struct mesh *mesh)
{
    double sum = 0.0, n[3];
    for (size_t i = 0; i < mesh->triangle_count; i++) {
        mesh_cross(mesh, mesh->index + 3 * i, n);
        sum += 0.5 * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    }
    return sum;
}

/* Also true if the products of its edges leave the range of float. */
static bool mesh_is_degenerate(const struct mesh *mesh, const uint32_t *index)
{
    double n[3];
    double longest = mesh_cross(mesh, index, n);
    double area2 = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    return !(area2 > MESH_DEGENERATE * longest) || area2 < (double)FLT_MIN * 0x1p24 ||
           area2 > (double)FLT_MAX * 0x1p-24;
}

static void mesh_drop_degenerate(struct mesh *mesh, const struct place *at,
                                 struct log *log)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *index = mesh->index + 3 * (size_t)i;
        if (!mesh_is_degenerate(mesh, index))
            memmove(mesh->index + 3 * (size_t)kept++, index, 3 * sizeof *index);
    }
    uint32_t dropped = mesh->triangle_count - kept;
    mesh->triangle_count = kept;
    for (uint32_t i = 0; i < dropped; i++)
        log_note(log, at, "degenerate triangle left out");
}

/* A triangle by its corners, the least first, in their order. */
struct mesh_corners {
    float p[9];
    uint32_t triangle;
};

static int mesh_compare_places(const struct mesh_corners *x, const struct mesh_corners *y)
{
    for (int k = 0; k < 9; k++)
        if (x->p[k] != y->p[k])
            return x->p[k] < y->p[k] ? -1 : 1;
    return 0;
}

static int mesh_compare_corners(const void *a, const void *b)
{
    const struct mesh_corners *x = a, *y = b;
    int order = mesh_compare_places(x, y);
    return order != 0 ? order : x->triangle < y->triangle ? -1 : 1;
}

static void mesh_fill_corners(const struct mesh *mesh, uint32_t triangle,
                              struct mesh_corners *out)
{
    const uint32_t *index = mesh->index + 3 * (size_t)triangle;
    for (size_t first = 0; first < 3; first++) {
        struct mesh_corners turned = {.triangle = triangle};
        for (size_t j = 0; j < 3; j++)
            memcpy(turned.p + 3 * j, mesh->p + 3 * (size_t)index[(first + j) % 3],
                   3 * sizeof(float));
        if (first == 0 || mesh_compare_places(&turned, out) < 0)
            *out = turned;
    }
}

void mesh_drop_repeated(struct mesh *mesh, const struct place *at, struct log *log)
{
    size_t count = mesh->triangle_count;
    struct mesh_corners *all = mem_alloc(count + 1, sizeof *all);
    uint8_t *repeated = mem_alloc(count + 1, 1);
    for (size_t i = 0; i < count; i++)
        mesh_fill_corners(mesh, (uint32_t)i, &all[i]);
    qsort(all, count, sizeof *all, mesh_compare_corners);
    for (size_t i = 1; i < count; i++)
        repeated[all[i].triangle] = mesh_compare_places(&all[i], &all[i - 1]) == 0;
    uint32_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        if (repeated[i])
            log_note(log, at, "a triangle of a lamp is there twice: one left out");
        else
            memmove(mesh->index + 3 * (size_t)kept++, mesh->index + 3 * i,
                    3 * sizeof *mesh->index);
    }
    mesh->triangle_count = kept;
    mem_free(repeated);
    mem_free(all);
}

/* A normal of zero length, or that is not finite, becomes the mean of the faces around
 * its vertex, by area. */
static void mesh_repair_normals(struct mesh *mesh, const uint8_t *broken)
{
    double *sum = mem_alloc(3 * (size_t)mesh->vertex_count + 1, sizeof *sum);
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *index = mesh->index + 3 * (size_t)i;
        double n[3];
        mesh_cross(mesh, index, n);
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                sum[3 * (size_t)index[j] + (size_t)k] += n[k];
    }
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        if (!broken[i])
            continue;
        double x = sum[3 * i], y = sum[3 * i + 1], z = sum[3 * i + 2];
        double length = sqrt(x * x + y * y + z * z);
        struct vec3 n = vec3(0.0f, 0.0f, 1.0f); /* of a vertex that no face uses */
        if (length > 0.0)
            n = vec3((float)(x / length), (float)(y / length), (float)(z / length));
        mesh_put(mesh->n, i, n);
    }
    mem_free(sum);
}

static void mesh_check_normals(struct mesh *mesh, const struct place *at, struct log *log)
{
    uint8_t *broken = mem_alloc((size_t)mesh->vertex_count + 1, 1);
    bool any = false;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        struct vec3 n = mesh_get(mesh->n, i);
        broken[i] = !mesh_normalize(&n);
        if (broken[i])
            log_note(log, at, "shading normal of length zero, or not finite, replaced");
        else
            mesh_put(mesh->n, i, n);
        any = any || broken[i];
    }
    if (any)
        mesh_repair_normals(mesh, broken);
    mem_free(broken);
}

static void mesh_note(uint32_t times, const char *what, const struct place *at,
                      struct log *log)
{
    for (uint32_t i = 0; i < times; i++)
        log_note(log, at, "%s", what);
}

static void mesh_note_remarks(const struct mesh *mesh, const struct place *at,
                              struct log *log)
{
    const struct mesh_remarks *r = &mesh->remarks;
    mesh_note(r->short_faces, "face of fewer than 3 corners left out", at, log);
    mesh_note(r->missing_normals, "corner without a normal (number 0)", at, log);
    mesh_note(r->missing_uvs, "corner without a texture coordinate (number 0)", at, log);
    mesh_note(r->crossed_faces,
              "polygon that crosses itself, or has too many corners to be cut well: "
              "fanned about its first corner",
              at, log);
}

bool mesh_check(struct mesh *mesh, const struct place *at, struct log *log,
                struct err *err)
{
    if (!mesh_check_finite(mesh->p, mesh->vertex_count, 3, "position", at, err) ||
        !mesh_check_finite(mesh->uv, mesh->vertex_count, 2, "uv", at, err) ||
        !mesh_check_indices(mesh, at, err))
        return false;
    mesh_note_remarks(mesh, at, log);
    mesh->remarks = (struct mesh_remarks){0}; /* a mesh may be checked again */
    mesh_drop_degenerate(mesh, at, log);
    if (mesh->n)
        mesh_check_normals(mesh, at, log);
    return true;
}

/* Fills one quad of a mesh: corners counter-clockwise, seen from outside. */
static void mesh_put_quad(struct mesh *mesh, uint32_t quad, const float corners[4][3])
{
    static const float uv[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    static const uint32_t order[6] = {0, 1, 2, 0, 2, 3};
    memcpy(mesh->p + 12 * (size_t)quad, corners, 12 * sizeof(float));
    memcpy(mesh->uv + 8 * (size_t)quad, uv, sizeof uv);
    for (size_t i = 0; i < 6; i++)
        mesh->index[6 * (size_t)quad + i] = 4 * quad + order[i];
}

struct mesh *mesh_rectangle(void)
{
    static const float corners[4][3] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    struct mesh *mesh = mesh_create(4, 2, false, true);
    mesh_put_quad(mesh, 0, corners);
    return mesh;
}

struct mesh *mesh_box(void)
{
    static const float faces[6][4][3] = {
        {{1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1}},
        {{-1, -1, -1}, {-1, -1, 1}, {-1, 1, 1}, {-1, 1, -1}},
        {{-1, 1, -1}, {-1, 1, 1}, {1, 1, 1}, {1, 1, -1}},
        {{-1, -1, -1}, {1, -1, -1}, {1, -1, 1}, {-1, -1, 1}},
        {{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}},
        {{-1, -1, -1}, {-1, 1, -1}, {1, 1, -1}, {1, -1, -1}},
    };
    struct mesh *mesh = mesh_create(24, 12, false, true);
    for (uint32_t i = 0; i < 6; i++)
        mesh_put_quad(mesh, i, faces[i]);
    return mesh;
}

#include "base/mem.h"
#include "math/warp.h"
#include "scene/mesh.h"

/* A profile turned about +y. Every segment of the profile gets its own two rings of
 * vertices, so that normals may differ across a crease; positions of neighbouring rings
 * are the same floats, so the surface is watertight. */

struct lathe {
    const double *profile; /* (radius, height) pairs */
    int count, segments;
    bool closed; /* the last pair repeats the first */
    double turn; /* +1: the normals are to the right of the profile's way; -1: left */
};

static double lathe_r(const struct lathe *l, int i)
{
    return l->profile[2 * (size_t)i];
}

static double lathe_h(const struct lathe *l, int i)
{
    return l->profile[2 * i + 1];
}

static bool lathe_valid(const double *profile, int count, int segments)
{
    bool wide = false;
    if (count < 2 || segments < 3)
        return false;
    for (size_t i = 0; i < (size_t)count; i++) {
        if (!isfinite(profile[2 * i]) || !isfinite(profile[2 * i + 1]) ||
            profile[2 * i] < 0.0)
            return false;
        wide = wide || profile[2 * i] > 0.0;
    }
    return wide;
}

/* Twice the area that the profile runs around counter-clockwise (closed by a straight
 * line, which lies on the axis if both ends do). */
static double lathe_area(const struct lathe *l)
{
    double sum = 0.0;
    for (int i = 0; i < l->count; i++) {
        int j = (i + 1) % l->count;
        sum += lathe_r(l, i) * lathe_h(l, j) - lathe_r(l, j) * lathe_h(l, i);
    }
    return sum;
}

/* Unit normal (radius, height) of the profile's segment i; zero if it has no length. */
static struct vec2 lathe_normal(const struct lathe *l, int i)
{
    double dr = lathe_r(l, i + 1) - lathe_r(l, i);
    double dh = lathe_h(l, i + 1) - lathe_h(l, i);
    double length = hypot(dr, dh);
    if (!(length > 0.0))
        return (struct vec2){0.0, 0.0};
    return (struct vec2){l->turn * dh / length, -l->turn * dr / length};
}

/* The normal of segment i at its end (0 or 1): the mean with its neighbour's unless the
 * profile creases there. On the axis the neighbour is the segment's own mirror image. */
static struct vec2 lathe_end_normal(const struct lathe *l, int i, int end,
                                    double cos_crease)
{
    struct vec2 n = lathe_normal(l, i), m = {0.0, 0.0};
    int next = i + (end ? 1 : -1), last = l->count - 2;
    if (l->closed && next < 0)
        next = last;
    else if (l->closed && next > last)
        next = 0;
    if (next >= 0 && next <= last)
        m = lathe_normal(l, next);
    else if (lathe_r(l, i + end) == 0.0)
        m = (struct vec2){-n.x, n.y};
    if (n.x * m.x + n.y * m.y < cos_crease)
        return n;
    double x = n.x + m.x, y = n.y + m.y, length = hypot(x, y);
    return length > 0.0 ? (struct vec2){x / length, y / length} : n;
}

static void lathe_ring(const struct lathe *l, struct mesh *mesh, int segment, int end,
                       double cos_crease)
{
    size_t base = (size_t)(2 * segment + end) * (size_t)l->segments;
    struct vec2 n = {0.0, 0.0};
    if (mesh->n)
        n = lathe_end_normal(l, segment, end, cos_crease);
    int point = segment + end;
    if (l->closed && point == l->count - 1)
        point = 0;
    for (int k = 0; k < l->segments; k++) {
        double phi = 2.0 * MATH_PI * k / l->segments;
        double c = cos(phi), s = -sin(phi); /* counter-clockwise seen from +y */
        float *p = mesh->p + 3 * (base + (size_t)k);
        p[0] = (float)(lathe_r(l, point) * c);
        p[1] = (float)lathe_h(l, point);
        p[2] = (float)(lathe_r(l, point) * s);
        if (mesh->n) {
            float *to = mesh->n + 3 * (base + (size_t)k);
            to[0] = (float)(n.x * c);
            to[1] = (float)n.y;
            to[2] = (float)(n.x * s);
        }
    }
}

static void lathe_triangle(const struct lathe *l, struct mesh *mesh, uint32_t a,
                           uint32_t b, uint32_t c)
{
    uint32_t *index = mesh->index + 3 * (size_t)mesh->triangle_count++;
    index[0] = a;
    index[1] = l->turn > 0.0 ? b : c;
    index[2] = l->turn > 0.0 ? c : b;
}

/* The band of one segment; at the axis its quads are triangles. */
static void lathe_band(const struct lathe *l, struct mesh *mesh, int segment)
{
    uint32_t n = (uint32_t)l->segments, low = 2 * (uint32_t)segment * n, high = low + n;
    for (uint32_t k = 0; k < n; k++) {
        uint32_t next = (k + 1) % n;
        if (lathe_r(l, segment) > 0.0)
            lathe_triangle(l, mesh, low + k, low + next, high + next);
        if (lathe_r(l, segment + 1) > 0.0)
            lathe_triangle(l, mesh, low + k, high + next, high + k);
    }
}

struct mesh *mesh_lathe(const double *profile, int count, int segments, bool smooth,
                        double crease)
{
    if (!lathe_valid(profile, count, segments))
        return NULL;
    struct lathe l = {.profile = profile, .count = count, .segments = segments};
    l.turn = 1.0;
    l.closed = count > 2 && lathe_r(&l, 0) == lathe_r(&l, count - 1) &&
               lathe_h(&l, 0) == lathe_h(&l, count - 1);
    bool solid = l.closed || (lathe_r(&l, 0) == 0.0 && lathe_r(&l, count - 1) == 0.0);
    if (solid && lathe_area(&l) < 0.0)
        l.turn = -1.0;
    uint32_t bands = (uint32_t)count - 1, around = (uint32_t)segments;
    struct mesh *mesh = mesh_create(2 * bands * around, 2 * bands * around, smooth,
                                    false);
    mesh->triangle_count = 0; /* counted as they come */
    double cos_crease = cos(crease * MATH_PI / 180.0) - 1e-12;
    for (int i = 0; i < count - 1; i++) {
        lathe_ring(&l, mesh, i, 0, cos_crease);
        lathe_ring(&l, mesh, i, 1, cos_crease);
        lathe_band(&l, mesh, i);
    }
    return mesh;
}

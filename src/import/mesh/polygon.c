#include "import/mesh/polygon.h"

#include "base/mem.h"

#include <math.h>

/* Sine of the turn at a corner below which it counts as straight: corners are floats. */
#define STRAIGHT 1e-6

struct point {
    double x, y;
};

void polygon_deinit(struct polygon *polygon)
{
    mem_free(polygon->p);
    mem_free(polygon->order);
    mem_free(polygon->triangles);
    *polygon = (struct polygon){0};
}

void polygon_reserve(struct polygon *polygon, size_t count)
{
    if (count <= polygon->capacity)
        return;
    size_t room = count < 16 ? 16 : 2 * count;
    polygon->p = mem_resize(polygon->p, room, sizeof *polygon->p);
    polygon->order = mem_resize(polygon->order, room, sizeof *polygon->order);
    polygon->triangles = mem_resize(polygon->triangles, 3 * room,
                                    sizeof *polygon->triangles);
    polygon->capacity = room;
}

/* Newell's normal: the sum of the cross products about corner 0, whose length is twice
 * the polygon's area where it is plane. Returns the axis along which it is longest; *sign
 * is the side. False if it is zero. */
static bool dominant_axis(const struct polygon *polygon, size_t count, int *axis,
                          double *sign)
{
    double n[3] = {0.0, 0.0, 0.0};
    const double *o = polygon->p[0];
    for (size_t i = 1; i + 1 < count; i++) {
        double a[3], b[3];
        for (int k = 0; k < 3; k++) {
            a[k] = polygon->p[i][k] - o[k];
            b[k] = polygon->p[i + 1][k] - o[k];
        }
        for (int k = 0; k < 3; k++)
            n[k] += a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    }
    *axis = fabs(n[0]) > fabs(n[1]) ? 0 : 1;
    *axis = fabs(n[2]) > fabs(n[*axis]) ? 2 : *axis;
    *sign = n[*axis] < 0.0 ? -1.0 : 1.0;
    return fabs(n[*axis]) > 0.0;
}

/* A corner in the plane across the axis, so that the polygon runs counter-clockwise. */
static struct point project(const struct polygon *polygon, size_t corner, int axis,
                            double sign)
{
    const double *p = polygon->p[corner];
    struct point at = {.x = sign * p[(axis + 1) % 3], .y = p[(axis + 2) % 3]};
    return at;
}

/* Twice the signed area of the triangle. */
static double turn(struct point a, struct point b, struct point c)
{
    return (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x);
}

/* Whether the polygon turns to the right at b by more than rounding. */
static bool is_reflex(struct point a, struct point b, struct point c)
{
    double scale = hypot(b.x - a.x, b.y - a.y) * hypot(c.x - b.x, c.y - b.y);
    return turn(a, b, c) < -STRAIGHT * scale;
}

bool polygon_is_convex(const struct polygon *polygon, size_t count)
{
    int axis;
    double sign;
    if (count <= 3 || !dominant_axis(polygon, count, &axis, &sign))
        return true;
    struct point a = project(polygon, count - 2, axis, sign);
    struct point b = project(polygon, count - 1, axis, sign);
    for (size_t i = 0; i < count; i++) {
        struct point c = project(polygon, i, axis, sign);
        if (is_reflex(a, b, c))
            return false;
        a = b;
        b = c;
    }
    return true;
}

/* The three corners about place i of the `left` ones. */
static void corner_at(const struct polygon *polygon, size_t left, size_t i, int axis,
                      double sign, struct point t[3])
{
    for (size_t k = 0; k < 3; k++)
        t[k] = project(polygon, polygon->order[(i + left - 1 + k) % left], axis, sign);
}

static bool same(struct point a, struct point b)
{
    return a.x == b.x && a.y == b.y;
}

/* Whether p lies in the triangle or on its border. Where the border of a polygon touches
 * itself, as along the cut that leads to a hole, p may be one of the two ends. */
static bool covers(const struct point t[3], struct point p)
{
    return !same(p, t[0]) && !same(p, t[2]) && turn(t[0], t[1], p) >= 0.0 &&
           turn(t[1], t[2], p) >= 0.0 && turn(t[2], t[0], p) >= 0.0;
}

/* Whether the corner at place i of the `left` ones can be cut off: it is convex, and no
 * corner that is not lies in its triangle. */
static bool is_ear(const struct polygon *polygon, size_t left, size_t i, int axis,
                   double sign)
{
    struct point t[3], other[3];
    corner_at(polygon, left, i, axis, sign, t);
    if (!(turn(t[0], t[1], t[2]) > 0.0))
        return false;
    for (size_t j = 0; j < left; j++) {
        if (j == i || !covers(t, project(polygon, polygon->order[j], axis, sign)))
            continue;
        corner_at(polygon, left, j, axis, sign, other);
        if (turn(other[0], other[1], other[2]) <= 0.0)
            return false;
    }
    return true;
}

/* A corner in a straight line, or that doubles back, makes a triangle without area. */
static bool is_flat(const struct polygon *polygon, size_t left, size_t i, int axis,
                    double sign)
{
    struct point t[3];
    corner_at(polygon, left, i, axis, sign, t);
    return turn(t[0], t[1], t[2]) == 0.0;
}

/* The next place at or after `start` whose corner can be cut off; `left` if there is
 * none. */
static size_t find_ear(const struct polygon *polygon, size_t left, size_t start, int axis,
                       double sign)
{
    for (size_t k = 0; k < left; k++)
        if (is_ear(polygon, left, (start + k) % left, axis, sign))
            return (start + k) % left;
    for (size_t k = 0; k < left; k++)
        if (is_flat(polygon, left, (start + k) % left, axis, sign))
            return (start + k) % left;
    return left;
}

bool polygon_cut_ears(struct polygon *polygon, size_t count)
{
    int axis;
    double sign;
    if (count > POLYGON_MOST || !dominant_axis(polygon, count, &axis, &sign))
        return false;
    for (size_t i = 0; i < count; i++)
        polygon->order[i] = (uint32_t)i;
    uint32_t *out = polygon->triangles, *order = polygon->order;
    size_t place = 1;
    for (size_t left = count; left > 3; left--) {
        place = find_ear(polygon, left, place % left, axis, sign);
        if (place == left)
            return false;
        *out++ = order[(place + left - 1) % left];
        *out++ = order[place];
        *out++ = order[(place + 1) % left];
        for (size_t j = place; j + 1 < left; j++)
            order[j] = order[j + 1];
    }
    for (int k = 0; k < 3; k++)
        *out++ = order[k];
    return true;
}

bool polygon_mend_fan(struct polygon *polygon, size_t count, uint32_t *fan)
{
    if (polygon_is_convex(polygon, count))
        return true;
    if (!polygon_cut_ears(polygon, count))
        return false;
    for (size_t i = 0; i < count; i++)
        polygon->order[i] = polygon_fan_corner(fan, i);
    for (size_t i = 0; i < 3 * (count - 2); i++)
        fan[i] = polygon->order[polygon->triangles[i]];
    return true;
}

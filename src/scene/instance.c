#include "scene/instance.h"

#include "scene/triangle.h"

#include <string.h>

#define INSTANCE_SCALE 0x1p16

/* The largest stretch is at most the root of the largest column sum times the largest row
 * sum; exact for rotations along axes, up to sqrt3 more for others, so the Frobenius norm
 * is taken where it is less. */
static double largest_stretch(const double m[4][4])
{
    double squares = 0.0, rows = 0.0, columns = 0.0;
    for (int i = 0; i < 3; i++) {
        double row = 0.0, column = 0.0;
        for (int j = 0; j < 3; j++) {
            squares += m[i][j] * m[i][j];
            row += fabs(m[i][j]);
            column += fabs(m[j][i]);
        }
        rows = fmax(rows, row);
        columns = fmax(columns, column);
    }
    return fmin(sqrt(squares), sqrt(rows * columns));
}

bool instance_fits(const struct xform *to_world)
{
    double out = largest_stretch(to_world->m), in = largest_stretch(to_world->inv);
    return out <= INSTANCE_SCALE && in <= INSTANCE_SCALE && out * in <= INSTANCE_SCALE;
}

void instance_init(struct instance *instance, int object, const struct xform *to_world,
                   const struct place *place)
{
    *instance = (struct instance){.object = object, .place = place};
    memcpy(instance->to_world, to_world->m, sizeof instance->to_world);
    memcpy(instance->to_object, to_world->inv, sizeof instance->to_object);
    instance->stretch = largest_stretch(to_world->inv);
}

void instance_bound(struct instance *instance, const float lower[3], const float upper[3])
{
    for (int i = 0; i < 3; i++) {
        const double *m = instance->to_world[i];
        double low = m[3], high = m[3], reach = fabs(m[3]);
        for (int j = 0; j < 3; j++) {
            double a = m[j] * (double)lower[j], b = m[j] * (double)upper[j];
            low += fmin(a, b);
            high += fmax(a, b);
            reach += fmax(fabs(a), fabs(b));
        }
        double slack = 16.0 * (double)TRIANGLE_EPSILON * reach;
        bool empty = lower[0] > upper[0];
        instance->lower[i] = empty ? INFINITY : (float)(low - slack);
        instance->upper[i] = empty ? -INFINITY : (float)(high + slack);
    }
}

struct vec3 instance_normal(const struct instance *instance, struct vec3 n,
                            double *length)
{
    const double(*w)[4] = instance->to_object;
    double m[3];
    for (int i = 0; i < 3; i++)
        m[i] = w[0][i] * (double)n.x + w[1][i] * (double)n.y + w[2][i] * (double)n.z;
    *length = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
    return vec3((float)(m[0] / *length), (float)(m[1] / *length),
                (float)(m[2] / *length));
}

struct vec3 instance_extent(const struct instance *instance, float reach)
{
    double sum[3];
    for (int i = 0; i < 3; i++) {
        const double *m = instance->to_world[i];
        sum[i] = (fabs(m[0]) + fabs(m[1]) + fabs(m[2])) * 2.0 * (double)reach;
    }
    return vec3((float)sum[0], (float)sum[1], (float)sum[2]);
}

void instance_place(const struct instance *instance, struct vec3 extent,
                    struct ray_endpoint *at, struct vec3 *n)
{
    double length, ignored;
    const float p[3] = {at->p.x, at->p.y, at->p.z};
    *n = instance_normal(instance, *n, &ignored);
    at->p = instance_affine(instance->to_world, p, 1.0);
    at->ng = instance_normal(instance, at->ng, &length);
    at->offset = (float)((double)at->offset / length) +
                 4.0f * TRIANGLE_EPSILON * abs_components_dot(at->ng, at->p) +
                 8.0f * TRIANGLE_EPSILON * abs_components_dot(at->ng, extent);
    at->far_offset = INSTANCE_FAR_END * (float)(instance->stretch / length);
    if (vec3_dot(at->ng, *n) < 0.0f)
        at->ng = vec3_neg(at->ng);
}

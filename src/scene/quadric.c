#include "scene/quadric.h"

#include "math/warp.h"

#include <float.h>
#include <string.h>

#define EPSILON 0x1p-24 /* unit roundoff of float */

static bool quadric_sizes_valid(const struct shape_desc *desc)
{
    if (!(desc->radius >= (double)FLT_MIN) || !isfinite(desc->radius))
        return false;
    if (desc->kind == SHAPE_DISK)
        return isfinite(desc->height);
    if (desc->kind == SHAPE_CYLINDER)
        return isfinite(desc->z_min) && isfinite(desc->z_max) &&
               desc->z_max > desc->z_min;
    return true;
}

bool quadric_init(struct quadric *quadric, const struct shape_desc *desc, struct err *err)
{
    if (!quadric_sizes_valid(desc))
        return err_set(err, ERR_VALUE, &desc->place,
                       "a shape's size must be finite, its radius a positive float and "
                       "z_max above z_min");
    if (!xform_is_affine(&desc->to_world))
        return err_set(err, ERR_VALUE, &desc->place,
                       "a shape's transform must be finite, affine and invertible");
    *quadric = (struct quadric){.kind = desc->kind,
                                .radius = desc->radius,
                                .height = desc->height,
                                .z_min = desc->z_min,
                                .z_max = desc->z_max,
                                .flip = desc->reverse_orientation};
    memcpy(quadric->to_world, desc->to_world.m, sizeof quadric->to_world);
    memcpy(quadric->to_object, desc->to_world.inv, sizeof quadric->to_object);
    double scale = 0.0;
    if (xform_is_similarity(&desc->to_world, &scale))
        quadric->scale = scale;
    if (desc->emits && quadric->scale <= 0.0)
        return err_set(err, ERR_UNSUPPORTED, &desc->place,
                       "a light on a sphere, disk or cylinder cannot be scaled unevenly "
                       "or sheared; use a mesh");
    float lower[3], upper[3];
    quadric_bounds(quadric, lower, upper);
    for (int i = 0; i < 3; i++)
        quadric->reach = fmaxf(quadric->reach, fmaxf(fabsf(lower[i]), fabsf(upper[i])));
    quadric->floor = 0x1p-40f * quadric->reach;
    return true;
}

static void affine_point(const double m[3][4], const double p[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = m[i][0] * p[0] + m[i][1] * p[1] + m[i][2] * p[2] + m[i][3];
}

static void affine_vector(const double m[3][4], const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
}

void quadric_bounds(const struct quadric *quadric, float lower[3], float upper[3])
{
    double r = quadric->radius;
    double z0 = quadric->kind == SHAPE_SPHERE     ? 0.0
                : quadric->kind == SHAPE_CYLINDER ? quadric->z_min
                                                  : quadric->height;
    double z1 = quadric->kind == SHAPE_CYLINDER ? quadric->z_max : z0;
    for (int i = 0; i < 3; i++) {
        const double *m = quadric->to_world[i];
        /* Support of a ball or of a circle about the axis, along the world axis i. */
        double ball = quadric->kind == SHAPE_SPHERE ? m[2] * m[2] : 0.0;
        double reach = r * sqrt(m[0] * m[0] + m[1] * m[1] + ball);
        double low = m[3] + fmin(m[2] * z0, m[2] * z1) - reach;
        double high = m[3] + fmax(m[2] * z0, m[2] * z1) + reach;
        /* A disk in a coordinate plane has no thickness: widen by some roundings. */
        double slack = 16.0 * EPSILON * (fabs(low) + fabs(high) + reach);
        lower[i] = (float)(low - slack);
        upper[i] = (float)(high + slack);
    }
}

/* Roots of the circle (n = 2) or sphere (n = 3) of radius r along o + t d. The
 * discriminant comes from the foot of the perpendicular, which does not cancel; the
 * roots from their sum and product, so that neither does. */
static bool quadric_roots(const double o[3], const double d[3], int n, double r,
                          double root[2])
{
    double a = 0.0, b = 0.0, oo = 0.0;
    for (int i = 0; i < n; i++) {
        a += d[i] * d[i];
        b += o[i] * d[i];
        oo += o[i] * o[i];
    }
    if (!(a > 0.0))
        return false;
    double foot = 0.0;
    for (int i = 0; i < n; i++) {
        double f = o[i] - b / a * d[i];
        foot += f * f;
    }
    double disc = (r - sqrt(foot)) * (r + sqrt(foot));
    if (!(disc >= 0.0))
        return false;
    double distance = sqrt(oo);
    double c = (distance - r) * (distance + r);
    double q = -(b + copysign(sqrt(a * disc), b));
    double t0 = q / a;
    double t1 = q != 0.0 ? c / q : t0;
    root[0] = fmin(t0, t1);
    root[1] = fmax(t0, t1);
    return true;
}

/* Projects the point at t back onto the surface, so that its error does not grow with the
 * distance of the ray's origin. */
static void quadric_refine(const struct quadric *quadric, double p[3])
{
    if (quadric->kind == SHAPE_DISK) {
        p[2] = quadric->height;
        return;
    }
    double z = quadric->kind == SHAPE_SPHERE ? p[2] : 0.0;
    double length = sqrt(p[0] * p[0] + p[1] * p[1] + z * z);
    if (!(length > 0.0))
        return;
    double k = quadric->radius / length;
    p[0] *= k;
    p[1] *= k;
    if (quadric->kind == SHAPE_SPHERE)
        p[2] *= k;
}

static bool quadric_inside(const struct quadric *quadric, const double p[3])
{
    if (quadric->kind == SHAPE_DISK)
        return p[0] * p[0] + p[1] * p[1] <= quadric->radius * quadric->radius;
    if (quadric->kind == SHAPE_CYLINDER)
        return p[2] >= quadric->z_min && p[2] <= quadric->z_max;
    return true;
}

bool quadric_intersect(const struct quadric *quadric, const float o[3], const float d[3],
                       double t_near, double t_far, struct quadric_hit *hit)
{
    double ow[3] = {(double)o[0], (double)o[1], (double)o[2]};
    double dw[3] = {(double)d[0], (double)d[1], (double)d[2]};
    double oo[3], dd[3], root[2];
    affine_point(quadric->to_object, ow, oo);
    affine_vector(quadric->to_object, dw, dd);
    if (quadric->kind == SHAPE_DISK) {
        if (dd[2] == 0.0)
            return false;
        root[0] = root[1] = (quadric->height - oo[2]) / dd[2];
    } else if (!quadric_roots(oo, dd, quadric->kind == SHAPE_SPHERE ? 3 : 2,
                              quadric->radius, root)) {
        return false;
    }
    for (int i = 0; i < 2; i++) {
        double t = root[i];
        if (!(t > t_near && t <= t_far))
            continue;
        for (int k = 0; k < 3; k++)
            hit->p[k] = oo[k] + t * dd[k];
        if (!quadric_inside(quadric, hit->p))
            continue;
        hit->t = t;
        quadric_refine(quadric, hit->p);
        return true;
    }
    return false;
}

static struct vec3 quadric_normal(const struct quadric *quadric, const double p[3])
{
    double n[3] = {p[0], p[1], quadric->kind == SHAPE_SPHERE ? p[2] : 0.0};
    if (quadric->kind == SHAPE_DISK) {
        n[0] = n[1] = 0.0;
        n[2] = 1.0;
    }
    double w[3]; /* by the inverse transpose */
    for (int i = 0; i < 3; i++)
        w[i] = quadric->to_object[0][i] * n[0] + quadric->to_object[1][i] * n[1] +
               quadric->to_object[2][i] * n[2];
    double length = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    double k = (quadric->flip ? -1.0 : 1.0) / length;
    return vec3((float)(w[0] * k), (float)(w[1] * k), (float)(w[2] * k));
}

struct ray_endpoint quadric_endpoint(const struct quadric *quadric, const double p[3])
{
    double w[3];
    affine_point(quadric->to_world, p, w);
    struct ray_endpoint endpoint = {.p = vec3((float)w[0], (float)w[1], (float)w[2]),
                                    .ng = quadric_normal(quadric, p)};
    /* p and p + offset ng are rounded, each by e of a component; twice that. */
    float offset = (float)(4.0 * EPSILON) * abs_components_dot(endpoint.ng, endpoint.p);
    endpoint.offset = offset > quadric->floor ? offset : quadric->floor;
    return endpoint;
}

void quadric_parameters(const struct quadric *quadric, const double p[3], float uv[2],
                        struct vec3 *dpdu)
{
    double phi = atan2(p[1], p[0]);
    if (phi < 0.0)
        phi += 2.0 * MATH_PI;
    uv[0] = (float)(phi / (2.0 * MATH_PI));
    double v;
    if (quadric->kind == SHAPE_SPHERE)
        v = 1.0 - acos(fmax(-1.0, fmin(1.0, p[2] / quadric->radius))) / MATH_PI;
    else if (quadric->kind == SHAPE_CYLINDER)
        v = (p[2] - quadric->z_min) / (quadric->z_max - quadric->z_min);
    else
        v = 1.0 - hypot(p[0], p[1]) / quadric->radius;
    uv[1] = (float)v;
    double du[3] = {-2.0 * MATH_PI * p[1], 2.0 * MATH_PI * p[0], 0.0}, w[3];
    affine_vector(quadric->to_world, du, w);
    *dpdu = vec3((float)w[0], (float)w[1], (float)w[2]);
}

double quadric_area(const struct quadric *quadric)
{
    double r = quadric->radius, s = quadric->scale;
    if (quadric->kind == SHAPE_SPHERE)
        return 4.0 * MATH_PI * r * r * s * s;
    if (quadric->kind == SHAPE_DISK)
        return MATH_PI * r * r * s * s;
    return 2.0 * MATH_PI * r * (quadric->z_max - quadric->z_min) * s * s;
}

struct ray_endpoint quadric_sample(const struct quadric *quadric, const double u[2])
{
    double r = quadric->radius, p[3];
    if (quadric->kind == SHAPE_DISK) {
        struct vec2 d = warp_disk(u);
        p[0] = r * d.x;
        p[1] = r * d.y;
        p[2] = quadric->height;
        return quadric_endpoint(quadric, p);
    }
    double ring = r; /* in double: warp_sphere's floats would leave the surface */
    if (quadric->kind == SHAPE_SPHERE) {
        double z = 1.0 - 2.0 * u[0];
        ring = r * sqrt(fmax(0.0, (1.0 - z) * (1.0 + z)));
        p[2] = r * z;
    } else {
        p[2] = quadric->z_min + u[0] * (quadric->z_max - quadric->z_min);
    }
    p[0] = ring * cos(2.0 * MATH_PI * u[1]);
    p[1] = ring * sin(2.0 * MATH_PI * u[1]);
    return quadric_endpoint(quadric, p);
}

bool quadric_invert(const struct quadric *quadric, struct vec3 place, double u[2])
{
    double w[3] = {(double)place.x, (double)place.y, (double)place.z}, p[3];
    affine_point(quadric->to_object, w, p);
    double r = quadric->radius, turn = atan2(p[1], p[0]) * (0.5 / MATH_PI);
    u[1] = turn < 0.0 ? turn + 1.0 : turn;
    if (quadric->kind == SHAPE_DISK) {
        warp_disk_inverse((struct vec2){p[0] / r, p[1] / r}, u);
    } else if (quadric->kind == SHAPE_CYLINDER) {
        u[0] = (p[2] - quadric->z_min) / (quadric->z_max - quadric->z_min);
    } else {
        double z = p[2] / sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
        u[0] = 0.5 * (1.0 - z);
    }
    return warp_in_square(u);
}

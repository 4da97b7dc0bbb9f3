/* Quadrics: hits against the plain formulas in long double, normals against the gradient
 * of the implicit surface, areas by quadrature of hits, bounds, refusals. */

#include "math/rng.h"
#include "math/warp.h"
#include "scene/quadric.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "support/near.h"

static struct shape_desc describe(enum shape_kind kind)
{
    return (struct shape_desc){.kind = kind,
                               .to_world = xform_identity(),
                               .radius = 1.5,
                               .height = 0.25,
                               .z_min = -0.5,
                               .z_max = 2.0};
}

static struct quadric make(const struct shape_desc *desc)
{
    struct quadric quadric;
    struct err err = {0};
    assert_true(quadric_init(&quadric, desc, &err));
    return quadric;
}

static double uniform(struct rng *rng, double lo, double hi)
{
    return lo + (hi - lo) * rng_double(rng);
}

struct ray {
    long double o[3], d[3];
};

/* On the finite surface, at parameter t > 0 of an object-space ray? */
static bool oracle_at(const struct shape_desc *desc, const struct ray *ray, long double t)
{
    if (!(t > 0.0L))
        return false;
    long double x = ray->o[0] + t * ray->d[0], y = ray->o[1] + t * ray->d[1],
                z = ray->o[2] + t * ray->d[2];
    if (desc->kind == SHAPE_DISK)
        return x * x + y * y <= (long double)desc->radius * (long double)desc->radius;
    if (desc->kind == SHAPE_CYLINDER)
        return z >= (long double)desc->z_min && z <= (long double)desc->z_max;
    return true;
}

/* Nearest t > 0, or -1; the school formula, which long double makes good enough. */
static long double oracle(const struct shape_desc *desc, const struct ray *ray)
{
    if (desc->kind == SHAPE_DISK) {
        long double t = ((long double)desc->height - ray->o[2]) / ray->d[2];
        return oracle_at(desc, ray, t) ? t : -1.0L;
    }
    int n = desc->kind == SHAPE_SPHERE ? 3 : 2;
    long double a = 0.0L, b = 0.0L,
                c = -(long double)desc->radius * (long double)desc->radius;
    for (int i = 0; i < n; i++) {
        a += ray->d[i] * ray->d[i];
        b += 2.0L * ray->o[i] * ray->d[i];
        c += ray->o[i] * ray->o[i];
    }
    long double disc = b * b - 4.0L * a * c;
    if (disc < 0.0L)
        return -1.0L;
    for (int sign = -1; sign <= 1; sign += 2) {
        long double t = (-b + (long double)sign * sqrtl(disc)) / (2.0L * a);
        if (oracle_at(desc, ray, t))
            return t;
    }
    return -1.0L;
}

static struct ray object_ray(const struct xform *to_world, const float o[3],
                             const float d[3])
{
    struct ray ray = {{0.0L}, {0.0L}};
    for (int i = 0; i < 3; i++) {
        ray.o[i] = (long double)to_world->inv[i][3];
        for (int k = 0; k < 3; k++) {
            ray.o[i] += (long double)to_world->inv[i][k] * (long double)o[k];
            ray.d[i] += (long double)to_world->inv[i][k] * (long double)d[k];
        }
    }
    return ray;
}

static struct xform skewed(void)
{
    const double m[16] = {1.0, 0.3, -0.2, 2.0, 0.1, 1.7, 0.4, -1.0,
                          0.2, 0.0, 0.8,  5.0, 0.0, 0.0, 0.0, 1.0};
    struct xform xform;
    assert_true(xform_from_matrix(m, &xform));
    return xform;
}

static void hits_equal_the_oracle(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, 0);
    for (int kind = SHAPE_SPHERE; kind <= SHAPE_CYLINDER; kind++) {
        struct shape_desc desc = describe((enum shape_kind)kind);
        desc.to_world = skewed();
        struct quadric quadric = make(&desc);
        float lower[3], upper[3];
        quadric_bounds(&quadric, lower, upper);
        int hits = 0, inside = 0;
        for (int i = 0; i < 100000; i++) {
            float o[3], d[3];
            double far = pow(10.0, uniform(&rng, -1.0, 3.0));
            double to[3] = {uniform(&rng, 0, 4), uniform(&rng, -4, 2),
                            uniform(&rng, 3, 8)};
            for (int k = 0; k < 3; k++) {
                o[k] = (float)(to[k] + far * uniform(&rng, -1.0, 1.0));
                d[k] = (float)to[k] - o[k];
            }
            struct ray ray = object_ray(&desc.to_world, o, d);
            long double t = oracle(&desc, &ray);
            struct quadric_hit hit;
            bool found = quadric_intersect(&quadric, o, d, 0.0, (double)INFINITY, &hit);
            assert_true(found == (t > 0.0L));
            if (!found)
                continue;
            hits++;
            /* A grazing root is ill-conditioned: judge the residual in space instead. */
            for (int k = 0; k < 3; k++) {
                long double x = ray.o[k] + t * ray.d[k];
                assert_near(hit.p[k], (double)x, 1e-9);
            }
            struct ray_endpoint at = quadric_endpoint(&quadric, hit.p);
            const float p[3] = {at.p.x, at.p.y, at.p.z};
            for (int k = 0; k < 3; k++)
                assert_true(p[k] >= lower[k] && p[k] <= upper[k]);
            /* t_far and t_near are honoured. */
            struct quadric_hit other;
            assert_false(
                quadric_intersect(&quadric, o, d, 0.0, hit.t * (1.0 - 1e-12), &other));
            if (quadric_intersect(&quadric, o, d, hit.t, (double)INFINITY, &other)) {
                assert_true(other.t > hit.t);
                inside++;
            }
        }
        assert_true(hits > 10000);
        assert_true(kind == SHAPE_DISK ? inside == 0 : inside > 1000);
    }
}

/* The world-space normal is perpendicular to the image of every tangent, unit, and
 * outward; flip turns it. */
static void normals_are_perpendicular(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 2, RNG_TEST, 0);
    for (int kind = SHAPE_SPHERE; kind <= SHAPE_CYLINDER; kind++)
        for (int flip = 0; flip < 2; flip++) {
            struct shape_desc desc = describe((enum shape_kind)kind);
            desc.reverse_orientation = flip;
            struct quadric straight = make(&desc);
            desc.to_world = skewed();
            struct quadric quadric = make(&desc);
            for (int i = 0; i < 1000; i++) {
                double u[2] = {rng_double(&rng), rng_double(&rng)};
                straight.scale = 1.0;
                struct ray_endpoint object = quadric_sample(&straight, u);
                double p[3] = {(double)object.p.x, (double)object.p.y,
                               (double)object.p.z};
                struct ray_endpoint at = quadric_endpoint(&quadric, p);
                struct frame tangents = frame_from_normal(object.ng);
                struct vec3 s = xform_vector(&desc.to_world, tangents.s);
                struct vec3 t = xform_vector(&desc.to_world, tangents.t);
                assert_near(vec3_length(at.ng), 1.0, 3e-7);
                assert_near(vec3_dot(at.ng, s), 0.0, 2e-6);
                assert_near(vec3_dot(at.ng, t), 0.0, 2e-6);
                struct vec3 out = kind == SHAPE_DISK ? vec3(0, 0, 1) : object.p;
                if (kind == SHAPE_CYLINDER)
                    out.z = 0.0f;
                struct vec3 world = xform_vector(&desc.to_world, out);
                assert_true(vec3_dot(at.ng, world) * (flip ? -1.0f : 1.0f) > 0.0f);
            }
        }
}

/* Area from grids of parallel rays along the three axes, every crossing counted: one
 * along axis a stands for dA |n_a|, and weighted by |n_a| the three make n^2 dA = dA. */
static void areas_by_quadrature(void **state)
{
    (void)state;
    const int n = 600;
    for (int kind = SHAPE_SPHERE; kind <= SHAPE_CYLINDER; kind++) {
        struct shape_desc desc = describe((enum shape_kind)kind);
        struct xform grow = xform_scale(-1.3, 1.3, 1.3), turn = xform_rotate(35, 1, 2, 3);
        desc.to_world = xform_mul(&turn, &grow);
        struct quadric quadric = make(&desc);
        assert_near(quadric.scale, 1.3, 1e-9);
        double sum = 0.0, cell = 12.0 / n;
        for (int axis = 0; axis < 3; axis++)
            for (int i = 0; i < n * n; i++) {
                float o[3], d[3] = {0.0f, 0.0f, 0.0f};
                o[axis] = -10.0f;
                d[axis] = 1.0f;
                o[(axis + 1) % 3] = (float)(-6.0 + cell * (i % n + 0.5));
                o[(axis + 2) % 3] = (float)(-6.0 + cell * (i / n + 0.5));
                struct quadric_hit hit;
                double t = 0.0;
                while (quadric_intersect(&quadric, o, d, t, (double)INFINITY, &hit)) {
                    struct ray_endpoint at = quadric_endpoint(&quadric, hit.p);
                    const float ng[3] = {at.ng.x, at.ng.y, at.ng.z};
                    sum += fabs((double)ng[axis]) * cell * cell;
                    t = hit.t;
                }
            }
        assert_near(sum / quadric_area(&quadric), 1.0, 2e-3);
    }
}

static void parameters_follow_the_surface(void **state)
{
    (void)state;
    struct shape_desc desc = describe(SHAPE_CYLINDER);
    struct quadric quadric = make(&desc);
    const double p[3] = {0.0, 1.5, 1.375};
    float uv[2];
    struct vec3 dpdu;
    quadric_parameters(&quadric, p, uv, &dpdu);
    assert_near(uv[0], 0.25, 1e-7);
    assert_near(uv[1], 0.75, 1e-7);
    assert_near(dpdu.x, -3.0 * MATH_PI, 1e-5);
    assert_near(dpdu.y, 0.0, 1e-5);
    desc = describe(SHAPE_SPHERE);
    quadric = make(&desc);
    const double south[3] = {0.0, 0.0, -1.5}, equator[3] = {-1.5, 0.0, 0.0};
    quadric_parameters(&quadric, south, uv, &dpdu);
    assert_near(uv[1], 0.0, 1e-7);
    quadric_parameters(&quadric, equator, uv, &dpdu);
    assert_near(uv[0], 0.5, 1e-7);
    assert_near(uv[1], 0.5, 1e-7);
    desc = describe(SHAPE_DISK);
    quadric = make(&desc);
    const double half[3] = {0.0, -0.75, 0.25};
    quadric_parameters(&quadric, half, uv, &dpdu);
    assert_near(uv[0], 0.75, 1e-7);
    assert_near(uv[1], 0.5, 1e-7);
}

static void refuses(void **state)
{
    (void)state;
    struct shape_desc bad[6];
    for (int i = 0; i < 6; i++)
        bad[i] = describe(SHAPE_CYLINDER);
    bad[0].radius = 0.0;
    bad[1].radius = (double)NAN;
    bad[2].z_max = bad[2].z_min;
    bad[3].to_world.m[0][3] = (double)INFINITY;
    bad[4].to_world.m[3][2] = 0.5; /* projective */
    bad[5].to_world = skewed();
    bad[5].emits = true;
    for (int i = 0; i < 6; i++) {
        struct quadric quadric;
        struct err err = {0};
        assert_false(quadric_init(&quadric, &bad[i], &err));
        assert_int_equal(err.code, i == 5 ? ERR_UNSUPPORTED : ERR_VALUE);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(hits_equal_the_oracle),
        cmocka_unit_test(normals_are_perpendicular),
        cmocka_unit_test(areas_by_quadrature),
        cmocka_unit_test(parameters_follow_the_surface),
        cmocka_unit_test(refuses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

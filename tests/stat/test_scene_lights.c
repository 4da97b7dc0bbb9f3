/* Statistical tests of lights. Family false-alarm rate 1e-3, Sidak over all tests; fixed
 * seeds. */

#include "math/accum.h"
#include "math/rng.h"
#include "math/warp.h"
#include "support/scene_fixture.h"
#include "support/stat_test.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#define KINDS   4 /* mesh, sphere, disk, cylinder */
#define TESTS   (3 * KINDS + 3)
#define ALPHA   1e-3
#define SAMPLES 200000

/* One lamp that fills a scene, in its own coordinates. */
static struct scene *lamp(int kind, bool two_sided)
{
    struct scene_desc *desc = fixture_desc();
    struct shape_desc *shape;
    if (kind == SHAPE_MESH) {
        static const double profile[] = {0, 0, 2, 0, 1, 1, 1, 3}; /* uneven triangles */
        shape = fixture_mesh(desc, mesh_lathe(profile, 4, 7, true, 30.0));
    } else {
        shape = fixture_quadric(desc, (enum shape_kind)kind, xform_identity());
    }
    shape->emits = true;
    shape->two_sided = two_sided;
    shape->radiance = rgb(3.0, 2.0, 1.0);
    return fixture_build(desc);
}

/* Cell of a point, and the share of the area that it should have, from the shape's own
 * geometry: triangles for a mesh, (z, angle) or (r^2, angle) for quadrics. */
#define CELLS 64

static int cell_of(int kind, struct vec3 p)
{
    double phi = atan2((double)p.y, (double)p.x) / (2.0 * MATH_PI) + 0.5;
    double x = kind == SHAPE_DISK ? (double)(p.x * p.x + p.y * p.y)
                                  : 0.5 * ((double)p.z + 1.0);
    int i = (int)fmin(7.0, 8.0 * phi), j = (int)fmin(7.0, fmax(0.0, 8.0 * x));
    return 8 * j + i;
}

static void quadric_points_are_uniform(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, 0);
    for (int kind = SHAPE_SPHERE; kind <= SHAPE_CYLINDER; kind++) {
        struct scene *scene = lamp(kind, false);
        double observed[CELLS] = {0.0}, expected[CELLS];
        for (int i = 0; i < SAMPLES; i++) {
            double u[2] = {rng_double(&rng), rng_double(&rng)};
            struct hit sampled;
            light_sample(scene, rng_double(&rng), u, &sampled);
            struct ray_endpoint a = sampled.at;
            observed[cell_of(kind, a.p)] += 1.0;
        }
        for (int i = 0; i < CELLS; i++)
            expected[i] = (double)SAMPLES / CELLS;
        double p = stat_chi2_p(observed, expected, CELLS);
        assert_true(stat_ok("points on a quadric", p, stat_sidak(ALPHA, TESTS)));
        scene_destroy(scene);
    }
}

/* By triangle of the mesh and by the four quarters of each, found from the point alone.
 */
static int quarter_of(const struct shape *shape, struct vec3 p)
{
    int best = -1;
    double nearest = (double)INFINITY;
    for (uint32_t i = 0; i < shape->triangles.count; i++) {
        const uint32_t *index = shape->triangles.index + 3 * (size_t)i;
        double v[3][3], m[2][2] = {{0}}, r[2] = {0}, off = 0.0;
        for (int k = 0; k < 3; k++) {
            double o = (double)shape->triangles.p[3 * (size_t)index[0] + (size_t)k];
            const float q[3] = {p.x, p.y, p.z};
            for (int j = 1; j < 3; j++)
                v[j][k] = (double)shape->triangles.p[3 * (size_t)index[j] + (size_t)k] -
                          o;
            v[0][k] = (double)q[k] - o;
        }
        for (int k = 0; k < 3; k++) {
            for (int a = 0; a < 2; a++) {
                r[a] += v[a + 1][k] * v[0][k];
                for (int b = 0; b < 2; b++)
                    m[a][b] += v[a + 1][k] * v[b + 1][k];
            }
        }
        double det = m[0][0] * m[1][1] - m[0][1] * m[1][0];
        double b1 = (r[0] * m[1][1] - r[1] * m[0][1]) / det;
        double b2 = (r[1] * m[0][0] - r[0] * m[1][0]) / det, b0 = 1.0 - b1 - b2;
        for (int k = 0; k < 3; k++)
            off = fmax(off, fabs(v[0][k] - b1 * v[1][k] - b2 * v[2][k]));
        off += fmax(0.0, -fmin(b0, fmin(b1, b2)));
        if (off < nearest) {
            nearest = off;
            int quarter = b0 > 0.5 ? 0 : b1 > 0.5 ? 1 : b2 > 0.5 ? 2 : 3;
            best = 4 * (int)i + quarter;
        }
    }
    return best;
}

/* By Heron's formula, from the vertices alone. */
static double heron(const struct shape *shape, int triangle)
{
    const uint32_t *index = shape->triangles.index + 3 * (size_t)triangle;
    double length[3], half = 0.0;
    for (int j = 0; j < 3; j++) {
        const float *a = shape->triangles.p + 3 * (size_t)index[j];
        const float *b = shape->triangles.p + 3 * (size_t)index[(j + 1) % 3];
        double sum = 0.0;
        for (int k = 0; k < 3; k++)
            sum += ((double)b[k] - (double)a[k]) * ((double)b[k] - (double)a[k]);
        length[j] = sqrt(sum);
        half += 0.5 * length[j];
    }
    return sqrt(half * (half - length[0]) * (half - length[1]) * (half - length[2]));
}

static void mesh_points_are_uniform(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 2, RNG_TEST, 0);
    struct scene *scene = lamp(SHAPE_MESH, false);
    const struct shape *shape = &scene->shapes[0];
    int cells = 4 * (int)shape->triangles.count;
    double observed[256] = {0.0}, expected[256], area = 0.0;
    assert_true(cells <= 256);
    for (int i = 0; i < SAMPLES; i++) {
        double u[2] = {rng_double(&rng), rng_double(&rng)};
        struct hit sampled;
        light_sample(scene, rng_double(&rng), u, &sampled);
        struct ray_endpoint a = sampled.at;
        observed[quarter_of(shape, a.p)] += 1.0;
    }
    for (int i = 0; i < cells / 4; i++)
        area += heron(shape, i);
    for (int i = 0; i < cells; i++)
        expected[i] = SAMPLES * 0.25 * heron(shape, i / 4) / area;
    double p = stat_chi2_p(observed, expected, cells);
    assert_true(stat_ok("points on a mesh", p, stat_sidak(ALPHA, TESTS)));
    scene_destroy(scene);
}

/* Directions against the cosine law, on one side or two: cells of equal probability. */
static void directions_follow_their_density(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 3, RNG_TEST, 0);
    for (int kind = 0; kind < KINDS; kind++) {
        bool two_sided = kind % 2;
        struct scene *scene = lamp(kind, two_sided);
        const struct light *light = &scene->lights[0];
        double observed[CELLS] = {0.0}, expected[CELLS];
        for (int i = 0; i < SAMPLES; i++) {
            double u[2] = {rng_double(&rng), rng_double(&rng)},
                   v[2] = {rng_double(&rng), rng_double(&rng)}, pdf;
            struct hit sampled;
            struct vec3 w;
            struct rgb weight;
            light_sample(scene, 0.5, u, &sampled);
            struct ray_endpoint a = sampled.at;
            if (!light->type->sample_direction(light, &a, v, &w, &pdf, &weight))
                continue;
            struct frame f = frame_from_normal(a.ng);
            struct vec3 l = frame_to_local(&f, w);
            double phi = atan2((double)l.y, (double)l.x) / (2.0 * MATH_PI) + 0.5;
            /* sin^2 is uniform under the cosine law; below the surface it goes on. */
            double s = (double)(l.x * l.x + l.y * l.y);
            double x = !two_sided ? s : l.z > 0.0f ? 0.5 * s : 1.0 - 0.5 * s;
            int j = (int)fmin(7.0, 8.0 * x);
            observed[8 * j + (int)fmin(7.0, 8.0 * phi)] += 1.0;
        }
        for (int i = 0; i < CELLS; i++)
            expected[i] = (double)SAMPLES / CELLS;
        double p = stat_chi2_p(observed, expected, CELLS);
        assert_true(stat_ok("directions of a lamp", p, stat_sidak(ALPHA, TESTS)));
        scene_destroy(scene);
    }
}

/* Power by definition: the integral of L cos over area and all directions, sampled
 * uniformly over the sphere (not by the light's own sampler). */
static double power_estimate(struct rng *rng, const struct scene *scene, int samples)
{
    const struct light *light = &scene->lights[0];
    double sum = 0.0;
    for (int i = 0; i < samples; i++) {
        double u[2] = {rng_double(rng), rng_double(rng)},
               v[2] = {rng_double(rng), rng_double(rng)};
        struct hit sampled;
        light_sample(scene, 0.5, u, &sampled);
        struct ray_endpoint a = sampled.at;
        struct vec3 w = warp_sphere(v);
        double cos = fabs((double)vec3_dot(a.ng, w));
        sum += rgb_luminance(light_emission(light, &a, w)) * cos;
    }
    return sum / samples * light->area * 4.0 * MATH_PI;
}

static void power_by_monte_carlo(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 4, RNG_TEST, 0);
    for (int kind = 0; kind < KINDS; kind++) {
        struct scene *scene = lamp(kind, kind % 2 == 0);
        double x[50];
        for (int i = 0; i < 50; i++)
            x[i] = power_estimate(&rng, scene, 4000);
        double p = stat_mean_p(x, 50, scene->lights[0].power);
        assert_true(stat_ok("power", p, stat_sidak(ALPHA, TESTS)));
        scene_destroy(scene);
    }
}

/* A spot of either kind of edge: its weights have the mean that a uniform sphere of
 * directions finds, and the density that goes with them. */
static void spots_send_what_they_emit(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 6, RNG_TEST, 0);
    for (int linear = 0; linear < 2; linear++) {
        struct scene_desc *desc = fixture_desc();
        struct light_desc spot = {.type = &light_spot,
                                  .to_world = xform_rotate(40.0, 1.0, 2.0, 0.5),
                                  .intensity = {2.0, 2.0, 2.0},
                                  .inner = 30.0,
                                  .outer = 75.0,
                                  .linear = linear != 0};
        scene_desc_add_light(desc, &spot);
        struct scene *scene = fixture_build(desc);
        const struct light *light = &scene->lights[0];
        double difference[50];
        for (int k = 0; k < 50; k++) {
            double sum = 0.0;
            for (int i = 0; i < 4000; i++) {
                double u[2] = {rng_double(&rng), rng_double(&rng)}, pdf;
                struct ray_endpoint a = {.p = light->position};
                struct vec3 w = warp_sphere(u);
                struct rgb weight;
                sum -= light_emission(light, &a, w).g * 4.0 * MATH_PI;
                if (!light->type->sample_direction(light, &a, u, &w, &pdf, &weight))
                    continue;
                assert_true(fabs(pdf / light->type->pdf_direction(light, &a, w) - 1.0) <
                            1e-12);
                sum += weight.g;
            }
            difference[k] = sum / 4000.0;
        }
        double p = stat_mean_p(difference, 50, 0.0);
        assert_true(stat_ok("spot", p, stat_sidak(ALPHA, TESTS)));
        scene_destroy(scene);
    }
}

/* Shares of picks follow the powers. */
static void picks_follow_power(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 5, RNG_TEST, 0);
    struct scene_desc *desc = fixture_desc();
    for (int i = 0; i < 10; i++) {
        struct light_desc light = {.to_world = xform_identity(),
                                   .intensity = {0.1 * i * i, 0.3, 1.0 / (i + 1.0)}};
        scene_desc_add_light(desc, &light);
    }
    struct scene *scene = fixture_build(desc);
    double observed[10] = {0.0}, expected[10], sum = 0.0;
    for (int i = 0; i < 10; i++)
        sum += rgb_luminance(desc->lights[i].intensity);
    for (int i = 0; i < 10; i++)
        expected[i] = SAMPLES * rgb_luminance(desc->lights[i].intensity) / sum;
    for (int i = 0; i < SAMPLES; i++) {
        double u[2] = {0.5, 0.5};
        struct hit sampled;
        observed[light_sample(scene, rng_double(&rng), u, &sampled) - scene->lights] +=
            1.0;
    }
    double p = stat_chi2_p(observed, expected, 10);
    assert_true(stat_ok("picks", p, stat_sidak(ALPHA, TESTS)));
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(quadric_points_are_uniform),
        cmocka_unit_test(mesh_points_are_uniform),
        cmocka_unit_test(directions_follow_their_density),
        cmocka_unit_test(power_by_monte_carlo),
        cmocka_unit_test(spots_send_what_they_emit),
        cmocka_unit_test(picks_follow_power),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

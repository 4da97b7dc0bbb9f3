/* Warps: inverse round trips, ends of the square, sine and cosine. Their laws are tested
 * in tests/stat/. */
#include "math/rng.h"
#include "math/warp.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include <math.h>

#define LAST_U (1.0 - 0x1p-53)

/* Corners, edges, diagonals and centre of the square first, then random points. */
static void pick(struct rng *rng, int k, double u[2])
{
    static const double special[] = {0.0, 0x1p-53, 0.25, 0.5, 0.75, LAST_U};
    u[0] = k < 36 ? special[k % 6] : rng_double(rng);
    u[1] = k < 36 ? special[k / 6] : rng_double(rng);
}

static double length(struct vec3 w)
{
    return sqrt((double)w.x * (double)w.x + (double)w.y * (double)w.y +
                (double)w.z * (double)w.z);
}

static double distance(struct vec3 a, struct vec3 b)
{
    return length(vec3((a.x - b.x), (a.y - b.y), (a.z - b.z)));
}

static void sine_and_cosine_are_full_precision(void **state)
{
    (void)state;
    for (int k = 0; k <= 100000; k++) {
        double u = k / 100000.0;
        struct vec2 p = warp_circle(u);
        long double angle = 2.0L * 3.14159265358979323846264338328L * (long double)u;
        assert_true(fabsl((long double)p.x - cosl(angle)) < 4e-16L);
        assert_true(fabsl((long double)p.y - sinl(angle)) < 4e-16L);
    }
    static const double quarters[5][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 0}};
    for (int q = 0; q <= 4; q++) {
        struct vec2 p = warp_circle(q / 4.0);
        assert_true(p.x == quarters[q][0] && p.y == quarters[q][1]);
    }
}

static void the_angle_of_a_point_is_full_precision(void **state)
{
    (void)state;
    const long double turn = 2.0L * 3.14159265358979323846264338328L;
    struct rng rng;
    rng_init(&rng, 4, RNG_TEST, 0);
    for (int k = 0; k < 300000; k++) {
        double size = pow(10.0, 20.0 * rng_double(&rng) - 10.0);
        struct vec2 p = {size * (2.0 * rng_double(&rng) - 1.0),
                         size * (2.0 * rng_double(&rng) - 1.0)};
        if (k % 3 == 0) /* close to an axis */
            p.y *= pow(10.0, -16.0 * rng_double(&rng));
        long double angle = atan2l((long double)p.y, (long double)p.x) / turn;
        angle = angle < 0.0L ? angle + 1.0L : angle;
        double u = warp_circle_inverse(p);
        assert_true(u >= 0.0 && u <= 1.0);
        assert_true(fabsl((long double)u - angle) <= 2e-15L * angle);
    }
    static const double quarters[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    for (int q = 0; q < 4; q++)
        assert_true(warp_circle_inverse((struct vec2){quarters[q][0], quarters[q][1]}) ==
                    q / 4.0);
}

static void disk_and_its_inverse(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, 0);
    for (int k = 0; k < 100000; k++) {
        double u[2], back[2];
        pick(&rng, k, u);
        struct vec2 p = warp_disk(u);
        assert_true(hypot(p.x, p.y) <= 1.0 + 1e-15);
        warp_disk_inverse(p, back);
        assert_true(fabs(back[0] - u[0]) < 1e-15 && fabs(back[1] - u[1]) < 1e-15);
        assert_true(back[0] >= 0.0 && back[0] < 1.0 && back[1] >= 0.0 && back[1] < 1.0);
    }
}

static void cosine_hemisphere_and_its_inverse(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 2, RNG_TEST, 0);
    for (int k = 0; k < 100000; k++) {
        double u[2], back[2];
        pick(&rng, k, u);
        struct vec3 w = warp_cosine(u);
        assert_true(w.z > 0.0f && warp_cosine_pdf(w.z) > 0.0);
        assert_true(fabs(length(w) - 1.0) < 1.2e-7);
        warp_cosine_inverse(w, back); /* as exact as floats are */
        assert_true(fabs(back[0] - u[0]) < 1.2e-7 && fabs(back[1] - u[1]) < 1.2e-7);
    }
    assert_true(warp_cosine_pdf(0.0f) == 0.0 && warp_cosine_pdf(-0.5f) == 0.0);
    assert_true(fabs(warp_cosine_pdf(0.5f) - 0.15915494309189534) < 1e-16);
}

static void sphere_and_its_inverse(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 3, RNG_TEST, 0);
    for (int k = 0; k < 100000; k++) {
        double u[2], back[2];
        pick(&rng, k, u);
        struct vec3 w = warp_sphere(u);
        assert_true(fabs(length(w) - 1.0) < 1.2e-7);
        warp_sphere_inverse(w, back);
        assert_true(back[0] >= 0.0 && back[0] < 1.0 && back[1] >= 0.0 && back[1] < 1.0);
        assert_true(fabs(back[0] - u[0]) < 1e-7);
        /* Near the poles z tells little of the radius: 1 - z^2 has error 1.2e-7. */
        double radius = 2.0 * sqrt(u[0] * (1.0 - u[0]));
        double bound = 2e-7 + fmin(1.2e-7 / fmax(radius, 1e-30), 4e-4);
        assert_true(distance(warp_sphere(back), w) < bound);
    }
}

/* Across the fold of the octahedron and up to its edges. That areas are equal, the test
 * of environments tells. */
static void octahedron_and_its_inverse(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 6, RNG_TEST, 0);
    for (int k = 0; k < 100000; k++) {
        double u[2], back[2], d[3], again[3];
        pick(&rng, k, u);
        warp_octahedron(u, d);
        assert_true(fabs(d[0] * d[0] + d[1] * d[1] + d[2] * d[2] - 1.0) < 1e-14);
        warp_octahedron_inverse(d, back);
        warp_octahedron(back, again);
        for (int i = 0; i < 3; i++)
            assert_true(fabs(again[i] - d[i]) < 1e-7);
    }
    static const double corners[][5] = {{0.5, 0.5, 0, 0, 1}, {0, 0, 0, 0, -1},
                                        {1, 1, 0, 0, -1},    {1, 0.5, 1, 0, 0},
                                        {0.5, 1, 0, 1, 0},   {0, 0.5, -1, 0, 0}};
    for (int c = 0; c < 6; c++) {
        double d[3];
        warp_octahedron(corners[c], d);
        for (int i = 0; i < 3; i++)
            assert_true(fabs(d[i] - corners[c][2 + i]) < 1e-12);
    }
}

static void triangle_and_its_inverse(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 4, RNG_TEST, 0);
    for (int k = 0; k < 100000; k++) {
        double u[2], back[2];
        pick(&rng, k, u);
        struct vec2 b = warp_triangle(u);
        assert_true(b.x >= 0.0 && b.y >= 0.0 && b.x + b.y < 1.0);
        warp_triangle_inverse(b, back);
        assert_true(fabs(back[0] - u[0]) < 3e-16 && fabs(back[1] - u[1]) < 3e-16);
    }
}

/* A small step of a chain must stay small: no warp tears the square's inside apart, with
 * the bounds on stretching that each map has. */
static void warps_are_continuous(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 5, RNG_TEST, 0);
    const double h = 1e-6;
    for (int k = 0; k < 100000; k++) {
        double u[2] = {rng_double(&rng) * (1 - h), rng_double(&rng) * (1 - h)};
        double v[2] = {u[0] + h * rng_double(&rng), u[1] + h * rng_double(&rng)};
        struct vec2 a = warp_disk(u), b = warp_disk(v);
        assert_true(hypot(a.x - b.x, a.y - b.y) < 4.0 * h);
        a = warp_triangle(u);
        b = warp_triangle(v);
        assert_true(hypot(a.x - b.x, a.y - b.y) < 2.0 * h);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sine_and_cosine_are_full_precision),
        cmocka_unit_test(the_angle_of_a_point_is_full_precision),
        cmocka_unit_test(disk_and_its_inverse),
        cmocka_unit_test(cosine_hemisphere_and_its_inverse),
        cmocka_unit_test(sphere_and_its_inverse),
        cmocka_unit_test(octahedron_and_its_inverse),
        cmocka_unit_test(triangle_and_its_inverse),
        cmocka_unit_test(warps_are_continuous),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

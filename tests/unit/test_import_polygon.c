/* import/mesh/polygon: triangles of concave polygons cover them once. Of star-shaped
 * polygons in a tilted plane the area is known (shoelace), and that of their triangles is
 * larger wherever two overlap or one lies outside: no chance is in it but the fixed
 * seed's. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "base/mem.h"
#include "import/mesh/polygon.h"
#include "math/rng.h"

#include <math.h>
#include <string.h>

/* Star-shaped about the origin of a tilted plane; returns its area. */
static double make_star(struct polygon *polygon, size_t count, struct rng *rng, bool back)
{
    const double s[3] = {0.6, 0.8, 0.0}, t[3] = {-0.48, 0.36, 0.8};
    double area = 0.0, first[2] = {0.0, 0.0}, before[2] = {0.0, 0.0};
    polygon_reserve(polygon, count);
    for (size_t i = 0; i < count; i++) {
        double radius = 0.1 + rng_double(rng);
        double angle = 6.283185307179586 * (double)i / (double)count;
        double at[2] = {radius * cos(angle), radius * sin(angle)};
        size_t place = back ? count - 1 - i : i;
        for (int k = 0; k < 3; k++)
            polygon->p[place][k] = 3.0 + at[0] * s[k] + at[1] * t[k];
        area += 0.5 * (before[0] * at[1] - before[1] * at[0]);
        memcpy(before, at, sizeof at);
        if (i == 0)
            memcpy(first, at, sizeof at);
    }
    return area + 0.5 * (before[0] * first[1] - before[1] * first[0]);
}

static double triangle_size(const struct polygon *polygon, const uint32_t *t)
{
    const double *a = polygon->p[t[0]], *b = polygon->p[t[1]], *c = polygon->p[t[2]];
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        double n = (b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]);
        sum += n * n;
    }
    return 0.5 * sqrt(sum);
}

static void make_fan(uint32_t *fan, size_t count)
{
    for (size_t i = 0; i + 2 < count; i++) {
        fan[3 * i] = 0;
        fan[3 * i + 1] = (uint32_t)i + 1;
        fan[3 * i + 2] = (uint32_t)i + 2;
    }
}

static void stars_are_covered_once(void **state)
{
    (void)state;
    struct polygon polygon = {0};
    struct rng rng;
    uint32_t fan[3 * 64];
    rng_init(&rng, 1, RNG_BOOTSTRAP, 0);
    int concave = 0;
    for (int round = 0; round < 600; round++) {
        size_t count = 4 + (size_t)round % 57;
        double area = make_star(&polygon, count, &rng, round % 2), sum = 0.0;
        make_fan(fan, count);
        concave += !polygon_is_convex(&polygon, count);
        assert_true(polygon_mend_fan(&polygon, count, fan));
        for (size_t i = 0; i < count - 2; i++)
            sum += triangle_size(&polygon, fan + 3 * i);
        assert_true(fabs(sum / area - 1.0) < 1e-9);
    }
    assert_true(concave > 500);
    polygon_deinit(&polygon);
}

static void fill(struct polygon *polygon, size_t count, const double (*p)[3])
{
    polygon_reserve(polygon, count);
    memcpy(polygon->p, p, count * sizeof *p);
}

static void convex_ones_stay_fans(void **state)
{
    (void)state;
    static const double square[5][3] = {
        {0, 0, 1}, {1, 0, 1}, {1, 0.5, 1}, {1, 1, 1}, {0, 1, 1}};
    struct polygon polygon = {0};
    uint32_t fan[9], kept[9];
    fill(&polygon, 5, square);
    make_fan(fan, 5);
    memcpy(kept, fan, sizeof fan);
    assert_true(polygon_mend_fan(&polygon, 5, fan));
    assert_memory_equal(fan, kept, sizeof fan);
    polygon_deinit(&polygon);
}

/* A triangle and a square that a line of no width joins; a square with a hole; a polygon
 * without area; one whose border crosses itself. */
static void odd_ones(void **state)
{
    (void)state;
    static const double key[10][3] = {{0, 0, 0},   {1, 0, 0},  {1, 0.5, 0}, {2, 0.5, 0},
                                      {2, 0, 0},   {3, 0, 0},  {3, 1, 0},   {2, 1, 0},
                                      {2, 0.5, 0}, {1, 0.5, 0}};
    static const double line[4][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 0}};
    static const double crossed[5][3] = {
        {0, 0, 0}, {4, 0, 0}, {1, 3, 0}, {2, -1, 0}, {3, 3, 0}};
    struct polygon polygon = {0};
    uint32_t fan[24];
    double sum = 0.0;
    fill(&polygon, 10, key);
    make_fan(fan, 10);
    assert_true(polygon_mend_fan(&polygon, 10, fan));
    for (int i = 0; i < 8; i++)
        sum += triangle_size(&polygon, fan + 3 * i);
    assert_true(fabs(sum - 1.25) < 1e-12);
    static const double hole[10][3] = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0},
                                       {0, 0, 0}, {1, 1, 0}, {1, 2, 0}, {2, 2, 0},
                                       {2, 1, 0}, {1, 1, 0}};
    fill(&polygon, 10, hole);
    make_fan(fan, 10);
    assert_true(polygon_mend_fan(&polygon, 10, fan));
    sum = 0.0;
    for (int i = 0; i < 8; i++)
        sum += triangle_size(&polygon, fan + 3 * i);
    assert_true(fabs(sum - 8.0) < 1e-12);
    fill(&polygon, 4, line);
    make_fan(fan, 4);
    assert_true(polygon_mend_fan(&polygon, 4, fan));
    fill(&polygon, 5, crossed);
    make_fan(fan, 5);
    polygon_mend_fan(&polygon, 5, fan); /* either way: three triangles of its corners */
    for (int i = 0; i < 9; i++)
        assert_true(fan[i] < 5);
    polygon_deinit(&polygon);
}

/* Beyond the bound the fan stays, and that is told. */
static void too_many_corners(void **state)
{
    (void)state;
    struct polygon polygon = {0};
    struct rng rng;
    size_t count = POLYGON_MOST + 1;
    uint32_t *fan = mem_alloc(3 * count, sizeof *fan);
    rng_init(&rng, 2, RNG_BOOTSTRAP, 0);
    make_star(&polygon, count, &rng, false);
    make_fan(fan, count);
    assert_false(polygon_mend_fan(&polygon, count, fan));
    assert_true(fan[3] == 0 && fan[4] == 2 && fan[5] == 3);
    make_star(&polygon, count - 1, &rng, false);
    assert_true(polygon_mend_fan(&polygon, count - 1, fan));
    polygon_deinit(&polygon);
    mem_free(fan);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stars_are_covered_once),
        cmocka_unit_test(convex_ones_stay_fans),
        cmocka_unit_test(odd_ones),
        cmocka_unit_test(too_many_corners),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

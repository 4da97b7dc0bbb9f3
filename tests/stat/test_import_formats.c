/* One scene in two formats: the peer-box as pbrt and as Mitsuba XML, rendered by bdpt
 * with other seeds. Welch's t for every pixel block and channel and for the film's mean
 * in each channel shares one false-alarm rate, over replicate renders, by Sidak. A
 * picture that is mirrored, a field of view along another axis, a depth limit off by one
 * or a lamp on the other side all fail (see the worst t that is printed when something
 * does). Skipped (77) without the scene. */

#include "import/import.h"
#include "math/accum.h"

#include <string.h>

#include "support/stat_test.h"
#include "support/test_run.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define PEER_BOX    "../shared/scenes/peer-box/"
#define FALSE_ALARM 1e-4
#define REPLICATES  24
#define SIZE        32
#define BLOCK       4
#define ACROSS      (SIZE / BLOCK)
#define CELLS       (3 * (ACROSS * ACROSS + 1))

static const char *const names[] = {"diffuse", "glass"};

#define SCENES ((int)(sizeof names / sizeof names[0]))

/* Sums over the replicates: blocks by rows, then the whole film; three channels each. */
struct sums {
    struct welford cell[CELLS];
};

static void add_picture(struct sums *sums, const struct image *image)
{
    double cell[CELLS] = {0};
    for (int y = 0; y < SIZE; y++) {
        for (int x = 0; x < SIZE; x++) {
            int block = y / BLOCK * ACROSS + x / BLOCK;
            for (int c = 0; c < 3; c++) {
                double value = (double)image_at(image, x, y)[c];
                cell[3 * block + c] += value / (BLOCK * BLOCK);
                cell[CELLS - 3 + c] += value / (SIZE * SIZE);
            }
        }
    }
    for (int i = 0; i < CELLS; i++)
        welford_add(&sums->cell[i], cell[i]);
}

static void render(const char *name, const char *ending, int first_seed,
                   struct sums *sums)
{
    const char *words[] = {"integrator=bdpt", "mutations_per_pixel=12", NULL};
    char path[128];
    struct err err = {0};
    snprintf(path, sizeof path, PEER_BOX "%s%s", name, ending);
    struct scene_desc *desc = import_scene(path, NULL, &err);
    if (desc == NULL)
        test_scene_die(&err);
    desc->width = desc->height = SIZE;
    struct scene *scene = test_build(desc, false);
    struct settings s = test_settings(words);
    for (int i = 0; i < REPLICATES; i++) {
        s.seed = first_seed + i;
        struct run_result r = test_run(scene, &s);
        add_picture(sums, r.image);
        run_result_deinit(&r);
    }
    scene_destroy(scene);
}

/* Two-sided p of Welch's t-test, and t. */
static double welch(const struct welford *a, const struct welford *b, double *t)
{
    double va = welford_variance(a) / a->count, vb = welford_variance(b) / b->count;
    double freedom = (va + vb) * (va + vb) /
                     (va * va / (a->count - 1.0) + vb * vb / (b->count - 1.0));
    *t = va + vb > 0.0 ? (a->mean - b->mean) / sqrt(va + vb) : 0.0;
    return va + vb > 0.0 ? stat_t_p(*t, freedom) : a->mean == b->mean;
}

static void compare(const char *name, const struct sums *a, const struct sums *b)
{
    double level = stat_sidak(FALSE_ALARM, CELLS * SCENES), squares = 0.0, worst = 0.0;
    bool ok = true;
    for (int i = 0; i < CELLS; i++) {
        double t, p = welch(&a->cell[i], &b->cell[i], &t);
        char what[64];
        snprintf(what, sizeof what, "%s: cell %d channel %d, t %.2f", name, i / 3, i % 3,
                 t);
        ok = stat_ok(what, p, level) && ok;
        squares += t * t;
        worst = fabs(t) > fabs(worst) ? t : worst;
    }
    printf("    %s: worst t of %d: %.2f, rms %.3f\n", name, CELLS, worst,
           sqrt(squares / CELLS));
    assert_true(ok);
}

static void test_two_formats(void **state)
{
    (void)state;
    for (int i = 0; i < SCENES; i++) {
        struct sums pbrt = {0}, mitsuba = {0};
        render(names[i], ".pbrt", 1, &pbrt);
        render(names[i], ".xml", 1001, &mitsuba);
        compare(names[i], &mitsuba, &pbrt);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_two_formats)};
    FILE *there = fopen(PEER_BOX "glass.xml", "r");
    if (there == NULL) {
        printf("no " PEER_BOX "\n");
        return 77;
    }
    fclose(there);
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* PSSMLT against bdpt on the peer-box, a scene of which others rendered references:
 * replicate runs of both, over both builders and both estimators. Four families of tests
 * share the false-alarm rate: Welch's t for every pixel and channel, every block of
 * pixels and channel, and the film's mean in each channel; and one test of the whole
 * picture.
 *
 * The t values of one picture hang together (a chain that stays long at a bright path
 * moves many pixels, b moves all), so no law of independent ones holds for their sum. The
 * whole picture is tested instead by T = sum over pairs of replicates i != j of
 * <D_i, D_j>, D_i the weighted difference picture of the i-th replicates: its mean is the
 * squared difference of the true means, 0 if these agree. What T varies by is learned
 * from the same D_i with all choices of signs, which is exact where the law of D_i is
 * symmetric and holds for many replicates otherwise. 24 replicates make 2^23 choices:
 * with fewer, T could hardly reach the level.
 *
 * The law of a pixel has a long tail to the bright side, so t leans to the dark one, the
 * more the fewer mutations a pixel gets; the films of the quick test are small for that
 * reason. What the quick test sees is some per cent; ETALON_LONG, at 128x128, less than
 * one. Skipped (77) without the scene. */

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
#define FAMILIES    4
#define WORDS       8

static const char *const scenes[] = {PEER_BOX "diffuse.pbrt", PEER_BOX "glass.pbrt"};

static const char *const variants[][3] = {
    {"builder=bdpt", "estimator=kelemen", "large_step_probability=auto"},
    {"builder=bdpt", "estimator=plain", "large_step_probability=0.5"},
    {"builder=pt", "estimator=kelemen", "large_step_probability=auto"},
};

#define SCENES   ((int)(sizeof scenes / sizeof scenes[0]))
#define VARIANTS ((int)(sizeof variants / sizeof variants[0]))

struct pictures {
    struct image *run[REPLICATES];
};

static struct scene *load(const char *path, int size)
{
    struct err err = {0};
    struct scene_desc *desc = import_scene(path, NULL, &err);
    if (desc == NULL)
        test_scene_die(&err);
    desc->width = desc->height = size;
    return test_build(desc, false);
}

static struct pictures render(const struct scene *scene, const char *const *words,
                              int first_seed, bool full)
{
    struct pictures p;
    struct settings s = test_settings(words);
    s.threads = full ? 0 : 1;
    for (int i = 0; i < REPLICATES; i++) {
        s.seed = first_seed + i;
        struct run_result r = test_run(scene, &s);
        assert_true(r.statistics.nonfinite == 0.0 && r.statistics.saturated == 0.0);
        p.run[i] = r.image;
    }
    return p;
}

static void pictures_deinit(struct pictures *p)
{
    for (int i = 0; i < REPLICATES; i++)
        image_destroy(p->run[i]);
}

/* Mean of a channel over the block of `side` pixels with its corner at (x, y). */
static double block_mean(const struct image *image, int x, int y, int side, int channel)
{
    double sum = 0.0;
    for (int j = y; j < y + side; j++)
        for (int i = x; i < x + side; i++)
            sum += (double)image_at(image, i, j)[channel];
    return sum / (side * side);
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

static void compare_blocks(const struct pictures *a, const struct pictures *b, int side)
{
    int width = a->run[0]->width, across = width / side, cells = across * across * 3;
    double level = stat_sidak(FALSE_ALARM / FAMILIES, cells * SCENES * VARIANTS);
    double worst = 0.0, squares = 0.0;
    for (int i = 0; i < cells; i++) {
        struct welford wa = {0}, wb = {0};
        int x = i / 3 % across * side, y = i / 3 / across * side;
        double t;
        for (int j = 0; j < REPLICATES; j++) {
            welford_add(&wa, block_mean(a->run[j], x, y, side, i % 3));
            welford_add(&wb, block_mean(b->run[j], x, y, side, i % 3));
        }
        double p = welch(&wa, &wb, &t);
        char what[64];
        snprintf(what, sizeof what, "%dx%d at %d,%d channel %d, t %.2f", side, side, x, y,
                 i % 3, t);
        assert_true(stat_ok(what, p, level));
        worst = fabs(t) > fabs(worst) ? t : worst;
        squares += t * t;
    }
    printf("    %dx%d: worst t of %d: %.2f, rms %.3f\n", side, side, cells, worst,
           sqrt(squares / cells));
}

/* products[i][j] = <D_i, D_j>: relative differences, or a few dark pixels count for
 * nothing and a few bright ones for all. */
static void inner_products(const struct pictures *a, const struct pictures *b,
                           double products[REPLICATES][REPLICATES])
{
    long values = 3L * a->run[0]->width * a->run[0]->height;
    double floor = 0.1 * rgb_luminance(test_image_mean(b->run[0]));
    memset(products, 0, sizeof(double[REPLICATES][REPLICATES]));
    for (long k = 0; k < values; k++) {
        double d[REPLICATES], mean = 0.0;
        for (int i = 0; i < REPLICATES; i++) {
            d[i] = (double)a->run[i]->pixels[k] - (double)b->run[i]->pixels[k];
            mean += (double)b->run[i]->pixels[k] / REPLICATES;
        }
        double weight = 1.0 / (mean * mean + floor * floor);
        for (int i = 0; i < REPLICATES; i++)
            for (int j = 0; j < REPLICATES; j++)
                products[i][j] += weight * d[i] * d[j] / (double)values;
    }
}

/* T for every choice of signs (that of the last is +, for only products count), one sign
 * changed from choice to choice; p: the share of them that are no less than the observed
 * T, which has all signs +. */
static double signs_p(double products[REPLICATES][REPLICATES], double *deviations)
{
    double sign[REPLICATES], observed = 0.0, squares = 0.0;
    long choices = 1L << (REPLICATES - 1), above = 1;
    for (int i = 0; i < REPLICATES; i++) {
        sign[i] = 1.0;
        for (int j = 0; j < i; j++)
            observed += products[i][j];
    }
    double sum = observed, slack = 1e-9 * fabs(observed);
    for (long n = 1; n < choices; n++) {
        int flip = __builtin_ctzl((unsigned long)n);
        double change = 0.0;
        for (int j = 0; j < REPLICATES; j++)
            if (j != flip)
                change += sign[j] * products[flip][j];
        sum -= 2.0 * sign[flip] * change;
        sign[flip] = -sign[flip];
        above += sum >= observed - slack;
        squares += sum * sum;
    }
    *deviations = observed / sqrt(squares / (double)choices);
    return (double)above / (double)choices;
}

static void compare_whole(const struct pictures *a, const struct pictures *b)
{
    double products[REPLICATES][REPLICATES], deviations;
    inner_products(a, b, products);
    double p = signs_p(products, &deviations);
    printf("    whole: T %.2f of its standard deviations, p %.4g\n", deviations, p);
    assert_true(stat_ok("whole picture", p,
                        stat_sidak(FALSE_ALARM / FAMILIES, SCENES * VARIANTS)));
}

static void check_scene(const char *path)
{
    bool full = getenv("ETALON_LONG") != NULL;
    const char *words[WORDS] = {"integrator=bdpt", "max_depth=6"};
    int size = full ? 128 : 16;
    words[2] = full ? "mutations_per_pixel=80" : "mutations_per_pixel=40";
    struct scene *scene = load(path, size);
    struct pictures bdpt = render(scene, words, 1, full);
    words[0] = "integrator=pssmlt";
    words[3] = full ? "bootstrap=50000" : "bootstrap=10000";
    for (int i = 0; i < VARIANTS; i++) {
        for (int j = 0; j < 3; j++)
            words[4 + j] = variants[i][j];
        printf("%s, %s, %s, %s\n", path, words[4], words[5], words[6]);
        /* Seeds of its own: both builders see the same numbers. */
        struct pictures pssmlt = render(scene, words, 1001 + 1000 * i, full);
        compare_blocks(&pssmlt, &bdpt, 1);
        compare_blocks(&pssmlt, &bdpt, full ? 8 : 4);
        compare_blocks(&pssmlt, &bdpt, size);
        compare_whole(&pssmlt, &bdpt);
        pictures_deinit(&pssmlt);
    }
    pictures_deinit(&bdpt);
    scene_destroy(scene);
}

static void test_peer_box(void **state)
{
    (void)state;
    for (int i = 0; i < SCENES; i++)
        check_scene(scenes[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_peer_box)};
    FILE *there = fopen(scenes[0], "r");
    if (there == NULL) {
        printf("no " PEER_BOX "\n");
        return 77;
    }
    fclose(there);
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#ifndef ETALON_TESTS_SUPPORT_PICTURE_TEST_H
#define ETALON_TESTS_SUPPORT_PICTURE_TEST_H

/* Two integrators' pictures of one scene: the same but for noise? Replicate runs of both
 * are compared in families that share a false-alarm rate: Welch's t for every block of
 * pixels and channel (picture_blocks; of one pixel, of some, of all), and one test of the
 * whole picture (picture_signs_p).
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
 * more the fewer mutations a pixel gets. */

#include "math/accum.h"
#include "support/stat_test.h"
#include "support/test_run.h"

#include <string.h>

#define PICTURE_REPLICATES 24

struct pictures {
    struct image *run[PICTURE_REPLICATES];
};

/* Replicates by seeds first_seed and on; words ended by NULL. A run that met a value that
 * is not finite, or a splat too bright for the film, is no picture to compare. */
static inline struct pictures pictures_render(const struct scene *scene,
                                              const char *const *words, int first_seed,
                                              bool all_threads)
{
    struct pictures p;
    struct settings s = test_settings(words);
    s.threads = all_threads ? 0 : 1;
    for (int i = 0; i < PICTURE_REPLICATES; i++) {
        s.seed = first_seed + i;
        struct run_result r = test_run(scene, &s);
        if (r.statistics.nonfinite > 0.0 || r.statistics.saturated > 0.0) {
            fprintf(stderr, "seed %ld: %g not finite, %g saturated\n", s.seed,
                    r.statistics.nonfinite, r.statistics.saturated);
            abort();
        }
        p.run[i] = r.image;
        r.image = NULL;
        run_result_deinit(&r);
    }
    return p;
}

static inline void pictures_deinit(struct pictures *p)
{
    for (int i = 0; i < PICTURE_REPLICATES; i++)
        image_destroy(p->run[i]);
}

/* --- blocks ----------------------------------------------------------------------- */

/* Mean of a channel over the block of width x height pixels with its corner at (x, y). */
static inline double picture_block_mean(const struct image *image, int x, int y,
                                        int width, int height, int channel)
{
    double sum = 0.0;
    for (int j = y; j < y + height; j++)
        for (int i = x; i < x + width; i++)
            sum += (double)image_at(image, i, j)[channel];
    return sum / (width * height);
}

/* Two-sided p of Welch's t-test, and t. */
static inline double picture_welch(const struct welford *a, const struct welford *b,
                                   double *t)
{
    double va = welford_variance(a) / a->count, vb = welford_variance(b) / b->count;
    double freedom = (va + vb) * (va + vb) /
                     (va * va / (a->count - 1.0) + vb * vb / (b->count - 1.0));
    *t = va + vb > 0.0 ? (a->mean - b->mean) / sqrt(va + vb) : 0.0;
    return va + vb > 0.0 ? stat_t_p(*t, freedom) : a->mean == b->mean;
}

/* Blocks of width x height pixels that fit whole; `level` is the family's. */
static inline bool picture_blocks(const struct pictures *a, const struct pictures *b,
                                  int width, int height, double level)
{
    int across = a->run[0]->width / width, down = a->run[0]->height / height;
    int cells = across * down * 3;
    double each = stat_sidak(level, cells), worst = 0.0, squares = 0.0;
    bool ok = true;
    for (int i = 0; i < cells; i++) {
        struct welford wa = {0}, wb = {0};
        int x = i / 3 % across * width, y = i / 3 / across * height;
        double t;
        for (int j = 0; j < PICTURE_REPLICATES; j++) {
            welford_add(&wa, picture_block_mean(a->run[j], x, y, width, height, i % 3));
            welford_add(&wb, picture_block_mean(b->run[j], x, y, width, height, i % 3));
        }
        double p = picture_welch(&wa, &wb, &t);
        char what[64];
        snprintf(what, sizeof what, "%dx%d at %d,%d channel %d, t %.2f", width, height, x,
                 y, i % 3, t);
        ok = stat_ok(what, p, each) && ok;
        worst = fabs(t) > fabs(worst) ? t : worst;
        squares += t * t;
    }
    printf("    %dx%d: worst t of %d: %.2f, rms %.3f\n", width, height, cells, worst,
           sqrt(squares / cells));
    return ok;
}

/* --- the whole picture ------------------------------------------------------------ */

typedef double picture_products[PICTURE_REPLICATES][PICTURE_REPLICATES];

/* products[i][j] = <D_i, D_j>: relative differences, or a few dark pixels count for
 * nothing and a few bright ones for all. */
static inline void picture_inner_products(const struct pictures *a,
                                          const struct pictures *b,
                                          picture_products products)
{
    long values = 3L * a->run[0]->width * a->run[0]->height;
    double floor = 0.1 * rgb_luminance(test_image_mean(b->run[0]));
    memset(products, 0, sizeof(picture_products));
    for (long k = 0; k < values; k++) {
        double d[PICTURE_REPLICATES], mean = 0.0;
        for (int i = 0; i < PICTURE_REPLICATES; i++) {
            d[i] = (double)a->run[i]->pixels[k] - (double)b->run[i]->pixels[k];
            mean += (double)b->run[i]->pixels[k] / PICTURE_REPLICATES;
        }
        double weight = 1.0 / (mean * mean + floor * floor);
        for (int i = 0; i < PICTURE_REPLICATES; i++)
            for (int j = 0; j < PICTURE_REPLICATES; j++)
                products[i][j] += weight * d[i] * d[j] / (double)values;
    }
}

/* T for every choice of signs (that of the last is +, for only products count), one sign
 * changed from choice to choice; p: the share of them that are no less than the observed
 * T, which has all signs +. */
static inline double picture_signs(picture_products products, double *deviations)
{
    double sign[PICTURE_REPLICATES], observed = 0.0, squares = 0.0;
    double row[PICTURE_REPLICATES]; /* sum over j != i of sign_j <D_i, D_j> */
    long choices = 1L << (PICTURE_REPLICATES - 1), above = 1;
    for (int i = 0; i < PICTURE_REPLICATES; i++) {
        products[i][i] = 0.0;
        row[i] = 0.0;
        sign[i] = 1.0;
        for (int j = 0; j < PICTURE_REPLICATES; j++)
            row[i] += i == j ? 0.0 : products[i][j];
        observed += 0.5 * row[i];
    }
    double sum = observed, slack = 1e-9 * fabs(observed);
    for (long n = 1; n < choices; n++) {
        int flip = __builtin_ctzl((unsigned long)n);
        double twice = 2.0 * sign[flip];
        sum -= twice * row[flip];
        for (int j = 0; j < PICTURE_REPLICATES; j++)
            row[j] -= twice * products[flip][j];
        sign[flip] = -sign[flip];
        above += sum >= observed - slack;
        squares += sum * sum;
    }
    *deviations = observed / sqrt(squares / (double)choices);
    return (double)above / (double)choices;
}

/* p of the whole picture; at least 2^-23. */
static inline double picture_signs_p(const struct pictures *a, const struct pictures *b)
{
    picture_products products;
    double deviations;
    picture_inner_products(a, b, products);
    double p = picture_signs(products, &deviations);
    printf("    whole: T %.2f of its standard deviations, p %.4g\n", deviations, p);
    return p;
}

/* --- all four families ------------------------------------------------------------ */

/* Pixels, blocks of width x height, the film's mean, and the whole picture; false if any
 * family is below its part of `level`. */
static inline bool picture_same(const struct pictures *a, const struct pictures *b,
                                int width, int height, double level)
{
    double each = stat_sidak(level, 4);
    int film_width = a->run[0]->width, film_height = a->run[0]->height;
    bool ok = picture_blocks(a, b, 1, 1, each);
    ok = picture_blocks(a, b, width, height, each) && ok;
    ok = picture_blocks(a, b, film_width, film_height, each) && ok;
    return stat_ok("whole picture", picture_signs_p(a, b), each) && ok;
}

#endif

/* estimate_pt against a path tracer by hand (support/pt_oracle.h).
 *
 * Sample by sample and channel by channel, on the same numbers. Both compute every
 * direction, cosine, BSDF value and emission by the same operations, so that these are
 * equal in all bits. What differs is the order in which terms are made of them: products,
 * quotients and sums of positive doubles, whose relative errors add up by at most
 * U = 2^-53 an operation.
 *
 * - Light hit by chance, estimate_pt: 7 (1/d^2, two for its density, the ratio, the sum,
 *   the weight, its product with the value).
 * - The same, oracle: 5 (both densities, their sum, the ratio, the product).
 * - Next-event estimation, estimate_pt: 12, of them 5 for the value (1/d^2, two for the
 *   geometric term, the density, the product), 6 for the weight (1/d^2, two for the other
 *   density, the ratio, the sum, the weight), 1 for the product of the two.
 * - The same, oracle: 5 (the cosines, a density, their sum, the ratio, the product).
 *
 * A term thus differs by at most 17, and one an addition on each side for the sum of all
 * terms: a path of k edges has k hits and k - 1 connections. One U more covers terms of
 * second order. The bound holds for every sample: there is no false alarm.
 *
 * Power: of faults 1 + 2^-k planted into the weight of either kind of term, those down to
 * 2^-47 are seen.
 *
 * By their means, each on numbers of its own: the film, each path length, quarters of the
 * film. This test stays valid if one of the two comes to ask for other numbers.
 *
 * False alarms: FALSE_ALARM for all figures of all scenes together. Power: each scene
 * prints the smallest bias that nine of ten runs see; of the film it is 3 to 5 %, and the
 * test fails where it would not be below SEES_LEAST. Of planted faults it sees next-event
 * estimation without its cosine (19 sigmas), with the density of the reverse direction
 * (5) or without the choice of the light (17), hits after a delta lobe weighted as others
 * (9), shading normals that let light leak (7). It misses a weight of hits that is 1 %
 * too large, and light that leaks by sampled directions alone. */

#include "math/accum.h"
#include "support/pt_oracle.h"
#include "support/stat_test.h"
#include "support/test_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include <string.h>

#define SAMPLES 20000
#define DEPTH   6
#define U       0x1p-53
#define TERM    17
#define TERMS   (2 * DEPTH - 1)
#define BOUND   (TERM + 2 * (TERMS - 1) + 1)
/* Where walks and connections pass surfaces (path/passage.h), each adds five operations
 * on each side at most, and a path passes less than so many of them. */
#define PASSED        (4 * DEPTH)
#define BOUND_PASSING (BOUND + 10 * PASSED)

/* --- sample by sample, on the same numbers ----------------------------------------- */

static struct rgb splat_sum(const struct contrib *c)
{
    struct rgb sum = {0.0, 0.0, 0.0};
    for (int i = 0; i < c->count; i++)
        sum = rgb_add(sum, c->splats[i].value);
    return sum;
}

/* |a - b| over the larger, in U. */
static double apart(double a, double b)
{
    double most = fmax(fabs(a), fabs(b));
    return most > 0.0 ? fabs(a - b) / (U * most) : 0.0;
}

static double samples_apart(const struct contrib *a, const struct contrib *b)
{
    struct rgb x = splat_sum(a), y = splat_sum(b);
    return fmax(apart(x.r, y.r), fmax(apart(x.g, y.g), apart(x.b, y.b)));
}

static void compare(enum test_contents contents)
{
    struct scene *scene = test_scene(contents, false);
    struct rng rng[2];
    struct ustream_random u[2];
    struct subpaths paths[2];
    struct contrib out[2];
    long lit = 0, beyond = 0;
    double worst = 0.0;
    int bound = scene->needs.straight ? BOUND_PASSING : BOUND;
    for (int i = 0; i < 2; i++) {
        rng_init(&rng[i], 21, RNG_TEST, contents);
        ustream_random_init(&u[i], &rng[i]);
        subpaths_init(&paths[i], scene, DEPTH);
        contrib_init(&out[i], estimate_splats(DEPTH));
    }
    for (long i = 0; i < SAMPLES; i++) {
        for (int j = 0; j < 2; j++) {
            struct numbers numbers = {&u[j].stream, &u[j].stream, &u[j].stream};
            (j ? pt_oracle : estimate_pt)(&paths[j], &numbers, &out[j]);
        }
        double distance = samples_apart(&out[0], &out[1]);
        worst = fmax(worst, distance);
        lit += out[0].count > 0;
        beyond += distance > bound;
        assert_int_equal(paths[0].pixel, paths[1].pixel);
    }
    printf(
        "%-10s %ld of %d samples are lit; the worst is %.1f U apart, bound %d; beyond it "
        "%ld\n",
        test_contents_name[contents], lit, SAMPLES, worst, bound, beyond);
    assert_true(lit > SAMPLES / 4);
    assert_int_equal(beyond, 0);
    assert_int_equal(out[0].nonfinite + out[1].nonfinite, 0);
    for (int i = 0; i < 2; i++) {
        contrib_deinit(&out[i]);
        subpaths_deinit(&paths[i]);
    }
    scene_destroy(scene);
}

static void test_samples(void **state)
{
    (void)state;
    for (int i = 0; i < TEST_CONTENTS; i++)
        compare((enum test_contents)i);
}

/* --- means, on numbers of their own ------------------------------------------------ */

#define FALSE_ALARM 1e-4 /* of all figures of all scenes together */
#define REPLICATES  64
#define LENGTHS     5 /* edges of the longest path */
#define SEES_LEAST  0.06

/* Numbers of a randomly shifted lattice [Cranley76]: point i has, at place j, the
 * fractional part of i GENERATOR^j / POINTS + shift_j. It is uniform, so that means are
 * unbiased; a replicate is one shift. The lattice lays four points into each pixel: most
 * of the noise would come from where on the film a path begins. */
#define CAMERA_PLACES (DIMS_CAMERA_VERTEX + 3 * LENGTHS)
#define PLACES        (CAMERA_PLACES + DIMS_DIRECT + 3 * LENGTHS)
#define POINTS        1021 /* a prime */
#define GENERATOR     65

struct lattice {
    double step[PLACES], shift[PLACES];
    int point;
};

static void lattice_init(struct lattice *l, struct rng *rng)
{
    long power = 1;
    for (int j = 0; j < PLACES; j++) {
        l->step[j] = (double)power / POINTS;
        l->shift[j] = rng_double(rng);
        power = power * GENERATOR % POINTS;
    }
}

struct lattice_stream {
    struct ustream stream; /* must be first */
    const struct lattice *lattice;
    int first; /* place in the lattice of this stream's place 0 */
    double values[USTREAM_MAX_COUNT];
};

static const double *lattice_take(struct ustream *self, int place, int count)
{
    struct lattice_stream *s = (struct lattice_stream *)self;
    const struct lattice *l = s->lattice;
    for (int i = 0; i < count; i++) {
        int j = s->first + place + i;
        double x = l->point * l->step[j] + l->shift[j];
        s->values[i] = x - floor(x);
    }
    return s->values;
}

enum figure {
    FIGURE_FILM,                              /* luminance, mean over the film */
    FIGURE_LENGTH,                            /* of paths of 1, 2, ... edges alone */
    FIGURE_QUARTER = FIGURE_LENGTH + LENGTHS, /* of a quarter of the 16 x 16 film */
    FIGURES = FIGURE_QUARTER + 4
};

static const char *const figure_names[FIGURES] = {
    "film",    "1 edge",    "2 edges",   "3 edges",   "4 edges",
    "5 edges", "quarter 1", "quarter 2", "quarter 3", "quarter 4"};

static int quarter_of(int pixel)
{
    return pixel / 128 * 2 + pixel % 16 / 8;
}

typedef void (*estimate_function)(struct subpaths *paths, const struct numbers *numbers,
                                  struct contrib *out);

/* All figures of one shift of the lattice. Paths of k edges bring what the sum up to k
 * has beyond the sum up to k - 1 on the same numbers. */
static void replicate(struct subpaths *paths, struct contrib *out,
                      estimate_function estimate, struct rng *rng,
                      double figures[FIGURES])
{
    struct lattice lattice;
    struct lattice_stream camera = {{lattice_take}, &lattice, 0, {0.0}};
    struct lattice_stream connect = {{lattice_take}, &lattice, CAMERA_PLACES, {0.0}};
    struct numbers numbers = {&camera.stream, NULL, &connect.stream};
    lattice_init(&lattice, rng);
    memset(figures, 0, FIGURES * sizeof *figures);
    for (lattice.point = 0; lattice.point < POINTS; lattice.point++) {
        double shorter = 0.0;
        for (int k = 1; k <= LENGTHS; k++) {
            paths->max_depth = k;
            estimate(paths, &numbers, out);
            figures[FIGURE_LENGTH + k - 1] += (out->target - shorter) / POINTS;
            shorter = out->target;
        }
        figures[FIGURE_FILM] += shorter / POINTS;
        figures[FIGURE_QUARTER + quarter_of(paths->pixel)] += shorter / POINTS;
    }
}

/* Over replicates. Both tracers have the same law, so that the law of the difference is
 * symmetric, and heavy tails make the t-test err less often than it says. */
struct means {
    struct welford oracle[FIGURES], difference[FIGURES];
};

static struct means gather(const struct scene *scene, int stream, int replicates)
{
    struct means m = {0};
    struct rng rng[2];
    struct subpaths paths;
    struct contrib out;
    double figures[2][FIGURES];
    subpaths_init(&paths, scene, LENGTHS);
    contrib_init(&out, estimate_splats(LENGTHS));
    for (int j = 0; j < 2; j++)
        rng_init(&rng[j], 22, RNG_TEST, (uint64_t)(2 * stream + j));
    for (int i = 0; i < replicates; i++) {
        replicate(&paths, &out, estimate_pt, &rng[0], figures[0]);
        replicate(&paths, &out, pt_oracle, &rng[1], figures[1]);
        for (int j = 0; j < FIGURES; j++) {
            welford_add(&m.oracle[j], figures[1][j]);
            welford_add(&m.difference[j], figures[0][j] - figures[1][j]);
        }
    }
    assert_int_equal(out.nonfinite, 0);
    contrib_deinit(&out);
    subpaths_deinit(&paths);
    return m;
}

/* Of a difference to which `bias` is added. */
static double difference_p(const struct welford *difference, double bias)
{
    double se = welford_se(difference), d = difference->mean + bias;
    return se > 0.0 ? stat_t_p(d / se, difference->count - 1.0) : d == 0.0 ? 1.0 : 0.0;
}

/* The smallest relative bias that fails the test at `level` in nine of ten runs; the
 * largest of some figures. A figure that is zero has none. */
static double sees(const struct means *m, int first, int count, double level)
{
    double most = 0.0;
    for (int i = first; i < first + count; i++) {
        const struct welford *d = &m->difference[i];
        if (m->oracle[i].mean > 0.0)
            most = fmax(most, stat_t_seen(level, d->count - 1.0, 0.9) * welford_se(d) /
                                  m->oracle[i].mean);
    }
    return most;
}

static void print_means(const char *name, const struct means *m, double level, double p)
{
    const struct welford *film = &m->difference[FIGURE_FILM];
    printf("%-10s film %.6f, difference %.6f +- %.6f; worst of %d: (%.1f sigmas); sees "
           "%.1f %% of the film, %.1f %% of each quarter; of 1, 2, ... edges",
           name, m->oracle[FIGURE_FILM].mean, film->mean, welford_se(film), FIGURES,
           stat_sigmas(p), 100.0 * sees(m, FIGURE_FILM, 1, level),
           100.0 * sees(m, FIGURE_QUARTER, 4, level));
    for (int k = 0; k < LENGTHS; k++)
        printf(" %.1f %%", 100.0 * sees(m, FIGURE_LENGTH + k, 1, level));
    printf("\n");
}

static void test_means(void **state)
{
    (void)state;
    double level = stat_sidak(FALSE_ALARM, FIGURES * TEST_CONTENTS);
    int replicates = REPLICATES * (getenv("ETALON_LONG") ? 10 : 1);
    for (int i = 0; i < TEST_CONTENTS; i++) {
        struct scene *scene = test_scene((enum test_contents)i, false);
        /* A lamp that is dark in most places, a wide lens: each sample tells less. */
        int times = i == TEST_SURFACES || i == TEST_PARALLEL_LENS ? 4 : 1;
        struct means m = gather(scene, i, times * replicates);
        double least = 1.0;
        bool ok = true;
        for (int j = 0; j < FIGURES; j++) {
            char line[64];
            double p = difference_p(&m.difference[j], 0.0);
            snprintf(line, sizeof line, "%s, %s", test_contents_name[i], figure_names[j]);
            ok = stat_ok(line, p, level) && ok;
            least = fmin(least, p);
        }
        print_means(test_contents_name[i], &m, level, least);
        assert_true(ok);
        assert_true(sees(&m, FIGURE_FILM, 1, level) < SEES_LEAST);
        scene_destroy(scene);
    }
}

/* --- how often the test of means errs, and what it sees ----------------------------- */

#define RUNS        200
#define OFTEN       0.05 /* a false-alarm rate that some runs show */
#define NINE_TENTHS 0.9

/* Runs with seeds of their own: of the film's figure, as it is and with the bias planted
 * that nine of ten runs are to see. */
static void test_rates(void **state)
{
    (void)state;
    if (!getenv("ETALON_LONG"))
        skip();
    double level = stat_sidak(FALSE_ALARM, FIGURES * TEST_CONTENTS), variance = 0.0;
    struct welford run[RUNS];
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    for (int i = 0; i < RUNS; i++) {
        run[i] = gather(scene, TEST_CONTENTS + i, REPLICATES).difference[FIGURE_FILM];
        variance += welford_variance(&run[i]) / RUNS;
    }
    double bias = stat_t_seen(level, REPLICATES - 1, NINE_TENTHS) *
                  sqrt(variance / REPLICATES);
    long alarms = 0, seen = 0;
    for (int i = 0; i < RUNS; i++) {
        alarms += difference_p(&run[i], 0.0) < OFTEN;
        seen += difference_p(&run[i], bias) < level;
    }
    printf("of %d runs %ld are below p = %g; %ld see the bias that %g of them should\n",
           RUNS, alarms, OFTEN, seen, NINE_TENTHS);
    assert_true(stat_ok("alarms", stat_binomial_p(alarms, RUNS, OFTEN), FALSE_ALARM));
    assert_true(stat_ok("seen", stat_binomial_p(seen, RUNS, NINE_TENTHS), FALSE_ALARM));
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_samples),
                                       cmocka_unit_test(test_means),
                                       cmocka_unit_test(test_rates)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

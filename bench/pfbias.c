/* What redrawn failures cost: the three modes of pfmlt on densities with zeros of which
 * everything is known (tests/support/pf_toy.h).
 *
 *   pfbias FOLDER
 *
 * Prints and leaves in FOLDER: error against work on a toy of pixel x light whose pixels
 * see a part of the light, so that the probability Z of not failing varies; where counted
 * and exact overtake paper; the bias of each pixel; and how often the second proposal of
 * exact is accepted, by dimension. Exits with 1 if a figure is not a number. */

#include "table_file.h"

#include "math/accum.h"
#include "support/pf_toy.h"

#include <stdio.h>
#include <stdlib.h>

#define PIXELS      64
#define SIGMA       0.01
#define P_LARGE     0.3
#define RUNS        256
#define GROUPS      8  /* of runs, for standard errors of what is not a mean */
#define CHECKPOINTS 14 /* 1, 2, 4, ... mutations per pixel */

static const struct mode {
    const char *name;
    const struct step_type *step;
} modes[] = {
    {"counted", &step_mh},
    {"exact", &step_pf_exact},
    {"paper", &step_pf_paper},
};

enum { COUNTED, EXACT, PAPER, MODES };

/* From all of the light through a penumbra to a sliver of it, then a hard edge. */
static void make_edges(double edges[PIXELS])
{
    for (int j = 0; j < PIXELS; j++) {
        double x = (j + 0.5) / PIXELS;
        double ramp = fmin(1.0, fmax(0.0, (x - 0.2) / 0.4));
        edges[j] = x < 0.8 ? 0.97 * ramp : 0.0;
    }
}

/* The picture [PIXELS], of mean 1, and what paper's density f Z makes of it, of mean 1
 * too. */
static void make_pictures(const struct pf_toy *toy, double *truth, double *biased)
{
    enum { POINTS_X = 8, POINTS_U = 1000 };
    double sum = 0.0, sum_biased = 0.0;
    for (int j = 0; j < PIXELS; j++) {
        double from = toy->table[j];
        truth[j] = biased[j] = 0.0;
        for (int i = 0; i < POINTS_X * POINTS_U; i++) {
            double u = from + (1.0 - from) * (i / POINTS_X + 0.5) / POINTS_U;
            double x[] = {(j + (i % POINTS_X + 0.5) / POINTS_X) / PIXELS, u};
            double f = pf_density(toy, x) * (1.0 - from);
            truth[j] += f;
            biased[j] += f * pf_z(toy, x, P_LARGE);
        }
        sum += truth[j] / PIXELS;
        sum_biased += biased[j] / PIXELS;
    }
    for (int j = 0; j < PIXELS; j++) {
        truth[j] /= sum;
        biased[j] /= sum_biased;
    }
}

static int64_t first_proposals(const struct tally *t)
{
    return t->proposed[MOVE_SMALL] + t->proposed[MOVE_LARGE];
}

static int64_t paths(const struct tally *t)
{
    return first_proposals(t) + t->proposed[MOVE_SECOND_STAGE];
}

static double mean_square_error(const double *picture, const double *truth)
{
    double sum = 0.0;
    for (int j = 0; j < PIXELS; j++)
        sum += (picture[j] - truth[j]) * (picture[j] - truth[j]) / PIXELS;
    return sum;
}

/* Of one mode: mean square errors by checkpoint and run; the mean of all last pictures.
 */
struct course {
    double squares[CHECKPOINTS][RUNS];
    double last[PIXELS];
};

/* One chain from an exact sample of f: no error is of the start. */
static void run_one(const struct pf_toy *toy, const struct mode *mode, int run,
                    const double *truth, struct course *course)
{
    struct chain chain;
    struct film_sinks films;
    film_sinks_create(&films, PIXELS, ESTIMATOR_PLAIN, false);
    struct chain_params params = {P_LARGE, 1.0, ESTIMATOR_PLAIN};
    struct target target = {pf_eval, (void *)(uintptr_t)toy};
    double x[PF_MAX_DIMS], picture[PIXELS];
    pf_chain_init(&chain, toy, KERNEL_SECOND_STAGE);
    rng_init(&chain.rng, 1, RNG_TEST, (uint64_t)run);
    pf_sample(toy, &chain.rng, x);
    pf_start(&chain, toy, x);
    for (int c = 0; c < CHECKPOINTS; c++) {
        int64_t goal = (int64_t)PIXELS << c, left;
        while ((left = goal - paths(&chain.tally)) > 0)
            mode->step->advance(&chain, &params, &target, &films.sinks,
                                (long)(left + 1) / 2);
        chain_flush(&chain, &params, &films.sinks);
        double states = (double)(first_proposals(&chain.tally) - chain.tally.excluded);
        for (int j = 0; j < PIXELS; j++)
            picture[j] = film_value(films.chain, j).g * PIXELS / fmax(states, 1.0);
        course->squares[c][run] = mean_square_error(picture, truth);
    }
    for (int j = 0; j < PIXELS; j++)
        course->last[j] += picture[j] / RUNS;
    chain_deinit(&chain);
    film_sinks_destroy(&films);
}

/* RMSE over some of the runs. */
static double rmse(const struct course *course, int checkpoint, int from, int count)
{
    double sum = 0.0;
    for (int i = from; i < from + count; i++)
        sum += course->squares[checkpoint][i];
    return sqrt(sum / count);
}

/* log2 of the mutations per pixel from which `a` keeps the lower error, on straight lines
 * of the log-log plot; 0 if it always has it, NAN if it has not in the end. */
static double crossing(const struct course *a, const struct course *b, int from,
                       int count)
{
    double after = (double)NAN;
    for (int c = CHECKPOINTS - 1; c >= 0; c--) {
        double gap = log(rmse(a, c, from, count) / rmse(b, c, from, count));
        if (!(gap < 0.0))
            return c + gap / (gap - after);
        after = gap;
    }
    return 0.0;
}

static bool report_errors(const char *folder, const struct course *courses, double floor)
{
    bool finite = true;
    FILE *csv = table_file_open(
        folder, "errors.csv",
        "mutations_per_pixel,counted,counted_se,exact,exact_se,paper,"
        "paper_se,paper_bias");
    printf(
        "\nRMSE over the mean, pixel x light, sigma %g, p_l %g, %d runs; paper's bias is "
        "%.4f\n%10s %18s %18s %18s\n",
        SIGMA, P_LARGE, RUNS, floor, "mut./pixel", "counted", "exact", "paper (biased)");
    for (int c = 0; c < CHECKPOINTS; c++) {
        printf("%10d", 1 << c);
        fprintf(csv, "%d", 1 << c);
        for (int m = 0; m < MODES; m++) {
            struct welford squares = {0};
            for (int i = 0; i < RUNS; i++)
                welford_add(&squares, courses[m].squares[c][i]);
            double value = sqrt(squares.mean), se = 0.5 * welford_se(&squares) / value;
            finite &= isfinite(value) && isfinite(se);
            printf("  %.5f +- %.5f", value, se);
            fprintf(csv, ",%.9g,%.9g", value, se);
        }
        printf("\n");
        fprintf(csv, ",%.9g\n", floor);
    }
    fclose(csv);
    return finite;
}

static bool report_crossing(const char *folder, const struct course *courses)
{
    bool finite = true;
    FILE *csv = table_file_open(folder, "crossing.csv",
                                "mode,mutations_per_pixel,factor_se");
    for (int m = COUNTED; m <= EXACT; m++) {
        struct welford log2s = {0};
        for (int g = 0; g < GROUPS; g++)
            welford_add(&log2s, crossing(&courses[m], &courses[PAPER],
                                         g * (RUNS / GROUPS), RUNS / GROUPS));
        double all = crossing(&courses[m], &courses[PAPER], 0, RUNS);
        double factor = exp2(welford_se(&log2s));
        printf("%s has the lower error from %.0f mutations per pixel on (se: a factor of "
               "%.2f)\n",
               modes[m].name, exp2(all), factor);
        fprintf(csv, "%s,%.9g,%.9g\n", modes[m].name, exp2(all), factor);
        finite &= isfinite(all) && isfinite(factor);
    }
    fclose(csv);
    return finite;
}

static bool report_bias(const char *folder, const struct course *courses,
                        const double *truth, const double *biased)
{
    bool finite = true;
    double least = 1.0, most = 1.0;
    FILE *csv = table_file_open(folder, "bias.csv",
                                "pixel,truth,paper_exact,counted,exact,paper");
    for (int j = 0; j < PIXELS; j++) {
        double ratio = biased[j] / truth[j];
        least = fmin(least, ratio);
        most = fmax(most, ratio);
        fprintf(csv, "%d,%.9g,%.9g", j, truth[j], ratio);
        for (int m = 0; m < MODES; m++)
            fprintf(csv, ",%.9g", courses[m].last[j] / truth[j]);
        fprintf(csv, "\n");
        finite &= isfinite(ratio);
    }
    fclose(csv);
    printf("paper's pixels over the truth, by f Z: %.3f to %.3f\n", least, most);
    return finite;
}

static bool bias(const char *folder)
{
    static struct course courses[MODES];
    double edges[PIXELS], truth[PIXELS], biased[PIXELS];
    make_edges(edges);
    struct pf_toy toy = pf_penumbra(SIGMA, edges, PIXELS);
    make_pictures(&toy, truth, biased);
    for (int m = 0; m < MODES; m++) {
        for (int i = 0; i < RUNS; i++)
            run_one(&toy, &modes[m], i, truth, &courses[m]);
    }
    double floor = sqrt(mean_square_error(biased, truth));
    bool finite = report_errors(folder, courses, floor);
    finite &= report_crossing(folder, courses);
    finite &= report_bias(folder, courses, truth, biased);
    return finite;
}

/* --- second proposals, by dimension ---------------------------------------------------
 */

/* Mean acceptance of second proposals `narrower` times narrower than first ones, over
 * chains of small steps. */
static struct welford second_acceptance(int dims, int narrower, double *failed)
{
    enum { CHAINS = 16, STEPS = 20000 };
    struct pf_toy toy = pf_box(SIGMA, dims);
    struct film_sinks films;
    film_sinks_create(&films, 1, ESTIMATOR_PLAIN, false);
    struct chain_params params = {0.0, 1.0, ESTIMATOR_PLAIN};
    struct target target = {pf_eval, &toy};
    struct welford mean = {0};
    *failed = 0.0;
    for (int i = 0; i < CHAINS; i++) {
        struct chain chain;
        double x[PF_MAX_DIMS];
        pf_chain_init(&chain, &toy, narrower);
        rng_init(&chain.rng, 2, RNG_TEST, (uint64_t)i);
        pf_sample(&toy, &chain.rng, x);
        pf_start(&chain, &toy, x);
        step_pf_exact.advance(&chain, &params, &target, &films.sinks, STEPS);
        double seconds = (double)chain.tally.proposed[MOVE_SECOND_STAGE];
        welford_add(&mean, chain.tally.acceptance[MOVE_SECOND_STAGE] / seconds);
        *failed += seconds / STEPS / CHAINS;
        chain_deinit(&chain);
    }
    film_sinks_destroy(&films);
    return mean;
}

static bool acceptance(const char *folder)
{
    const int dims[] = {8, 20, 40}, narrower[] = {KERNEL_SECOND_STAGE, 1};
    bool finite = true;
    FILE *csv = table_file_open(
        folder, "acceptance.csv",
        "dimensions,failed,timid,timid_se,same_width,same_width_se");
    printf("\nAcceptance of exact's second proposal, a box of D numbers, sigma %g\n"
           "%4s %8s %20s %20s\n",
           SIGMA, "D", "failed", "a tenth as wide", "as wide");
    for (int d = 0; d < 3; d++) {
        double failed;
        struct welford a[2];
        for (int i = 0; i < 2; i++) {
            a[i] = second_acceptance(dims[d], narrower[i], &failed);
            finite &= isfinite(a[i].mean);
        }
        printf("%4d %8.3f %10.4f +- %.4f %10.4f +- %.4f\n", dims[d], failed, a[0].mean,
               welford_se(&a[0]), a[1].mean, welford_se(&a[1]));
        fprintf(csv, "%d,%.9g,%.9g,%.9g,%.9g,%.9g\n", dims[d], failed, a[0].mean,
                welford_se(&a[0]), a[1].mean, welford_se(&a[1]));
    }
    fclose(csv);
    return finite;
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        fprintf(stderr, "usage: pfbias FOLDER\n");
        return 2;
    }
    bool finite = bias(argv[1]);
    finite &= acceptance(argv[1]);
    if (!finite)
        fprintf(stderr, "pfbias: a figure is not a number\n");
    return finite ? 0 : 1;
}

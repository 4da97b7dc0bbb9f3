/* R-hat and effective sample size against their definitions [Vehtari21], written down a
 * second time without care for speed; cases that have no answer; how often independent
 * draws raise an alarm, and chains that do not mix. */
#include "math/rhat.h"
#include "math/rng.h"
#include "support/stat_test.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include <stdlib.h>

#define FALSE_ALARM 1e-4
#define MOST        256

/* --- the definitions -------------------------------------------------------------- */

/* x[rows][n] to normal scores: the quantile is GSL's, the ranks are counted. */
static void scores(const double *x, int count, double *out)
{
    for (int i = 0; i < count; i++) {
        double rank = 0.5;
        for (int j = 0; j < count; j++)
            rank += x[j] < x[i] ? 1.0 : x[j] == x[i] ? 0.5 : 0.0;
        out[i] = gsl_cdf_ugaussian_Pinv((rank - 0.375) / (count + 0.25));
    }
}

static double mean_of(const double *x, int n)
{
    double sum = 0.0;
    for (int i = 0; i < n; i++)
        sum += x[i];
    return sum / n;
}

static double variance_of(const double *x, int n)
{
    double mean = mean_of(x, n), sum = 0.0;
    for (int i = 0; i < n; i++)
        sum += (x[i] - mean) * (x[i] - mean);
    return sum / (n - 1);
}

static void parts(const double *z, int rows, int n, double *within, double *all)
{
    double means[MOST], variances[MOST];
    for (int i = 0; i < rows; i++) {
        means[i] = mean_of(z + i * n, n);
        variances[i] = variance_of(z + i * n, n);
    }
    *within = mean_of(variances, rows);
    *all = (n - 1.0) / n * *within + variance_of(means, rows);
}

static double slow_rhat(const double *x, int chains, int draws)
{
    double z[MOST], folded[MOST], order[MOST], within, all, bulk;
    int rows = 2 * chains, n = draws / 2, count = rows * n;
    for (int i = 0; i < count; i++)
        order[i] = x[i];
    for (int i = 0; i < count; i++) /* a sort */
        for (int j = i + 1; j < count; j++)
            if (order[j] < order[i]) {
                double swap = order[i];
                order[i] = order[j];
                order[j] = swap;
            }
    double median = count % 2 ? order[count / 2]
                              : 0.5 * (order[count / 2 - 1] + order[count / 2]);
    scores(x, count, z);
    parts(z, rows, n, &within, &all);
    bulk = sqrt(all / within);
    for (int i = 0; i < count; i++)
        folded[i] = fabs(x[i] - median);
    scores(folded, count, z);
    parts(z, rows, n, &within, &all);
    return fmax(bulk, sqrt(all / within));
}

static double slow_effective(const double *x, int chains, int draws)
{
    double z[MOST], rho[MOST] = {0.0}, within, all, time = -1.0, last = HUGE_VAL;
    int rows = 2 * chains, n = draws / 2, count = rows * n;
    scores(x, count, z);
    parts(z, rows, n, &within, &all);
    for (int lag = 0; lag < n; lag++) {
        double mean = 0.0;
        for (int i = 0; i < rows; i++) { /* s_i^2 rho_i */
            double m = mean_of(z + i * n, n), c = 0.0, c0 = 0.0;
            for (int j = 0; j < n; j++) {
                c += j + lag < n ? (z[i * n + j] - m) * (z[i * n + j + lag] - m) : 0.0;
                c0 += (z[i * n + j] - m) * (z[i * n + j] - m);
            }
            mean += c0 > 0.0 ? variance_of(z + i * n, n) * c / c0 / rows : 0.0;
        }
        rho[lag] = lag == 0 ? 1.0 : 1.0 - (within - mean) / all;
    }
    for (int lag = 0; lag + 1 < n && rho[lag] + rho[lag + 1] >= 0.0; lag += 2) {
        last = fmin(last, rho[lag] + rho[lag + 1]);
        time += 2.0 * last;
    }
    return fmax(1.0, count / fmax(time, 1.0 / log10(count)));
}

/* Chains of an autoregressive process, coarse enough to have ties. */
static void make(struct rng *rng, int chains, int draws, double a, double *x)
{
    for (int i = 0; i < chains; i++) {
        double value = rng_double(rng) - 0.5;
        for (int j = 0; j < draws; j++) {
            value = a * value + rng_double(rng) - 0.5;
            x[i * draws + j] = floor(16.0 * value);
        }
    }
}

static void as_defined(void **state)
{
    (void)state;
    struct rng rng;
    double x[MOST];
    rng_init(&rng, 1, RNG_TEST, 0);
    for (int i = 0; i < 300; i++) {
        int chains = 2 + i % 6, draws = 6 + 2 * (i % 14);
        make(&rng, chains, draws, i % 3 * 0.45, x);
        double r = slow_rhat(x, chains, draws), e = slow_effective(x, chains, draws);
        assert_true(fabs(rhat(x, chains, draws) / r - 1.0) < 1e-12);
        assert_true(fabs(rhat_effective(x, chains, draws) / e - 1.0) < 1e-10);
    }
}

/* A monotone change of the values is none of the ranks; the first of an odd number of
 * draws does not count. */
static void invariant(void **state)
{
    (void)state;
    struct rng rng;
    double x[40], y[44];
    rng_init(&rng, 2, RNG_TEST, 0);
    make(&rng, 4, 10, 0.5, x);
    for (int i = 0; i < 44; i++)
        y[i] = i % 11 == 0 ? 1e9 : x[i / 11 * 10 + i % 11 - 1];
    assert_true(rhat(x, 4, 10) == rhat(y, 4, 11));
    assert_true(rhat_effective(x, 4, 10) == rhat_effective(y, 4, 11));
    for (int i = 0; i < 40; i++)
        y[i] = exp(x[i]);
    assert_true(rhat_effective(x, 4, 10) == rhat_effective(y, 4, 10));
}

static void without_an_answer(void **state)
{
    (void)state;
    double x[16] = {0.0};
    assert_true(isnan(rhat(x, 2, 8)) && isnan(rhat_effective(x, 2, 8)));
    x[3] = 1.0;
    assert_true(isnan(rhat(x, 2, 3)) && isnan(rhat(x, 1, 8)));
    assert_true(rhat(x, 2, 8) > 0.0);
    x[5] = (double)NAN;
    assert_true(isnan(rhat(x, 2, 8)));
    for (int i = 0; i < 16; i++)
        x[i] = i / 8; /* two chains, each in a place of its own */
    assert_true(isinf(rhat(x, 2, 8)) && rhat_tail(rhat(x, 2, 8), 2, 8) == 0.0);
    assert_true(rhat_tail((double)NAN, 2, 8) == 1.0);
}

/* --- alarms ----------------------------------------------------------------------- */

/* Independent draws of a law without a mean: alarms at 1 % must not be more. (Of two
 * statistics the larger counts twice, so they are a little fewer.) And chains that have
 * not mixed: each stays long where it is. */
static void alarms(void **state)
{
    (void)state;
    static const int shapes[][2] = {{4, 8}, {8, 8}, {8, 16}};
    const int runs = 4000;
    struct rng rng;
    rng_init(&rng, 3, RNG_TEST, 0);
    for (int shape = 0; shape < 3; shape++) {
        int chains = shapes[shape][0], draws = shapes[shape][1], alarm = 0, found = 0;
        double x[MOST];
        for (int run = 0; run < runs; run++) {
            for (int i = 0; i < chains * draws; i++)
                x[i] = 1.0 / (1.0 - rng_double(&rng)) / (1.0 - rng_double(&rng));
            alarm += rhat_tail(rhat(x, chains, draws), chains, draws) < 0.01;
            if (run % 20 == 0) {
                make(&rng, chains, draws, 0.95, x);
                found += rhat_tail(rhat(x, chains, draws), chains, draws) < 0.01;
            }
        }
        double level = stat_sidak(FALSE_ALARM, 6);
        double few = gsl_cdf_binomial_P((unsigned)alarm, 0.006, (unsigned)runs);
        double many =
            alarm ? gsl_cdf_binomial_Q((unsigned)alarm - 1, 0.0115, (unsigned)runs) : 1.0;
        assert_true(stat_ok("alarms of independent draws, too few", few, level));
        assert_true(stat_ok("alarms of independent draws, too many", many, level));
        assert_true(found > (chains == 4 ? 50 : 100)); /* of 200 */
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(as_defined),
        cmocka_unit_test(invariant),
        cmocka_unit_test(without_an_answer),
        cmocka_unit_test(alarms),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

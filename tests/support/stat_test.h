#ifndef ETALON_TESTS_SUPPORT_STAT_TEST_H
#define ETALON_TESTS_SUPPORT_STAT_TEST_H

/* Statistical tests: p-values, and a verdict against a stated false-alarm rate. A test
 * file states one rate for all it does, divides it with stat_sidak, and asserts stat_ok.
 */

#include <gsl/gsl_cdf.h>

#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#define STAT_MIN_EXPECTED 5.0

/* Level of each of `tests` independent tests whose family errs with rate `alpha`. */
static inline double stat_sidak(double alpha, int tests)
{
    return -expm1(log1p(-alpha) / tests);
}

/* How many standard deviations of a normal law a two-sided p stands for; 38 at most,
 * where doubles end. */
static inline double stat_sigmas(double p)
{
    return p >= 0.0 ? gsl_cdf_ugaussian_Qinv(fmax(0.5 * p, 1e-315)) : (double)NAN;
}

/* False, with one line on stderr, if p lies below the level (or is NaN). */
static inline bool stat_ok(const char *what, double p, double level)
{
    if (p >= level)
        return true;
    fprintf(stderr, "%s: p = %.3g below %.3g (%.1f sigmas)\n", what, p, level,
            stat_sigmas(p));
    return false;
}

/* Two-sided, of a standard normal. */
static inline double stat_z_p(double z)
{
    return erfc(fabs(z) / sqrt(2.0));
}

/* Two-sided, of Student's t. */
static inline double stat_t_p(double t, double freedom)
{
    return 2.0 * gsl_cdf_tdist_Q(fabs(t), freedom);
}

/* How many standard errors a bias must have so that a two-sided t-test at `level` fails
 * with probability `power`: the quantile of the noncentral t distribution, by its normal
 * approximation [AbramowitzStegun64, 26.7.10]. */
static inline double stat_t_seen(double level, double freedom, double power)
{
    double t = gsl_cdf_tdist_Qinv(0.5 * level, freedom);
    return t * (1.0 - 0.25 / freedom) +
           gsl_cdf_ugaussian_Pinv(power) * sqrt(1.0 + 0.5 * t * t / freedom);
}

/* Two-sided, of k successes in n trials of probability q. */
static inline double stat_binomial_p(long k, long n, double q)
{
    double low = gsl_cdf_binomial_P((unsigned)k, q, (unsigned)n);
    double high = k > 0 ? gsl_cdf_binomial_Q((unsigned)(k - 1), q, (unsigned)n) : 1.0;
    return fmin(1.0, 2.0 * fmin(low, high));
}

/* Two-sided t-test of replicates x[n] against their exact mean. */
static inline double stat_mean_p(const double *x, int n, double exact)
{
    double mean = 0.0, squares = 0.0;
    for (int i = 0; i < n; i++)
        mean += x[i] / n;
    for (int i = 0; i < n; i++)
        squares += (x[i] - mean) * (x[i] - mean);
    double se = sqrt(squares / (n - 1) / n);
    if (!(se > 0.0))
        return mean == exact ? 1.0 : 0.0;
    return stat_t_p((mean - exact) / se, n - 1);
}

/* Chi-squared of counts against expected counts of the same sum. Neighbours are pooled
 * until 5 are expected; the last pool takes the rest. A count where none is expected
 * at all gives 0. */
static inline double stat_chi2_p(const double *observed, const double *expected,
                                 int cells)
{
    double chi2 = 0.0, o = 0.0, e = 0.0, rest = 0.0;
    int pools = 0;
    for (int i = 0; i < cells; i++)
        rest += expected[i];
    for (int i = 0; i < cells; i++) {
        if (expected[i] == 0.0 && observed[i] > 0.0)
            return 0.0;
        o += observed[i];
        e += expected[i];
        rest -= expected[i];
        bool last = i == cells - 1;
        if (last || (e >= STAT_MIN_EXPECTED && rest >= STAT_MIN_EXPECTED)) {
            if (e > 0.0)
                chi2 += (o - e) * (o - e) / e;
            pools++;
            o = e = 0.0;
        }
    }
    return pools > 1 ? gsl_cdf_chisq_Q(chi2, pools - 1) : 1.0;
}

/* Chi-squared of two samples' counts: the same law? Cells with fewer than 10 counts in
 * both together are pooled with their neighbours. */
static inline double stat_chi2_two_p(const double *a, const double *b, int cells)
{
    double total_a = 0.0, total_b = 0.0, rest = 0.0, chi2 = 0.0, x = 0.0, y = 0.0;
    int pools = 0;
    for (int i = 0; i < cells; i++) {
        total_a += a[i];
        total_b += b[i];
    }
    rest = total_a + total_b;
    for (int i = 0; i < cells; i++) {
        x += a[i];
        y += b[i];
        rest -= a[i] + b[i];
        bool last = i == cells - 1;
        if (last ||
            (x + y >= 2.0 * STAT_MIN_EXPECTED && rest >= 2.0 * STAT_MIN_EXPECTED)) {
            double d = x * sqrt(total_b / total_a) - y * sqrt(total_a / total_b);
            if (x + y > 0.0)
                chi2 += d * d / (x + y);
            pools++;
            x = y = 0.0;
        }
    }
    return pools > 1 ? gsl_cdf_chisq_Q(chi2, pools - 1) : 1.0;
}

/* Kolmogorov-Smirnov of sorted values u[n] against the uniform law on [0,1]; the
 * asymptotic law with the correction of [Stephens70]. */
static inline double stat_uniform_p(const double *u, int n)
{
    double d = 0.0;
    for (int i = 0; i < n; i++)
        d = fmax(d, fmax(u[i] - (double)i / n, (i + 1.0) / n - u[i]));
    double x = (sqrt((double)n) + 0.12 + 0.11 / sqrt((double)n)) * d, p = 0.0;
    for (int j = 1; j <= 100; j++)
        p += (j % 2 ? 2.0 : -2.0) * exp(-2.0 * j * j * x * x);
    return x < 0.2 ? 1.0 : fmin(1.0, fmax(0.0, p));
}

#endif

#include "analysis/interval.h"

#include "base/mem.h"
#include "math/accum.h"
#include "math/order.h"
#include "math/student.h"

#include <math.h>

struct interval interval_nothing(void)
{
    const double nan = (double)NAN;
    return (struct interval){nan, nan, nan};
}

bool interval_is_known(const struct interval *interval)
{
    return isfinite(interval->value) && isfinite(interval->lo) && isfinite(interval->hi);
}

struct interval interval_mean(const double *x, size_t n)
{
    struct interval interval = interval_nothing();
    struct welford w = {0};
    for (size_t i = 0; i < n; i++)
        welford_add(&w, x[i]);
    if (n == 0 || !isfinite(w.mean))
        return interval;
    interval.value = w.mean;
    if (n < 2)
        return interval;
    double half = student_quantile(0.5 + 0.5 * INTERVAL_LEVEL, (double)n - 1.0) *
                  welford_se(&w);
    interval.lo = w.mean - half;
    interval.hi = w.mean + half;
    return interval;
}

struct interval interval_log_mean(const double *x, size_t n)
{
    double *logs = mem_alloc(n, sizeof *logs);
    for (size_t i = 0; i < n; i++)
        logs[i] = x[i] > 0.0 ? log(x[i]) : (double)NAN;
    struct interval of_logs = interval_mean(logs, n);
    mem_free(logs);
    return (struct interval){exp(of_logs.value), exp(of_logs.lo), exp(of_logs.hi)};
}

static void add_logs(struct welford *w, const double *x, size_t n)
{
    for (size_t i = 0; i < n; i++)
        welford_add(w, x[i] > 0.0 ? log(x[i]) : (double)NAN);
}

struct interval interval_log_ratio(const double *a, size_t n, const double *b, size_t m)
{
    struct interval interval = interval_nothing();
    struct welford wa = {0}, wb = {0};
    add_logs(&wa, a, n);
    add_logs(&wb, b, m);
    double difference = wa.mean - wb.mean;
    if (n == 0 || m == 0 || !isfinite(difference))
        return interval;
    interval.value = exp(difference);
    if (n < 2 || m < 2)
        return interval;
    double va = welford_se(&wa) * welford_se(&wa), vb = welford_se(&wb) * welford_se(&wb);
    double sum = va + vb;
    double freedom = sum > 0.0
                         ? sum * sum /
                               (va * va / ((double)n - 1.0) + vb * vb / ((double)m - 1.0))
                         : 1.0;
    double half = student_quantile(0.5 + 0.5 * INTERVAL_LEVEL, freedom) * sqrt(sum);
    interval.lo = exp(difference - half);
    interval.hi = exp(difference + half);
    return interval;
}

/* Percentile of sorted values by linear interpolation. */
static double percentile(const double *sorted, size_t count, double share)
{
    double place = share * (double)(count - 1);
    size_t below = (size_t)place;
    if (below + 1 >= count)
        return sorted[count - 1];
    double rest = place - (double)below;
    return sorted[below] * (1.0 - rest) + sorted[below + 1] * rest;
}

struct interval interval_percentile(double value, double *replicates, size_t count,
                                    size_t n)
{
    struct interval interval = interval_nothing();
    interval.value = value;
    if (n < 2 || count == 0 || !isfinite(value))
        return interval;
    for (size_t i = 0; i < count; i++)
        if (isnan(replicates[i]))
            return interval;
    double quantile = student_quantile(0.5 + 0.5 * INTERVAL_LEVEL, (double)n - 1.0);
    double cut = student_tail(quantile * sqrt((double)n / ((double)n - 1.0)),
                              (double)INFINITY);
    sort_ascending(replicates, count);
    interval.lo = percentile(replicates, count, cut);
    interval.hi = percentile(replicates, count, 1.0 - cut);
    return interval;
}

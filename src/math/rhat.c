#include "math/rhat.h"

#include "base/mem.h"
#include "math/law.h"
#include "math/order.h"

#include <assert.h>
#include <math.h>
#include <stdbool.h>

/* Halves of all sequences: values[rows][length]. */
struct halves {
    int rows, length;
    double *values;
};

static void halves_init(struct halves *h, const double *x, int chains, int draws)
{
    int skip = draws % 2, used = draws - skip;
    *h = (struct halves){2 * chains, used / 2, NULL};
    assert(chains * draws <= RHAT_MOST);
    h->values = mem_alloc((size_t)chains * (size_t)used, sizeof *h->values);
    for (int i = 0; i < chains; i++)
        for (int j = 0; j < used; j++)
            h->values[i * used + j] = x[i * draws + skip + j];
}

static double *sorted(const struct halves *h)
{
    int count = h->rows * h->length;
    double *order = mem_alloc((size_t)count, sizeof *order);
    for (int i = 0; i < count; i++)
        order[i] = h->values[i];
    sort_ascending(order, (size_t)count);
    return order;
}

/* How many of order[count] are less than x; or, with `equal`, not greater. */
static int count_below(const double *order, int count, double x, bool equal)
{
    int low = 0, high = count;
    while (low < high) {
        int middle = (low + high) / 2;
        if (order[middle] < x || (equal && order[middle] == x))
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Values become the normal scores of their ranks, ties of their mean rank [Vehtari21 Eq.
 * 14]. */
static void normalise_ranks(struct halves *h)
{
    int count = h->rows * h->length;
    double *order = sorted(h);
    double *scores = mem_alloc(2 * (size_t)count + 1, sizeof *scores);
    bool *known = mem_alloc(2 * (size_t)count + 1, sizeof *known);
    for (int i = 0; i < count; i++) {
        int below = count_below(order, count, h->values[i], false);
        int twice = below + count_below(order, count, h->values[i], true) + 1;
        if (!known[twice])
            scores[twice] = law_normal_quantile((0.5 * twice - 0.375) / (count + 0.25));
        known[twice] = true;
        h->values[i] = scores[twice];
    }
    mem_free(known);
    mem_free(scores);
    mem_free(order);
}

/* Values become distances from their median. */
static void fold(struct halves *h)
{
    int count = h->rows * h->length;
    double *order = sorted(h);
    double median = median_of_sorted(order, (size_t)count);
    for (int i = 0; i < count; i++)
        /* Folded draws [Vehtari21, section 3]. */
        h->values[i] = fabs(h->values[i] - median);
    mem_free(order);
}

/* Mean variance within rows, and length times the variance of their means. */
static void variances(const struct halves *h, double *within, double *between)
{
    double grand = 0.0, spread = 0.0;
    *within = 0.0;
    for (int i = 0; i < h->rows; i++) {
        const double *row = h->values + (size_t)i * (size_t)h->length;
        double mean = 0.0, squares = 0.0;
        for (int j = 0; j < h->length; j++)
            mean += row[j] / h->length;
        for (int j = 0; j < h->length; j++)
            squares += (row[j] - mean) * (row[j] - mean);
        /* W [Vehtari21 Eq. 2]. */
        *within += squares / (h->length - 1) / h->rows;
        double d = mean - grand;
        grand += d / (i + 1);
        spread += d * (mean - grand);
    }
    /* B [Vehtari21 Eq. 1]. */
    *between = h->length * spread / (h->rows - 1);
}

/* [Vehtari21 Eqs. 1 to 4]. */
static double plain_rhat(const struct halves *h)
{
    double within, between, n = h->length;
    variances(h, &within, &between);
    if (!(within > 0.0))
        return between > 0.0 ? (double)INFINITY : (double)NAN;
    /* [Vehtari21 Eqs. 3 and 4] */
    return sqrt(((n - 1.0) / n * within + between / n) / within);
}

static bool can_tell(const double *x, int chains, int draws)
{
    bool differ = false;
    if (chains < 2 || draws < RHAT_DRAWS_LEAST)
        return false;
    for (int i = 0; i < chains * draws; i++) {
        if (!isfinite(x[i]))
            return false;
        differ = differ || x[i] != x[0];
    }
    return differ;
}

double rhat(const double *x, int chains, int draws)
{
    struct halves h;
    if (!can_tell(x, chains, draws))
        return (double)NAN;
    halves_init(&h, x, chains, draws);
    normalise_ranks(&h);
    double bulk = plain_rhat(&h);
    mem_free(h.values);
    halves_init(&h, x, chains, draws);
    fold(&h);
    normalise_ranks(&h);
    double folded = plain_rhat(&h);
    mem_free(h.values);
    /* Larger of rank-normalised and folded split R-hat [Vehtari21, section 3]. */
    return fmax(bulk, folded);
}

/* Mean over rows of the autocovariance at this lag, divided by the length. */
static double autocovariance(const struct halves *h, int lag)
{
    double sum = 0.0;
    for (int i = 0; i < h->rows; i++) {
        const double *row = h->values + (size_t)i * (size_t)h->length;
        double mean = 0.0;
        for (int j = 0; j < h->length; j++)
            mean += row[j] / h->length;
        for (int j = 0; j + lag < h->length; j++)
            sum += (row[j] - mean) * (row[j + lag] - mean);
    }
    return sum / h->rows / h->length;
}

/* [Vehtari21 Eqs. 10 to 13]: correlations of neighbouring lags in pairs, as long as their
 * sum is positive, and never growing. */
static double correlation_time(const struct halves *h)
{
    double within, between, n = h->length;
    variances(h, &within, &between);
    double all = (n - 1.0) / n * within + between / n, sum = 0.0, last = HUGE_VAL;
    for (int lag = 0; lag + 1 < h->length; lag += 2) {
        double pair = 0.0;
        for (int i = lag; i <= lag + 1; i++)
            pair += i == 0 ? 1.0
                           : 1.0 - (within - autocovariance(h, i) * n / (n - 1.0)) / all;
        if (pair < 0.0)
            break;
        last = fmin(last, pair);
        sum += last;
    }
    return 2.0 * sum - 1.0;
}

double rhat_effective(const double *x, int chains, int draws)
{
    struct halves h;
    if (!can_tell(x, chains, draws))
        return (double)NAN;
    halves_init(&h, x, chains, draws);
    normalise_ranks(&h);
    double count = h.rows * h.length;
    double time = fmax(correlation_time(&h), 1.0 / log10(count));
    mem_free(h.values);
    return fmax(count / time, 1.0);
}

/* For independent draws between / within has an F distribution. */
double rhat_tail(double value, int chains, int draws)
{
    int rows = 2 * chains, length = draws / 2;
    if (isnan(value))
        return 1.0;
    double ratio = length * value * value - (length - 1.0);
    return fmin(2.0 * law_f_upper(ratio, rows - 1, rows * (length - 1.0)), 1.0);
}

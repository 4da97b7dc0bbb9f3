/* Whether the figures of a long run, or the memory it takes, change while it runs.
 *
 *   drift statistics ERRORS.csv WARM_UP BLOCKS OUT.csv
 *   drift memory SAMPLES.csv ERRORS.csv WARM_UP BLOCKS
 *
 * ERRORS.csv is of `etalon render --errors --errors-every`, SAMPLES.csv of heap_watch.
 * WARM_UP: seconds after the first row that do not count. (Before it lie loading,
 * bootstrap and measured start; with it the first picture's memory comes and goes.)
 *
 * statistics: what comes after is cut into BLOCKS with the same number of mutations, but
 * for a row. A column x is a mean over all n mutations so far, so that of a block is
 * (n2 x2 - n1 x1) / (n2 - n1). Blocks are as good as independent: chains forget. A trend
 * over them is tested by Kendall's tau, whose law without one is exact whatever the law
 * of the values; the family of a run's tests errs with the rate FALSE_ALARM. Beside it:
 * means, standard error of them, first and last third, the slope of a straight line with
 * its standard error, correlation of neighbours. The blocks go to OUT.csv.
 *
 * memory: samples count from the first row after WARM_UP to the last one, by the
 * program's CPU time; the verdict and the writing of pictures come later. Live bytes,
 * live blocks and mapped bytes (of the process alone) have grown if the least of the last
 * block of samples is above the least of the first: to the byte, as between two pictures
 * nothing is allocated. Resident bytes may, up to those mapped: a page of a film is there
 * once the first splat falls on it. */

#include "lab/csv.h"
#include "math/accum.h"
#include "support/stat_test.h"

#include <stdlib.h>
#include <string.h>

#define FALSE_ALARM 1e-2
#define BLOCKS_MOST 100

static _Noreturn void die(const char *message)
{
    fprintf(stderr, "drift: %s\n", message);
    exit(2);
}

static struct csv *read_table(const char *path)
{
    struct err err = {0};
    char text[1200];
    struct csv *csv = csv_read(path, &err);
    if (csv)
        return csv;
    err_format(&err, text, sizeof text);
    die(text);
}

static double cell(const struct csv *csv, size_t row, const char *column)
{
    int at = csv_column(csv, column);
    if (at < 0)
        die(column);
    return csv_number(csv, row, at);
}

/* The row with which what counts begins. */
static size_t first_row(const struct csv *log, double warm_up)
{
    size_t row = 1;
    while (row < log->rows && cell(log, row, "wall_s") - cell(log, 1, "wall_s") < warm_up)
        row++;
    if (row + 1 >= log->rows)
        die("no rows after the warm-up");
    return row;
}

/* --- trends ----------------------------------------------------------------------- */

struct trend {
    double mean, se;        /* of blocks */
    double first, last;     /* means of the first and last third */
    double slope, slope_se; /* in a unit of t, by least squares */
    double neighbours;      /* correlation of neighbouring residuals */
    double p;               /* Kendall's, two-sided */
};

/* P(at most `limit` of the pairs of a random order of n are inverted). */
static double inversions_at_most(int n, int limit)
{
    enum { MOST = BLOCKS_MOST * (BLOCKS_MOST - 1) / 2 + 1 };
    static double law[MOST], next[MOST]; /* share of orders by inversions */
    double sum = 0.0;
    memset(law, 0, sizeof law);
    law[0] = 1.0;
    for (int k = 2; k <= n; k++) { /* the k-th passes 0..k-1 of those before it */
        double window = 0.0;
        for (int i = 0; i <= k * (k - 1) / 2; i++) {
            window += law[i] - (i >= k ? law[i - k] : 0.0);
            next[i] = window / k;
        }
        memcpy(law, next, sizeof law);
    }
    for (int i = 0; i <= limit; i++)
        sum += law[i];
    return fmin(sum, 1.0);
}

static double kendall_p(const double *x, int n)
{
    int up = 0, down = 0, pairs = n * (n - 1) / 2;
    for (int i = 0; i < n; i++)
        for (int j = i + 1; j < n; j++) {
            up += x[j] > x[i];
            down += x[j] < x[i];
        }
    int least = up < down ? up : down;
    least += (pairs - up - down) / 2; /* pairs that are equal go half to either side */
    return fmin(1.0, 2.0 * inversions_at_most(n, least));
}

static void fit_line(const double *t, const double *x, int n, struct trend *out)
{
    double mt = 0.0, tt = 0.0, tx = 0.0, squares = 0.0, products = 0.0, before = 0.0;
    for (int i = 0; i < n; i++)
        mt += t[i] / n;
    for (int i = 0; i < n; i++) {
        tt += (t[i] - mt) * (t[i] - mt);
        tx += (t[i] - mt) * (x[i] - out->mean);
    }
    out->slope = tx / tt;
    for (int i = 0; i < n; i++) {
        double residual = x[i] - out->mean - out->slope * (t[i] - mt);
        squares += residual * residual;
        products += i > 0 ? residual * before : 0.0;
        before = residual;
    }
    out->slope_se = sqrt(squares / (n - 2) / tt);
    out->neighbours = squares > 0.0 ? products / squares : 0.0;
}

static double mean_of(const double *x, int first, int end)
{
    double sum = 0.0;
    for (int i = first; i < end; i++)
        sum += x[i];
    return sum / (end - first);
}

static struct trend trend_of(const double *t, const double *x, int n)
{
    struct welford w = {0};
    for (int i = 0; i < n; i++)
        welford_add(&w, x[i]);
    struct trend trend = {.mean = w.mean,
                          .se = welford_se(&w),
                          .first = mean_of(x, 0, n / 3),
                          .last = mean_of(x, n - n / 3, n),
                          .p = kendall_p(x, n)};
    fit_line(t, x, n, &trend);
    return trend;
}

/* --- statistics ------------------------------------------------------------------- */

static const char *const figures[] = {"b",           "mean_ratio", "eta_s_run",
                                      "eta_l_run",   "eta_0_run",  "acceptance",
                                      "failure_rate"};

#define FIGURES ((int)(sizeof figures / sizeof *figures))

enum { SPEED = FIGURES, SERIES }; /* mutations per CPU second */

static const char *series_name(int series)
{
    return series < FIGURES ? figures[series] : "mutations_per_cpu_s";
}

struct blocks {
    int count;
    double t[BLOCKS_MOST]; /* h, the middle */
    double x[SERIES][BLOCKS_MOST];
};

static void take_block(struct blocks *blocks, const struct csv *log, size_t from,
                       size_t to)
{
    int i = blocks->count++;
    double n1 = cell(log, from, "paths"), n2 = cell(log, to, "paths");
    double cpu1 = cell(log, from, "cpu_s"), cpu2 = cell(log, to, "cpu_s");
    blocks->t[i] = (cell(log, from, "wall_s") + cell(log, to, "wall_s")) / 7200.0;
    for (int f = 0; f < FIGURES; f++)
        blocks->x[f][i] = (n2 * cell(log, to, figures[f]) -
                           n1 * cell(log, from, figures[f])) /
                          (n2 - n1);
    blocks->x[SPEED][i] = (n2 - n1) / (cpu2 - cpu1);
}

static void take_blocks(struct blocks *blocks, const struct csv *log, double warm_up,
                        int count)
{
    size_t from = first_row(log, warm_up), last = log->rows - 1;
    double begin = cell(log, from, "paths"), end = cell(log, last, "paths");
    for (int i = 1; i <= count; i++) {
        size_t to = from;
        while (to < last && cell(log, to, "paths") < begin + (end - begin) * i / count)
            to++;
        if (to == from)
            die("fewer rows than blocks");
        take_block(blocks, log, from, to);
        from = to;
    }
}

static void write_blocks(const struct blocks *blocks, const char *path)
{
    FILE *out = fopen(path, "w");
    if (out == NULL)
        die(path);
    fprintf(out, "hours");
    for (int s = 0; s < SERIES; s++)
        fprintf(out, ",%s", series_name(s));
    for (int i = 0; i < blocks->count; i++) {
        fprintf(out, "\n%.9g", blocks->t[i]);
        for (int s = 0; s < SERIES; s++)
            fprintf(out, ",%.12g", blocks->x[s][i]);
    }
    fprintf(out, "\n");
    fclose(out);
}

/* Speed is shown, not judged: it is the machine's as well. */
static int judge_statistics(const struct blocks *blocks)
{
    int drifts = 0;
    double level = stat_sidak(FALSE_ALARM, FIGURES);
    printf("%-20s %12s %9s %12s %12s %21s %6s %8s\n", "statistic", "mean", "se %",
           "first third", "last third", "slope, % of mean/h", "r1", "p");
    for (int s = 0; s < SERIES; s++) {
        struct trend t = trend_of(blocks->t, blocks->x[s], blocks->count);
        double unit = 100.0 / t.mean;
        bool drift = s < FIGURES && !(t.p >= level);
        printf("%-20s %12.6g %9.4f %12.6g %12.6g %10.4f +- %7.4f %6.2f %8.4f%s\n",
               series_name(s), t.mean, unit * t.se, t.first, t.last, unit * t.slope,
               unit * t.slope_se, t.neighbours, t.p, drift ? "  DRIFT" : "");
        drifts += drift;
    }
    printf("%d of %d statistics drift, at level %.2g each (%.2g in all), %d blocks\n",
           drifts, FIGURES, level, FALSE_ALARM, blocks->count);
    return drifts;
}

/* --- memory ----------------------------------------------------------------------- */

static double least(const struct csv *csv, const char *column, size_t from, size_t to)
{
    double x = HUGE_VAL;
    for (size_t row = from; row < to; row++)
        x = fmin(x, cell(csv, row, column));
    return x;
}

static double sum(const struct csv *csv, const char *column, size_t from, size_t to)
{
    double x = 0.0;
    for (size_t row = from; row < to; row++)
        x += cell(csv, row, column);
    return x;
}

static int judge_memory(const struct csv *csv, const struct csv *log, double warm_up,
                        int count)
{
    static const char *const columns[] = {"live_bytes", "live_blocks", "data", "resident",
                                          "anonymous"};
    double begun = cell(log, first_row(log, warm_up), "cpu_s");
    size_t from = 1, to;
    while (from < csv->rows && cell(csv, from, "cpu_s") <= begun)
        from++;
    to = from;
    while (to < csv->rows && cell(csv, to, "cpu_s") <= cell(log, log->rows - 1, "cpu_s"))
        to++;
    size_t size = (to - from) / (size_t)count;
    int grown = 0;
    if (size < 1)
        die("fewer samples than blocks");
    printf("%-12s %14s %14s %24s\n", "memory", "first", "last", "slope per h");
    for (int c = 0; c < 5; c++) {
        double t[BLOCKS_MOST], x[BLOCKS_MOST];
        for (int i = 0; i < count; i++) {
            size_t begin = from + (size_t)i * size;
            x[i] = least(csv, columns[c], begin, begin + size);
            t[i] = cell(csv, begin + size / 2, "wall_s") / 3600.0;
        }
        struct trend trend = trend_of(t, x, count);
        bool more = c < 3 && x[count - 1] > x[0];
        printf("%-12s %14.0f %14.0f %12.6g +- %8.3g%s\n", columns[c], x[0], x[count - 1],
               trend.slope, trend.slope_se, more ? "  GROWN" : "");
        grown += more;
    }
    size_t quiet = 0;
    for (size_t row = from; row < to; row++)
        quiet += cell(csv, row, "calls") == 0.0;
    printf("%zu of %zu samples without an allocation, %.0f allocations in the others; "
           "%.0f minor and %.0f major page faults\n",
           quiet, to - from, sum(csv, "calls", from, to),
           sum(csv, "minor_faults", from, to), sum(csv, "major_faults", from, to));
    return grown;
}

static int take_count(const char *text)
{
    int count = atoi(text);
    if (count < 4 || count > BLOCKS_MOST)
        die("4 to 100 blocks, please");
    return count;
}

int main(int argc, char **argv)
{
    if (argc == 6 && strcmp(argv[1], "statistics") == 0) {
        struct csv *log = read_table(argv[2]);
        struct blocks blocks = {0};
        take_blocks(&blocks, log, atof(argv[3]), take_count(argv[4]));
        write_blocks(&blocks, argv[5]);
        csv_destroy(log);
        return judge_statistics(&blocks) > 0;
    }
    if (argc == 6 && strcmp(argv[1], "memory") == 0) {
        struct csv *samples = read_table(argv[2]), *log = read_table(argv[3]);
        int grown = judge_memory(samples, log, atof(argv[4]), take_count(argv[5]));
        csv_destroy(log);
        csv_destroy(samples);
        return grown > 0;
    }
    die("drift statistics ERRORS.csv WARM_UP BLOCKS OUT.csv, or "
        "drift memory SAMPLES.csv ERRORS.csv WARM_UP BLOCKS");
}

#include "analysis/regress.h"

#include "base/mem.h"
#include "math/student.h"

#include <float.h>
#include <math.h>
#include <string.h>

#define POWER 0.9

/* The variances of the two sides count as different if their logarithms differ by more
 * than this many standard errors. This decides only where Welch's test has to agree as
 * well. Of 236 tables of three runs a cell, some with the heavy tails of stuck chains, 2
 * gave an alarm at level 0.01; with 3.3 here, 11 did. */
#define UNLIKE 1.5

/* --- one figure ------------------------------------------------------------------ */

static double variance(const struct cell_statistic *s)
{
    return s->count > 1 ? s->se * s->se * (double)s->count : 0.0;
}

static double chance(double change, double se, double freedom)
{
    if (!(se > 0.0))
        return change == 0.0 ? 1.0 : 0.0;
    return 2.0 * student_tail(fabs(change) / se, freedom);
}

static void test_student(struct regress_row *row)
{
    double n = (double)row->base->count, m = (double)row->now->count;
    double pooled = ((n - 1.0) * variance(row->base) + (m - 1.0) * variance(row->now)) /
                    (n + m - 2.0);
    row->test = REGRESS_STUDENT;
    row->se = sqrt(pooled * (1.0 / n + 1.0 / m));
    row->freedom = n + m - 2.0;
    row->p = chance(row->change, row->se, row->freedom);
}

static bool spread_unlike(const struct cell_statistic *a, const struct cell_statistic *b)
{
    if (a->count < 2 || b->count < 2)
        return false;
    double u = variance(a), v = variance(b);
    double se = sqrt(2.0 / (double)(a->count - 1) + 2.0 / (double)(b->count - 1));
    return u != v && !(fabs(log(u / v)) <= UNLIKE * se);
}

/* [Welch47], the degrees of freedom by [Satterthwaite46]. */
static void test_welch(struct regress_row *row)
{
    double u = row->base->se * row->base->se, v = row->now->se * row->now->se;
    double se = sqrt(u + v);
    double spread = 2.0 * u * u / (double)(row->base->count - 1) +
                    2.0 * v * v / (double)(row->now->count - 1);
    double freedom = student_freedom(u + v, spread);
    double p = chance(row->change, se, freedom);
    if (p <= row->p)
        return;
    row->test = REGRESS_WELCH;
    row->se = se;
    row->freedom = freedom;
    row->p = p;
}

static void test_within(struct regress_row *row)
{
    row->test = REGRESS_WITHIN;
    row->se = hypot(row->base->se_within, row->now->se_within);
    row->freedom = (double)INFINITY;
    row->p = chance(row->change, row->se, row->freedom);
}

/* False if there is no standard error. */
static bool test_means(struct regress_row *row)
{
    const struct cell_statistic *a = row->base, *b = row->now;
    double larger = fmax(fabs(a->mean), fabs(b->mean));
    row->change = b->mean - a->mean;
    if (a->count + b->count > 2) {
        test_student(row);
        if (spread_unlike(a, b))
            test_welch(row);
    } else if (isfinite(a->se_within) && isfinite(b->se_within)) {
        test_within(row);
    } else if (row->change != 0.0) {
        return false;
    }
    if (!(row->se > 0.0)) {
        row->test = REGRESS_EQUAL;
        row->p = fabs(row->change) <= (double)FLT_EPSILON * larger ? 1.0 : 0.0;
    }
    return true;
}

static double log_choose(long n, long k)
{
    return lgamma((double)n + 1.0) - lgamma((double)k + 1.0) -
           lgamma((double)(n - k) + 1.0);
}

/* Fisher's exact test, two-sided: the probability of all distributions of the missing
 * values over the two sides that are no more likely than the observed one. */
static double chance_missing(const struct cell_statistic *a,
                             const struct cell_statistic *b)
{
    long n = a->count + a->missing, m = b->count + b->missing;
    long missing = a->missing + b->missing;
    double all = log_choose(n + m, missing), sum = 0.0;
    double this = log_choose(n, a->missing) + log_choose(m, b->missing);
    for (long k = 0; k <= missing; k++) {
        if (k > n || missing - k > m)
            continue;
        double way = log_choose(n, k) + log_choose(m, missing - k);
        if (way <= this + 1e-9)
            sum += exp(way - all);
    }
    return fmin(sum, 1.0);
}

/* --- cells ----------------------------------------------------------------------- */

struct work {
    struct regress *out;
    struct log *log;
    const struct cell *base, *now;
};

static struct regress_row *add_row(const struct work *w, const char *statistic,
                                   enum regress_verdict verdict)
{
    const double nan = (double)NAN;
    struct regress *out = w->out;
    out->rows = mem_grow(out->rows, &out->capacity, out->count + 1, sizeof *out->rows);
    struct regress_row *row = &out->rows[out->count++];
    *row = (struct regress_row){.cell = w->base,
                                .statistic = statistic,
                                .verdict = verdict,
                                .change = nan,
                                .se = nan,
                                .freedom = nan,
                                .p = nan,
                                .detectable = nan};
    return row;
}

static void differs(const struct work *w, const char *what, const char *base,
                    const char *now)
{
    struct regress_row *row = add_row(w, what, REGRESS_DIFFERS);
    row->base_text = base;
    row->now_text = now;
}

/* Whether the cell has the same settings and contents on both sides. */
static bool compare_settings(const struct work *w)
{
    size_t before = w->out->count;
    const char *a = w->base->id, *b = w->now->id;
    for (size_t i = 0; i < w->base->count; i++) {
        const struct cell_statistic *s = &w->base->statistics[i];
        const struct cell_statistic *t = cell_find(w->now, s->name);
        if (s->text && t && !text_equal(s->text, t->text))
            differs(w, s->name, s->text, t->text);
    }
    if (a[0] && b[0] && !text_equal(a, b))
        differs(w, "cell", a, b);
    return w->out->count == before;
}

static void compare_statistic(const struct work *w, const struct cell_statistic *base,
                              const struct cell_statistic *now)
{
    if (now->count > 0 && base->missing + now->missing > 0) {
        struct regress_row *row = add_row(w, base->name, REGRESS_SAME);
        row->test = REGRESS_MISSING;
        row->base = base;
        row->now = now;
        row->p = chance_missing(base, now);
    }
    struct regress_row *row = add_row(w, base->name, REGRESS_SAME);
    row->base = base;
    row->now = now;
    if (now->count == 0) {
        row->verdict = REGRESS_GONE;
    } else if (!test_means(row)) {
        log_note(w->log, NULL,
                 "not compared: '%s' has one run on either side, and no standard error",
                 base->name);
        w->out->count--;
    }
}

static bool has_other_lengths(const struct cell *cell, const char *name)
{
    size_t length = strcspn(name, "[");
    for (size_t i = 0; name[length] && i < cell->count; i++)
        if (strncmp(cell->statistics[i].name, name, length + 1) == 0)
            return true;
    return false;
}

static void compare_cell(const struct work *w)
{
    if (!compare_settings(w))
        return;
    if (w->base->seed_first <= w->now->seed_last &&
        w->now->seed_first <= w->base->seed_last)
        log_note(w->log, NULL,
                 "seeds of the baseline and of the results overlap: with equal "
                 "seeds the power to detect a change is less than stated");
    if ((w->base->runs == 1) != (w->now->runs == 1))
        log_note(w->log, NULL,
                 "one run on one side: figures with long tails alarm more often than the "
                 "level says");
    if (w->now->budget[0] != 'm')
        log_note(w->log, NULL,
                 "a budget of seconds: the statistics depend on the machine too");
    for (size_t i = 0; i < w->base->count; i++) {
        const struct cell_statistic *s = &w->base->statistics[i];
        const struct cell_statistic *t = cell_find(w->now, s->name);
        if (s->text || !cell_has(s))
            continue;
        if (t)
            compare_statistic(w, s, t);
        else if (has_other_lengths(w->now, s->name))
            add_row(w, s->name, REGRESS_GONE)->base = s;
        else
            log_note(w->log, NULL, "not compared: the results have no column '%s'",
                     s->name);
    }
}

static void note_new(const struct cells *base, const struct cells *now, struct log *log)
{
    for (size_t i = 0; i < now->count; i++) {
        const struct cell *cell = &now->items[i], *known = cells_find(base, cell);
        if (known == NULL)
            log_note(log, NULL, "new: '%s %s %s' is not in the baseline", cell->scene,
                     cell->label, cell->budget);
        for (size_t k = 0; known && k < cell->count; k++)
            if (cell_has(&cell->statistics[k]) &&
                cell_find(known, cell->statistics[k].name) == NULL)
                log_note(log, NULL, "new: '%s' is not in the baseline",
                         cell->statistics[k].name);
    }
}

/* --- the table ------------------------------------------------------------------- */

static bool by_chance(const struct regress_row *row)
{
    return row->test != REGRESS_NONE && row->test != REGRESS_EQUAL;
}

static void judge(struct regress *out, double level)
{
    for (size_t i = 0; i < out->count; i++)
        out->tests += by_chance(&out->rows[i]);
    out->level_each = -expm1(log1p(-level) / (double)(out->tests ? out->tests : 1));
    for (size_t i = 0; i < out->count; i++) {
        struct regress_row *row = &out->rows[i];
        if (row->test != REGRESS_NONE && !(row->p >= out->level_each))
            row->verdict = REGRESS_MOVED;
        if (by_chance(row) && row->test != REGRESS_MISSING)
            row->detectable = row->se * (student_quantile(1.0 - 0.5 * out->level_each,
                                                          row->freedom) +
                                         student_quantile(POWER, row->freedom));
        out->changes += row->verdict != REGRESS_SAME;
    }
}

void regress_compare(const struct cells *base, const struct cells *now, double level,
                     struct regress *out, struct log *log)
{
    *out = (struct regress){0};
    for (size_t i = 0; i < base->count; i++) {
        const struct cell *cell = &base->items[i];
        struct work work = {out, log, cell, cells_find(now, cell)};
        if (work.now)
            compare_cell(&work);
        else
            add_row(&work, "", REGRESS_GONE);
    }
    note_new(base, now, log);
    judge(out, level);
}

void regress_deinit(struct regress *regress)
{
    mem_free(regress->rows);
    *regress = (struct regress){0};
}

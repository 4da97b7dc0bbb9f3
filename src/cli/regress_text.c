#include "cli/regress_text.h"

#include "base/mem.h"
#include "math/order.h"

#include <math.h>
#include <string.h>

/* --- where from ------------------------------------------------------------------ */

static const char *common(const char *a, const char *b)
{
    return text_equal(a, b) ? a : "(several)";
}

void regress_print_origin(const char *side, const struct cells *cells, FILE *out)
{
    const struct cell *first = &cells->items[0];
    const char *experiment = first->experiment, *commit = first->commit;
    long least = first->runs, most = first->runs;
    for (size_t i = 1; i < cells->count; i++) {
        const struct cell *cell = &cells->items[i];
        experiment = common(experiment, cell->experiment);
        commit = common(commit, cell->commit);
        least = cell->runs < least ? cell->runs : least;
        most = cell->runs > most ? cell->runs : most;
    }
    fprintf(out, "%-9s %s at %s: %zu cells of %ld", side, experiment, commit,
            cells->count, least);
    if (most > least)
        fprintf(out, " to %ld", most);
    fprintf(out, " seeds\n");
}

/* --- rows ------------------------------------------------------------------------ */

static char *cell_name(const struct cell *cell)
{
    return text_format("%s %s %s", cell->scene, cell->label, cell->budget);
}

static int cell_width(const struct regress *regress)
{
    size_t width = 4;
    for (size_t i = 0; i < regress->count; i++) {
        char *name = cell_name(regress->rows[i].cell);
        width = strlen(name) > width ? strlen(name) : width;
        mem_free(name);
    }
    return (int)width;
}

/* A change as a share of the baseline; NAN where that is 0. */
static double relative(const struct regress_row *row, double change)
{
    if (cell_scale(row->statistic) == CELL_LOG)
        return expm1(change);
    return row->base->mean != 0.0 ? change / fabs(row->base->mean) : (double)NAN;
}

static double level_of(const struct cell_statistic *s)
{
    return cell_scale(s->name) == CELL_LOG ? exp(s->mean) : s->mean;
}

static double se_of(const struct cell_statistic *s)
{
    double se = s->count > 1 ? s->se : s->se_within;
    return cell_scale(s->name) == CELL_LOG ? se * exp(s->mean) : se;
}

static void print_side(const struct cell_statistic *s, FILE *out)
{
    char text[64];
    double se = se_of(s);
    if (isfinite(se))
        snprintf(text, sizeof text, "%.6g +- %.2g (%ld)", level_of(s), se, s->count);
    else
        snprintf(text, sizeof text, "%.6g (%ld)", level_of(s), s->count);
    fprintf(out, "  %-28s", text);
}

/* An absolute change where there is no relative one. */
static void print_change(const struct regress_row *row, double change, bool sign,
                         FILE *out)
{
    char text[40];
    double share = relative(row, change);
    snprintf(text, sizeof text, sign ? "%+.3g%s" : "%.3g%s",
             isfinite(share) ? 100.0 * share : change, isfinite(share) ? " %" : "");
    fprintf(out, "  %10s", text);
}

static void print_figure(const struct regress_row *row, FILE *out)
{
    print_side(row->base, out);
    print_side(row->now, out);
    print_change(row, row->change, true, out);
    if (row->test == REGRESS_EQUAL)
        fprintf(out, "  %8s", "exact");
    else
        fprintf(out, "  %+8.2f", row->change / row->se);
    fprintf(out, "  %8.2g", row->p);
    if (isfinite(row->detectable))
        print_change(row, row->detectable, false, out);
    fprintf(out, "  %s\n", regress_test_name(row->test));
}

static void print_row(const struct regress_row *row, int width, FILE *out)
{
    char *name = cell_name(row->cell);
    fprintf(out, "%-7s  %-*s", regress_verdict_name(row->verdict), width, name);
    mem_free(name);
    if (row->statistic[0])
        fprintf(out, "  %-20s", row->statistic);
    if (row->verdict == REGRESS_DIFFERS)
        fprintf(out, "  '%s', now '%s': nothing else of it is compared\n", row->base_text,
                row->now_text);
    else if (row->verdict == REGRESS_GONE)
        fprintf(out,
                row->statistic[0] ? "  %.6g, now no number\n" : "  not in the results\n",
                row->base ? level_of(row->base) : 0.0);
    else if (row->test == REGRESS_MISSING)
        fprintf(out, "  no number in %ld of %ld runs, now in %ld of %ld  p %.2g\n",
                row->base->missing, row->base->missing + row->base->count,
                row->now->missing, row->now->missing + row->now->count, row->p);
    else
        print_figure(row, out);
}

static void print_rows(const struct regress *regress, bool all, FILE *out)
{
    int width = cell_width(regress);
    if (!all && regress->changes == 0)
        return;
    fprintf(out, "%-7s  %-*s  %-20s  %-28s  %-28s  %10s  %8s  %8s  %10s  %s\n", "", width,
            "cell", "statistic", "baseline (runs)", "now (runs)", "change", "sigmas", "p",
            "seen from", "test");
    for (size_t i = 0; i < regress->count; i++)
        if (all || regress->rows[i].verdict != REGRESS_SAME)
            print_row(&regress->rows[i], width, out);
    fputc('\n', out);
}

/* --- how large a change could have been seen ------------------------------------- */

/* Statistics of all path lengths count as one: "b[]". */
static bool same_kind(const char *a, const char *b)
{
    size_t n = strcspn(a, "["), m = strcspn(b, "[");
    return n == m && strncmp(a, b, n) == 0 && (a[n] == '[') == (b[m] == '[');
}

static bool is_first(const struct regress *regress, size_t index)
{
    for (size_t i = 0; i < index; i++)
        if (same_kind(regress->rows[i].statistic, regress->rows[index].statistic))
            return false;
    return true;
}

static void print_kind(const struct regress *regress, const char *kind, double *shares,
                       FILE *out)
{
    size_t count = 0, length = strcspn(kind, "[");
    for (size_t i = 0; i < regress->count; i++) {
        const struct regress_row *row = &regress->rows[i];
        if (!isfinite(row->detectable) || !same_kind(row->statistic, kind))
            continue;
        double share = 100.0 * relative(row, row->detectable);
        if (isfinite(share))
            shares[count++] = share;
    }
    if (count == 0)
        return;
    sort_ascending(shares, count);
    fprintf(out, "  %.*s%-*s %6zu  %8.2g %%  %8.2g %%  %8.2g %%\n", (int)length, kind,
            length < 24 ? 24 - (int)length : 0, kind[length] ? "[]" : "", count,
            shares[0], shares[count / 2], shares[count - 1]);
}

static void print_detectable(const struct regress *regress, FILE *out)
{
    if (regress->tests == 0)
        return;
    double *shares = mem_alloc(regress->count, sizeof *shares);
    fprintf(out, "A change that is seen nine times in ten, of the baseline's value:\n");
    fprintf(out, "  %-24s %6s  %10s  %10s  %10s\n", "statistic", "tests", "best cell",
            "median", "worst cell");
    for (size_t i = 0; i < regress->count; i++)
        if (is_first(regress, i))
            print_kind(regress, regress->rows[i].statistic, shares, out);
    mem_free(shares);
    fputc('\n', out);
}

/* --- the verdict ----------------------------------------------------------------- */

static size_t count_verdict(const struct regress *regress, enum regress_verdict verdict)
{
    size_t count = 0;
    for (size_t i = 0; i < regress->count; i++)
        count += regress->rows[i].verdict == verdict;
    return count;
}

void regress_print(const struct regress *regress, double level, bool all, FILE *out)
{
    print_rows(regress, all, out);
    print_detectable(regress, out);
    fprintf(
        out,
        "%zu figures moved, %zu differ, %zu are gone; %zu tests, each at p < %.2g: if "
        "nothing changed, the whole table alarms with probability %g\n",
        count_verdict(regress, REGRESS_MOVED), count_verdict(regress, REGRESS_DIFFERS),
        count_verdict(regress, REGRESS_GONE), regress->tests, regress->level_each, level);
}

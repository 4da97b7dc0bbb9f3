/* Numerical stability: every integrator and mode on cases driven to extremes, each held
 * against what is known of it (tests/support/stability.h).
 *
 *   stability FOLDER [CATEGORY [SWEEP]]
 *
 * CATEGORY "all" is all of them. SETUPS in the environment: only setups whose names begin
 * with it.
 *
 * Leaves table.csv, table.md and index.html in FOLDER. Exits with 1 if a case failed. */

#include "stability_mended.h"
#include "support/stability_cases.h"
#include "support/stability_invariance.h"
#include "support/stability_sums.h"
#include "table_file.h"

#define GROUPS   32
#define VERDICTS 4

struct table {
    struct stability_row rows[STABILITY_ROWS_MOST];
    int count;
};

struct group {
    const char *category;
    int count, of[VERDICTS];
    double worst; /* residual of what passed */
};

/* --- running ---------------------------------------------------------------------- */

static bool wanted(const char *category, const char *only)
{
    return only == NULL || strcmp(only, "all") == 0 || strcmp(category, only) == 0;
}

static bool wanted_setup(int i)
{
    const char *begin = getenv("SETUPS");
    return !begin || strncmp(stability_setups[i].name, begin, strlen(begin)) == 0;
}

/* A bit for each setup. */
static unsigned wanted_setups(void)
{
    unsigned set = 0;
    for (int i = 0; i < STABILITY_SETUPS; i++)
        set |= (unsigned)wanted_setup(i) << i;
    return set;
}

static void run_invariances(struct table *t)
{
    for (int i = 0; i < STABILITY_SETUPS; i++) {
        const struct stability_setup *setup = &stability_setups[i];
        if (!wanted_setup(i))
            continue;
        if (stability_ignores_scale(setup))
            t->rows[t->count++] = stability_invariance(&stability_emission_bits, setup,
                                                       1);
        t->rows[t->count++] = stability_invariance(&stability_scale_bits, setup, 1);
    }
}

static void run(struct table *t, const char *only, const char *name)
{
    if (wanted("invariance", only))
        run_invariances(t);
    for (int i = 0; i < STABILITY_SWEEPS; i++) {
        const struct stability_sweep *sweep = &stability_sweeps[i];
        if (!wanted(sweep->category, only) || !wanted(sweep->name, name))
            continue;
        fprintf(stderr, "%s: %s\n", sweep->category, sweep->name);
        for (int k = 0; k < sweep->count; k++) {
            stability_need_rows(t->count);
            t->count += stability_run(sweep, sweep->x[k], wanted_setups(),
                                      t->rows + t->count);
        }
    }
    t->count += stability_pools(t->rows, t->count);
    if (wanted("chains", only))
        t->count += stability_chains(t->rows + t->count);
    if (wanted("accumulation", only))
        t->count += stability_sums(t->rows + t->count);
    stability_judge(t->rows, t->count);
}

/* --- writing ---------------------------------------------------------------------- */

static int group_rows(const struct table *t, struct group *groups)
{
    int count = 0;
    for (int i = 0; i < t->count; i++) {
        const struct stability_row *row = &t->rows[i];
        int at = 0;
        while (at < count && strcmp(groups[at].category, row->of->category) != 0)
            at++;
        if (at == count)
            groups[count++] = (struct group){.category = row->of->category};
        struct group *group = &groups[at];
        group->count++;
        group->of[row->verdict]++;
        if (row->verdict == PASSED)
            group->worst = fmax(group->worst, row->residual);
    }
    return count;
}

static void write_csv(const struct table *t, const char *folder)
{
    FILE *f = table_file_open(
        folder, "table.csv",
        "category,case,x,setup,value,reference,se,residual,p,verdict,note");
    for (int i = 0; i < t->count; i++) {
        const struct stability_row *r = &t->rows[i];
        fprintf(f, "%s,\"%s\",%g,%s,%.9g,%.9g,%.3g,%.3g,%.3g,%s,\"%s\"\n",
                r->of->category, r->of->name, r->x, r->setup, r->value, r->reference,
                r->se, r->residual, r->p, case_outcomes[r->verdict], r->note);
    }
    fclose(f);
}

static void write_summary(const struct group *groups, int count, FILE *f)
{
    struct group all = {.category = "all"};
    fprintf(f, "| category | tried | passed | warned | failed | refused | worst residual "
               "that passed |\n|---|---|---|---|---|---|---|\n");
    for (int i = 0; i <= count; i++) {
        const struct group *g = i < count ? &groups[i] : &all;
        fprintf(f, "| %s | %d | %d | %d | %d | %d | %.1f |\n", g->category, g->count,
                g->of[PASSED], g->of[WARNED], g->of[FAILED], g->of[REFUSED], g->worst);
        if (i == count)
            break;
        all.count += g->count;
        all.worst = fmax(all.worst, g->worst);
        for (int k = 0; k < VERDICTS; k++)
            all.of[k] += g->of[k];
    }
}

static void write_markdown(const struct table *t, const struct group *groups, int count,
                           FILE *f)
{
    fprintf(f,
            "# Numerical stability\n\nA residual is |mean of %d replicates - reference| "
            "in standard errors, of the replicates, of the reference and of float "
            "rounding. Levels by Sidak over all residuals: warned below %g, failed "
            "below %g. refused: an error line, or a counted clamp.\n\n",
            STABILITY_REPLICATES, STABILITY_WARN, STABILITY_FAIL);
    write_summary(groups, count, f);
    fprintf(f, "\n## Found and mended\n\n| case | before | mend |\n|---|---|---|\n");
    for (int i = 0; i < MENDED; i++)
        fprintf(f, "| %s | %s | %s |\n", mended[i].where, mended[i].was, mended[i].mend);
    fprintf(f,
            "\n## All that did not just pass\n\n| verdict | case | x | setup | value | "
            "reference | residual | what |\n|---|---|---|---|---|---|---|---|\n");
    for (int i = 0; i < t->count; i++) {
        const struct stability_row *r = &t->rows[i];
        if (r->verdict != PASSED)
            fprintf(f, "| %s | %s, %s | %g | %s | %.4g | %.4g | %.1f | %s |\n",
                    case_outcomes[r->verdict], r->of->category, r->of->name, r->x,
                    r->setup, r->value, r->reference, r->residual, r->note);
    }
}

static void write_page_row(const struct stability_row *r, FILE *f)
{
    fprintf(f,
            "<tr class=\"%s\"><td>%s</td><td>%s</td><td>%g</td><td>%s</td><td>%.4g</td>"
            "<td>%.4g</td><td>%.2g</td><td>%.1f</td><td>%s</td><td>%s</td></tr>\n",
            case_outcomes[r->verdict], r->of->category, r->of->name, r->x, r->setup,
            r->value, r->reference, r->se, r->residual, case_outcomes[r->verdict],
            r->note);
}

static void write_page(const struct table *t, const struct group *groups, int count,
                       FILE *f)
{
    fprintf(f,
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
            "<title>Numerical stability</title>\n<style>\nbody { font: 14px sans-serif; "
            "margin: 2em; }\ntable { border-collapse: collapse; }\ntd, th { padding: 2px "
            "8px; text-align: left; border-bottom: 1px solid #ddd; }\n.failed { "
            "background: #f6b0a8; }\n.warned { background: #fbe7a2; }\n.refused { "
            "background: #d5e3f5; }\n</style></head><body>\n<h1>Numerical "
            "stability</h1>\n<table><tr><th>category</th><th>tried</th><th>passed</th>"
            "<th>warned</th><th>failed</th><th>refused</th></tr>\n");
    for (int i = 0; i < count; i++) {
        const int *of = groups[i].of;
        fprintf(f,
                "<tr class=\"%s\"><td>%s</td><td>%d</td><td>%d</td><td>%d</td>"
                "<td>%d</td><td>%d</td></tr>\n",
                of[FAILED]   ? "failed"
                : of[WARNED] ? "warned"
                             : "passed",
                groups[i].category, groups[i].count, of[PASSED], of[WARNED], of[FAILED],
                of[REFUSED]);
    }
    fprintf(f, "</table>\n<h2>Found and mended</h2>\n<table><tr><th>case</th><th>before"
               "</th><th>mend</th></tr>\n");
    for (int i = 0; i < MENDED; i++)
        fprintf(f, "<tr><td>%s</td><td>%s</td><td>%s</td></tr>\n", mended[i].where,
                mended[i].was, mended[i].mend);
    fprintf(f, "</table>\n<h2>All, the worst first</h2>\n<table><tr><th>category</th><th>"
               "case</th><th>x</th><th>setup</th><th>value</th><th>reference</th><th>se"
               "</th><th>residual</th><th>verdict</th><th>what</th></tr>\n");
    static const enum case_outcome order[VERDICTS] = {FAILED, WARNED, REFUSED, PASSED};
    for (int k = 0; k < VERDICTS; k++)
        for (int i = 0; i < t->count; i++)
            if (t->rows[i].verdict == order[k])
                write_page_row(&t->rows[i], f);
    fprintf(f, "</table></body></html>\n");
}

static int count_failed(const struct group *groups, int count)
{
    int failed = 0;
    for (int i = 0; i < count; i++)
        failed += groups[i].of[FAILED];
    return failed;
}

int main(int argc, char **argv)
{
    static struct table table;
    struct group groups[GROUPS];
    if (argc < 2 || argc > 4) {
        fprintf(stderr, "usage: stability FOLDER [CATEGORY [SWEEP]]\n");
        return 2;
    }
    run(&table, argc > 2 ? argv[2] : NULL, argc > 3 ? argv[3] : NULL);
    int count = group_rows(&table, groups);
    write_csv(&table, argv[1]);
    FILE *md = table_file_open(argv[1], "table.md", "");
    write_markdown(&table, groups, count, md);
    fclose(md);
    FILE *page = table_file_open(argv[1], "index.html", "");
    write_page(&table, groups, count, page);
    fclose(page);
    write_summary(groups, count, stdout);
    return count_failed(groups, count) > 0;
}

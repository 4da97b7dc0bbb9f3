/* etalon regress: the statistics of an experiment against a baseline. */

#include "base/mem.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/fail.h"
#include "cli/output.h"
#include "cli/regress_text.h"
#include "analysis/baseline.h"
#include "lab/store.h"

#include <stdio.h>

#define DEFAULT_LEVEL 0.01

/* Only --update may write the baseline. */
static bool check_apart(const char *results, const char *table, const char *baseline,
                        bool update, struct err *err)
{
    char *runs = text_join(results, "runs.csv"),
         *curves = text_join(results, "curves.csv");
    const struct output_file written[] = {
        {"-o", table}, {"--baseline", update ? baseline : NULL}, {0}};
    const struct output_file read[] = {{"the results", runs},
                                       {"the results", curves},
                                       {"the baseline", update ? NULL : baseline},
                                       {0}};
    bool ok = output_apart(written, read, err);
    mem_free(runs);
    mem_free(curves);
    return ok;
}

static bool check_args(const struct args *args, double *level, struct err *err)
{
    const char *text = args_value(args, "level"), *table = args_value(args, "output");
    const char *baseline = args_value(args, "baseline");
    bool update = args_value(args, "update") != NULL;
    *level = DEFAULT_LEVEL;
    if (baseline == NULL)
        return err_set(err, ERR_USAGE, NULL,
                       "--baseline FILE.csv is missing: what to compare with");
    if (text && (!text_to_double(text, level) || !(*level > 0.0 && *level < 1.0)))
        return err_set(err, ERR_USAGE, NULL,
                       "--level: '%s' is not possible; give a probability in (0,1)",
                       text);
    if (update && (text || table || args_value(args, "all")))
        return err_set(err, ERR_USAGE, NULL,
                       "--update compares nothing: without --level, --all and -o");
    return output_check(table, err) && (!update || output_check(baseline, err)) &&
           check_apart(args->operands[0], table, baseline, update, err);
}

static bool read_results(const char *folder, struct cells *cells, struct log *log,
                         struct err *err)
{
    struct csv *runs = store_read_runs(folder, err);
    if (runs == NULL)
        return err_set(err, ERR_IO, NULL, "there is no '%s/runs.csv'", folder);
    bool ok = cells_from_runs(runs, cells, log, err);
    if (ok && cells->count == 0)
        ok = err_set(err, ERR_VALUE, &(struct place){runs->path, 0, 0},
                     "no run is in it");
    csv_destroy(runs);
    return ok;
}

static int compare(const struct args *args, const struct cells *now, double level,
                   struct log *log)
{
    struct err err = {0};
    struct cells base;
    struct regress regress = {0};
    const char *table = args_value(args, "output");
    bool ok = baseline_read(args_value(args, "baseline"), &base, &err);
    if (ok) {
        regress_compare(&base, now, level, &regress, log);
        regress_print_origin("baseline:", &base, stdout);
        regress_print_origin("results:", now, stdout);
        putchar('\n');
        regress_print(&regress, level, args_value(args, "all") != NULL, stdout);
        ok = table == NULL || regress_write(table, &regress, &err);
    }
    int status = !ok ? fail(&err) : regress.changes > 0;
    regress_deinit(&regress);
    cells_deinit(&base);
    return status;
}

static int update(const char *path, const struct cells *now)
{
    struct err err = {0};
    if (!baseline_write(path, now, &err))
        return fail(&err);
    size_t statistics = 0;
    for (size_t i = 0; i < now->count; i++)
        for (size_t k = 0; k < now->items[i].count; k++)
            statistics += cell_has(&now->items[i].statistics[k]);
    printf("%s: %zu statistics of %zu cells\n", path, statistics, now->count);
    return 0;
}

static int run(const struct args *args)
{
    struct err err = {0};
    struct log log;
    struct cells now = {0};
    double level;
    int status;
    log_init(&log);
    if (!check_args(args, &level, &err) ||
        !read_results(args->operands[0], &now, &log, &err))
        status = fail(&err);
    else if (args_value(args, "update"))
        status = update(args_value(args, "baseline"), &now);
    else
        status = compare(args, &now, level, &log);
    fflush(stdout);
    log_print(&log, stderr);
    log_deinit(&log);
    cells_deinit(&now);
    return status;
}

static const struct arg_option own[] = {
    {"baseline", 0, "FILE.csv", NULL, "what to compare with; must be given"},
    {"level", 0, "P", NULL,
     "probability of a false alarm, of the whole table (default 0.01)"},
    {"all", 0, NULL, NULL, "prints every statistic, not only what moved"},
    {"output", 'o', "TABLE.csv", NULL, "writes every statistic as a table"},
    {"update", 0, NULL, NULL, "writes the baseline anew from RESULTS, as a whole"},
    {0},
};

const struct command command_regress = {
    .name = "regress",
    .summary = "statistics of an experiment against a baseline, by their standard errors",
    .operands = "RESULTS --baseline FILE.csv [options]",
    .operand_count = 1,
    .groups = {own},
    .notes =
        "RESULTS is a folder of 'etalon bench'. Cells (scene, label, budget) are "
        "compared "
        "by\nStudent's t over the runs' seeds; the level is shared out to all tests "
        "(Sidak). Take\nother seeds than the baseline's. A setting, scene or reference "
        "that differs is named,\nand nothing else of that cell is compared.\n\n"
        "Exit status: 0 nothing moved, 1 something moved, differs or is gone (or a file "
        "cannot\nbe read), 2 wrong usage.",
    .run = run,
};

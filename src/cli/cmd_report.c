/* etalon report: the results of an experiment as one page, or as text. */

#include "base/text.h"
#include "cli/commands.h"
#include "cli/fail.h"
#include "cli/report_page.h"
#include "analysis/analysis_text.h"
#include "report/report.h"

#include <stdio.h>

static bool read_axis(const char *name, enum results_axis *axis, struct err *err)
{
    *axis = RESULTS_CPU;
    for (int i = 0; name && i < RESULTS_AXES; i++)
        if (text_equal(name, results_axis_name((enum results_axis)i))) {
            *axis = (enum results_axis)i;
            return true;
        }
    return name == NULL || err_set(err, ERR_USAGE, NULL,
                                   "--axis: '%s' is not possible; give wall_s, cpu_s or "
                                   "mutations_per_pixel",
                                   name);
}

static bool read_error(const char *name, enum results_error *error, struct err *err)
{
    *error = RESULTS_RELMSE_TRIMMED;
    for (int i = 0; name && i < RESULTS_ERRORS; i++)
        if (text_equal(name, results_error_name((enum results_error)i))) {
            *error = (enum results_error)i;
            return true;
        }
    return name == NULL || err_set(err, ERR_USAGE, NULL,
                                   "--error: '%s' is not possible; give relmse, "
                                   "relmse_trimmed, mse or relmse_estimated",
                                   name);
}

static int run(const struct args *args)
{
    struct err err = {0};
    struct report_options options = {.references = args_value(args, "references"),
                                     .baseline = args_value(args, "baseline")};
    struct results *results = NULL;
    bool ok = read_axis(args_value(args, "axis"), &options.axis, &err) &&
              read_error(args_value(args, "error"), &options.error, &err) &&
              (results = results_load(args->operands[0], &err)) != NULL;
    if (ok && args_value(args, "error") == NULL)
        options.error = report_page_error(results);
    if (ok && args_value(args, "text"))
        analysis_text_print(
            stdout, results,
            &(struct analysis_text_options){options.axis, options.error, true});
    else if (ok)
        ok = report_page_write(results, &options, &err);
    results_destroy(results);
    return ok ? 0 : fail(&err);
}

static const struct arg_option own[] = {
    {"text", 0, NULL, NULL, "prints the tables of the analysis as text; writes no page"},
    {"axis", 0, "NAME", NULL,
     "time or work at which methods are compared: cpu_s, wall_s, mutations_per_pixel"},
    {"error", 0, "NAME", NULL,
     "of plots, speed-ups and regret: relmse_trimmed (default: without the worst 1 % of "
     "pixels), relmse, mse, or relmse_estimated, by the runs' own error bars (default "
     "without references); tables have the first two beside each other"},
    {"baseline", 0, "LABEL", NULL,
     "of the cells that speed-ups are against (default: of each scene and budget the "
     "first "
     "automatic one)"},
    {"references", 0, "DIR", NULL,
     "folder of rendered references, for tables that do not name theirs (default "
     "RESULTS/../references)"},
    {0},
};

const struct command command_report = {
    .name = "report",
    .summary =
        "makes a page of an experiment's results: tables, plots, pictures to compare",
    .operands = "RESULTS [options]",
    .operand_count = 1,
    .groups = {own},
    .notes =
        "RESULTS is a folder that etalon bench has written. Writes RESULTS/report.html, "
        "which\nneeds nothing beside itself. Plots are drawn by gnuplot, if it is there.",
    .run = run,
};

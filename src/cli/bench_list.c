#include "cli/bench_list.h"

#include "base/mem.h"
#include "base/text.h"
#include "lab/job_time.h"
#include "lab/parts.h"
#include "lab/store.h"

#include <math.h>
#include <stdio.h>

char *bench_duration(double seconds)
{
    long s = lround(seconds);
    if (seconds < 60.0)
        return text_format("%.1f s", seconds);
    if (s < 3600)
        return text_format("%ld:%02ld min", s / 60, s % 60);
    return text_format("%ld:%02ld:%02ld h", s / 3600, s / 60 % 60, s % 60);
}

struct totals {
    size_t jobs, done, parts, unknown;
    double seconds; /* expected time of the open jobs, as far as it is known */
};

static void list_job(const struct job *job, size_t number, const char *folder,
                     const struct csv *runs, struct totals *totals)
{
    struct outcome outcome;
    bool done = runs && store_has_job(runs, job->id);
    bool part = !done && part_is_finished(folder, job, &outcome);
    double seconds = done   ? job_time_spent(job, runs)
                     : part ? outcome.seconds
                            : job_time_expected(job, runs);
    char *time = isnan(seconds) ? text_copy("?") : bench_duration(seconds);
    printf("%4zu  %s  %-4s  %12s  %s\n", number, job->id,
           done   ? "done"
           : part ? "part"
                  : "todo",
           time, job->name);
    mem_free(time);
    totals->jobs++;
    totals->done += done;
    totals->parts += part;
    totals->unknown += !done && !part && isnan(seconds);
    totals->seconds += done || part || isnan(seconds) ? 0.0 : seconds;
}

/* Whether an earlier row has the same reference. */
static bool is_listed(const struct csv *runs, size_t row, int column)
{
    for (size_t i = 1; i < row; i++)
        if (text_equal(csv_cell(runs, i, column), csv_cell(runs, row, column)))
            return true;
    return false;
}

static void list_references(const struct csv *runs)
{
    int column = runs ? csv_column(runs, "reference") : -1;
    for (size_t row = 1; column >= 0 && row < runs->rows; row++) {
        const char *path = csv_cell(runs, row, column);
        double noise = csv_number(runs, row, csv_column(runs, "reference_relmse"));
        if (path[0] == '\0' || text_equal(path, ".nan") || is_listed(runs, row, column))
            continue;
        printf("reference of %s: %s, ",
               csv_cell(runs, row, csv_column(runs, "scene_label")), path);
        if (isnan(noise))
            printf("its own noise is not known\n");
        else
            printf("its own noise is a relmse of %.3g\n", noise);
    }
}

static void print_totals(const struct totals *totals)
{
    char *time = bench_duration(totals->seconds);
    printf("%zu jobs, %zu done", totals->jobs, totals->done);
    if (totals->parts > 0)
        printf(", %zu finished in parts", totals->parts);
    printf("; to do: %s", time);
    if (totals->unknown > 0)
        printf(" and %zu of unknown length", totals->unknown);
    printf(" (rendering alone, without references)\n");
    mem_free(time);
}

bool bench_list(const struct jobs *jobs, const char *folder, const char *only,
                struct err *err)
{
    struct totals totals = {0};
    struct csv *runs = store_read_runs(folder, err);
    if (runs == NULL && err->code != ERR_NONE)
        return false;
    for (size_t i = 0; i < jobs->count; i++)
        if (only == NULL || job_matches(&jobs->items[i], only))
            list_job(&jobs->items[i], i + 1, folder, runs, &totals);
    list_references(runs);
    csv_destroy(runs);
    print_totals(&totals);
    return true;
}

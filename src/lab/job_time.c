#include "lab/job_time.h"

#include <math.h>

static bool is_like(const struct csv *runs, size_t row, const struct job *job)
{
    return text_equal(csv_cell(runs, row, csv_column(runs, "scene_label")),
                      job->scene->label) &&
           text_equal(csv_cell(runs, row, csv_column(runs, "label")), job->label);
}

double job_time_expected(const struct job *job, const struct csv *runs)
{
    const char *budget = job_value(job, "seconds");
    const char *mutations = job_value(job, "mutations_per_pixel");
    double own = 0.0, seconds = 0.0, done = 0.0;
    if (budget && text_to_double(budget, &own))
        return own;
    if (runs == NULL || mutations == NULL || !text_to_double(mutations, &own))
        return (double)NAN;
    for (size_t row = 1; row < runs->rows; row++) {
        if (!is_like(runs, row, job))
            continue;
        seconds += csv_number(runs, row, csv_column(runs, "seconds_total"));
        done += csv_number(runs, row, csv_column(runs, "mutations_per_pixel"));
    }
    return done > 0.0 ? own * seconds / done : (double)NAN;
}

double job_time_spent(const struct job *job, const struct csv *runs)
{
    for (size_t row = 1; runs && row < runs->rows; row++)
        if (text_equal(csv_cell(runs, row, csv_column(runs, "job")), job->id))
            return csv_number(runs, row, csv_column(runs, "seconds_total"));
    return (double)NAN;
}

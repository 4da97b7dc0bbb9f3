#ifndef ETALON_LAB_STORE_H
#define ETALON_LAB_STORE_H

/* The folder of an experiment's results:
 *
 *   runs.csv         one row a finished job: job, label, scene_label, every key of
 *                    lab/statistics, rmse, relmse, relmse_trimmed, mean_ratio
 *   curves.csv       one row a snapshot: job, the columns of the error log
 *   images/JOB.exr   pictures
 *   lock             held while a batch is at work; a dead one leaves it free
 *
 * A job is finished when its row is in runs.csv, which is written last and at once. What
 * a batch left that died before (curves without a row, half a line, a half-written
 * picture) is removed when the next one opens the folder. Columns are told by name.
 * Two more stand before rmse: experiment (its name) and cell (struct job). */

#include "image/metric.h"
#include "lab/csv.h"
#include "lab/error_log.h"
#include "lab/statistics.h"

struct store;

struct store_result {
    const char *job, *label, *scene_label;
    const char *experiment, *cell; /* its name; job->cell */
    const struct statistics_record *record;
    const struct metric *metric; /* NULL: there is no reference */
    const struct error_row *curve;
    size_t curve_count;
};

/* Makes the folder if there is none and locks it; NULL on failure: another batch is at
 * work there, it cannot be written, or its tables have other columns than today's. */
struct store *store_open(const char *folder, struct err *err);
void store_close(struct store *store);

/* Where the picture of a job goes; the caller owns it (mem_free). */
char *store_picture_path(const struct store *store, const char *job);
/* The picture must be in place. */
bool store_append(struct store *store, const struct store_result *result,
                  struct err *err);

/* The table of finished jobs as it is now, with or without a batch at work; NULL with
 * err->code ERR_NONE if there is none yet. */
struct csv *store_read_runs(const char *folder, struct err *err);
bool store_has_job(const struct csv *runs, const char *job);

#endif

#ifndef ETALON_LAB_STORE_H
#define ETALON_LAB_STORE_H

/* The folder of an experiment's results:
 *
 *   runs.csv         one row a finished job: job, label, scene_label, every key of
 *                    lab/statistics, rmse, relmse, relmse_trimmed, mean_ratio, reference,
 *                    its own noise reference_rmse and reference_relmse, and the errors
 *                    without it, rmse_corrected and relmse_corrected
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
#include "lab/reference.h"
#include "lab/statistics.h"

struct store;

struct store_result {
    const char *job, *label, *scene_label;
    const char *experiment, *cell; /* its name; job->cell */
    const struct statistics_record *record;
    const struct metric *metric;       /* NULL: there is no reference */
    const struct reference *reference; /* NULL as well, */
    const char *reference_path;        /* or as results call it */
    const struct error_row *curve;
    size_t curve_count;
};

/* Makes the folder if there is none and locks it, waiting for another process at work
 * there if `wait`; NULL on failure: another one is, it cannot be written, or its tables
 * have columns that today's do not. Columns that they do not have are added. */
struct store *store_open(const char *folder, bool wait, struct err *err);
void store_close(struct store *store);
bool store_upgraded(const struct store *store); /* columns were added */

/* Where the picture of a job goes; the caller owns it (mem_free). */
char *store_picture_path(const struct store *store, const char *job);
/* The picture must be in place. */
bool store_append(struct store *store, const struct store_result *result,
                  struct err *err);

/* Takes a finished job over from another store on the same file system: moves the
 * picture, appends the rows. What is interrupted can be done again. */
bool store_take(struct store *store, struct store *other, const char *job,
                struct err *err);
/* Closes it and removes its folder, as far as there is nothing in it but the tables. */
void store_remove(struct store *store);

/* The table of finished jobs as it is now, with or without a batch at work; NULL with
 * err->code ERR_NONE if there is none yet. */
struct csv *store_read_runs(const char *folder, struct err *err);
bool store_has_job(const struct csv *runs, const char *job);

#endif

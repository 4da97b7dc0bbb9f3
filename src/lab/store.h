#ifndef ETALON_LAB_STORE_H
#define ETALON_LAB_STORE_H

/* The folder of an experiment's results:
 *
 *   runs.csv         one row a finished job: job, label, scene_label, every key of
 *                    lab/statistics, rmse, relmse, relmse_trimmed, mean_ratio, reference,
 *                    its own noise reference_rmse and reference_relmse, and the errors
 *                    without it, rmse_corrected and relmse_corrected; smape, flip
 *   curves.csv       one row a snapshot: job, the columns of the error log
 *   images/JOB.exr   pictures
 *   lock             held while a batch is at work; a dead one leaves it free
 *
 * A job is finished when its row is in runs.csv, which is written last and at once. What
 * a batch that died left behind (curves without a row, half a line, a half-written
 * picture) is removed when the next batch opens the folder. Columns are found by name.
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
    double flip;                       /* HDR-FLIP (image/flip.h), with a metric */
    const struct reference *reference; /* NULL as well, */
    const char *reference_path;        /* or as results call it */
    const struct error_row *curve;
    size_t curve_count;
};

/* Creates the folder if it does not exist and locks it; wait: waits for another process
 * that holds the lock. NULL on failure: it is locked, it cannot be written, or its tables
 * have columns that today's program does not know. Missing columns are added. */
struct store *store_open(const char *folder, bool wait, struct err *err);
void store_close(struct store *store);
bool store_upgraded(const struct store *store); /* whether columns were added */

/* Path of the picture of a job; the caller owns it (mem_free). */
char *store_picture_path(const struct store *store, const char *job);
/* Appends the rows of a job; its picture must be written before. */
bool store_append(struct store *store, const struct store_result *result,
                  struct err *err);

/* Moves a finished job from another store on the same file system to this one. Can be
 * repeated after an interruption. */
bool store_take(struct store *store, struct store *other, const char *job,
                struct err *err);
/* Closes the store and removes its folder unless it holds more than the tables. */
void store_remove(struct store *store);

/* Reads the table of finished jobs, also while a batch runs; NULL with err->code ERR_NONE
 * if it does not exist. */
struct csv *store_read_runs(const char *folder, struct err *err);
bool store_has_job(const struct csv *runs, const char *job);

#endif

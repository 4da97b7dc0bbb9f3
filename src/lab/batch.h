#ifndef ETALON_LAB_BATCH_H
#define ETALON_LAB_BATCH_H

/* The state of the jobs of a batch while it runs; for lab/runner and lab/runner_parallel.
 */

#include "lab/runner.h"

enum job_state {
    JOB_NOT_WANTED, /* excluded by `only` */
    JOB_HAD_ROW,    /* had its row before this batch */
    JOB_TODO,
    JOB_RUNNING, /* by a worker */
    JOB_IN_PART, /* finished; its row is in its part */
    JOB_JOINED,  /* got its row in this batch */
    JOB_LOST,    /* its worker died */
};

struct batch {
    const struct runner_options *options;
    struct runner_summary *summary;
    struct store *store;
    enum job_state *states; /* by job */
    bool *missing;          /* by job: its reference is to be made first */
    size_t to_do;           /* jobs that had no row */
    size_t cursor; /* all jobs before this one are finished and joined, or not wanted */
};

void batch_init(struct batch *batch, const struct runner_options *options,
                struct runner_summary *summary);
void batch_deinit(struct batch *batch);

bool batch_stopped(const struct batch *batch);
struct job_context_options batch_context_options(const struct batch *batch);
void batch_report(struct batch *batch, size_t job, const struct outcome *outcome,
                  bool taken);
/* Reports the finished parts that an earlier batch, or single jobs, left. */
void batch_report_parts(struct batch *batch);
/* Joins a finished part into the results. */
bool batch_join_part(struct batch *batch, size_t job, struct err *err);
/* Joins the finished parts in the order of jobs, up to the first job that is not
 * finished. */
bool batch_join_parts(struct batch *batch, struct err *err);

#endif

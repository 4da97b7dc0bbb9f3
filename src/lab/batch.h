#ifndef ETALON_LAB_BATCH_H
#define ETALON_LAB_BATCH_H

/* What a batch knows of its jobs while it runs: for lab/runner and lab/runner_parallel.
 */

#include "lab/runner.h"

enum job_state {
    JOB_NOT_WANTED, /* not asked for */
    JOB_HAD_ROW,    /* has its row since earlier */
    JOB_TODO,
    JOB_RUNNING, /* by a worker */
    JOB_IN_PART, /* finished, in its part */
    JOB_JOINED,  /* has its row now */
    JOB_LOST,    /* its worker died */
};

struct batch {
    const struct runner_options *options;
    struct runner_summary *summary;
    struct store *store;
    enum job_state *states; /* by job */
    bool *missing;          /* by job: its reference is to be made first */
    size_t to_do;           /* jobs that had no row */
    size_t cursor;          /* jobs before it are settled */
};

void batch_init(struct batch *batch, const struct runner_options *options,
                struct runner_summary *summary);
void batch_deinit(struct batch *batch);

bool batch_stopped(const struct batch *batch);
struct job_context_options batch_context_options(const struct batch *batch);
void batch_report(struct batch *batch, size_t job, const struct outcome *outcome,
                  bool taken);
/* Tells of the parts that an earlier batch, or jobs that ran alone, have left. */
void batch_report_parts(struct batch *batch);
/* Gives a finished part its row. */
bool batch_join_part(struct batch *batch, size_t job, struct err *err);
/* Gives their rows to the finished parts that no unsettled job precedes. */
bool batch_join_parts(struct batch *batch, struct err *err);

#endif

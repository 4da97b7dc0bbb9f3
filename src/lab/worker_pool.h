#ifndef ETALON_LAB_WORKER_POOL_H
#define ETALON_LAB_WORKER_POOL_H

/* Worker processes that run jobs in parallel, each job into its part (lab/parts.h). They
 * are forked from this process, which must not have started a thread, and die with it. A
 * crash of a worker loses only its current job. */

#include "lab/parts.h"

enum worker_event_kind {
    WORKER_NOTHING, /* no event within the timeout, or a signal */
    WORKER_PROGRESS,
    WORKER_REFERENCE_HALF, /* before a half of a reference is rendered */
    WORKER_DONE,
    WORKER_FAILED,
    WORKER_STOPPED,
    WORKER_DIED,
};

struct worker_event {
    enum worker_event_kind kind;
    size_t job;                   /* except for WORKER_NOTHING */
    struct run_progress progress; /* WORKER_PROGRESS */
    int half;                     /* WORKER_REFERENCE_HALF */
    char folder[512];
    struct outcome outcome; /* WORKER_DONE of a job */
    struct err err;         /* WORKER_FAILED */
    int wait_status;        /* WORKER_DIED: from waitpid */
};

struct worker_pool;

/* At most `count` workers, each with an equal share of the threads. context: options for
 * all of them, except threads and hooks; borrowed. */
struct worker_pool *worker_pool_create(const struct jobs *jobs,
                                       const struct job_context_options *context,
                                       int count, struct err *err);
/* Ends the workers after their current jobs. */
void worker_pool_destroy(struct worker_pool *pool);

bool worker_pool_is_idle(const struct worker_pool *pool); /* a worker is free */
bool worker_pool_is_busy(const struct worker_pool *pool); /* a job runs */

/* Gives a job to a free worker; there must be one. reference: only makes the job's
 * reference. */
bool worker_pool_give(struct worker_pool *pool, size_t job, bool reference,
                      struct err *err);

/* Waits a fraction of a second for the next event. After DONE, FAILED, STOPPED and DIED
 * the worker is free. */
void worker_pool_wait(struct worker_pool *pool, struct worker_event *event);

/* Stops all workers as SIGTERM does; each busy worker ends with an event. */
void worker_pool_stop(struct worker_pool *pool);

#endif

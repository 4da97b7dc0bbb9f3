#ifndef ETALON_LAB_WORKER_POOL_H
#define ETALON_LAB_WORKER_POOL_H

/* Processes that run jobs side by side, each into its part (lab/parts.h). They are forked
 * from this one, which must not have started a thread, and die with it; one that crashes
 * takes nothing but its job with it. */

#include "lab/parts.h"

enum worker_event_kind {
    WORKER_NOTHING, /* nothing happened for a moment, or a signal came */
    WORKER_PROGRESS,
    WORKER_REFERENCE_HALF, /* of a reference: before it is rendered */
    WORKER_DONE,
    WORKER_FAILED,
    WORKER_STOPPED,
    WORKER_DIED,
};

struct worker_event {
    enum worker_event_kind kind;
    size_t job;                   /* but for WORKER_NOTHING */
    struct run_progress progress; /* WORKER_PROGRESS */
    int half;                     /* WORKER_REFERENCE_HALF, with */
    char folder[512];
    struct outcome outcome; /* WORKER_DONE of a job */
    struct err err;         /* WORKER_FAILED */
    int wait_status;        /* WORKER_DIED: as of waitpid */
};

struct worker_pool;

/* count workers at most, each with an equal share of the threads. context: for all of
 * them, but for threads and hooks; borrowed. */
struct worker_pool *worker_pool_create(const struct jobs *jobs,
                                       const struct job_context_options *context,
                                       int count, struct err *err);
/* Ends the workers, after the job that they are at. */
void worker_pool_destroy(struct worker_pool *pool);

bool worker_pool_is_idle(const struct worker_pool *pool); /* a worker is free */
bool worker_pool_is_busy(const struct worker_pool *pool); /* a job runs */

/* A worker must be free. reference: only the job's reference is made. */
bool worker_pool_give(struct worker_pool *pool, size_t job, bool reference,
                      struct err *err);

/* Waits for the next event, at most a fraction of a second. DONE, FAILED, STOPPED and
 * DIED leave their worker free. */
void worker_pool_wait(struct worker_pool *pool, struct worker_event *event);

/* Has all workers stop as by SIGTERM; each that is at work ends with an event. */
void worker_pool_stop(struct worker_pool *pool);

#endif

#ifndef ETALON_LAB_CREW_H
#define ETALON_LAB_CREW_H

/* Processes that run jobs side by side, each into its part (lab/parts.h). They are forked
 * from this one, which must not have started a thread, and die with it; one that crashes
 * takes nothing but its job with it. */

#include "lab/parts.h"

enum crew_kind {
    CREW_NOTHING, /* nothing happened for a moment, or a signal came */
    CREW_PROGRESS,
    CREW_HALF, /* of a reference: before it is rendered */
    CREW_DONE,
    CREW_FAILED,
    CREW_STOPPED,
    CREW_DIED,
};

struct crew_event {
    enum crew_kind kind;
    size_t job;                   /* but for CREW_NOTHING */
    struct run_progress progress; /* CREW_PROGRESS */
    int half;                     /* CREW_HALF, with */
    char folder[512];
    struct outcome outcome; /* CREW_DONE of a job */
    struct err err;         /* CREW_FAILED */
    int wait_status;        /* CREW_DIED: as of waitpid */
};

struct crew;

/* count workers at most, each with an equal share of the threads. stage: for all of them,
 * but for threads and hooks; borrowed. */
struct crew *crew_create(const struct jobs *jobs, const struct stage_options *stage,
                         int count, struct err *err);
/* Ends the workers, after the job that they are at. */
void crew_destroy(struct crew *crew);

bool crew_is_idle(const struct crew *crew); /* a worker is free */
bool crew_is_busy(const struct crew *crew); /* a job runs */

/* A worker must be free. reference: only the job's reference is made. */
bool crew_give(struct crew *crew, size_t job, bool reference, struct err *err);

/* Waits for the next event, at most a fraction of a second. DONE, FAILED, STOPPED and
 * DIED leave their worker free. */
void crew_wait(struct crew *crew, struct crew_event *event);

/* Has all workers stop as by SIGTERM; each that is at work ends with an event. */
void crew_stop(struct crew *crew);

#endif

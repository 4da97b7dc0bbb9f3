#ifndef ETALON_LAB_JOB_CONTEXT_H
#define ETALON_LAB_JOB_CONTEXT_H

/* Runs jobs one after the other and keeps what consecutive jobs share: a loaded scene and
 * its reference. */

#include "lab/jobs.h"
#include "lab/store.h"

struct job_context_options {
    const struct experiment *experiment;
    const char *folder;     /* of the results; pictures' paths are relative to it */
    const char *references; /* folder of rendered references, lab/reference.h */
    int threads;            /* for jobs that do not set it; 0: all */
    /* Other jobs run at the same time: a reference is rendered with the threads of its
     * job. */
    bool shared;
    bool cold;                         /* no warm-up */
    const volatile sig_atomic_t *stop; /* as in struct run_options */
    /* Called before each half of a reference that is rendered (from 0), and during
     * rendering; may be NULL. */
    void (*on_half)(void *hook_ctx, const char *folder, int half);
    void (*on_progress)(void *hook_ctx, const struct run_progress *progress);
    void *hook_ctx;
};

/* Result of a finished job. */
struct outcome {
    double seconds, paths; /* of rendering */
    double relmse;         /* NAN: there is no reference */
    double noise;          /* relmse of the reference itself; NAN: unknown */
    bool black;            /* no light-carrying path was found */
};

struct job_context;

struct job_context *job_context_create(const struct job_context_options *options);
void job_context_destroy(struct job_context *context);

/* Renders the job's reference if it is of that kind and does not exist. */
bool job_context_make_reference(struct job_context *context, const struct job *job,
                                struct err *err);
/* The reference of the last job; its picture is NULL if there is none. */
const struct reference *job_context_reference(const struct job_context *context);

/* Runs the job and appends its results to the store. Before the first job of a scene that
 * has a time budget, a short warm-up run absorbs page faults and the ramp-up of the
 * processor's clock. False on failure; false with err->code ERR_NONE if it was stopped:
 * then it leaves nothing. */
bool job_context_run(struct job_context *context, const struct job *job,
                     struct store *store, struct outcome *outcome, struct err *err);

#endif

#ifndef ETALON_LAB_JOB_CONTEXT_H
#define ETALON_LAB_JOB_CONTEXT_H

/* Where jobs are run: what consecutive ones share, a scene that is loaded and the
 * reference for it, and the one job that runs. */

#include "lab/jobs.h"
#include "lab/store.h"

struct job_context_options {
    const struct experiment *experiment;
    const char *folder;     /* of the results, from which pictures' paths count */
    const char *references; /* folder of rendered references, lab/reference.h */
    int threads; /* for jobs that leave the number open; 0: all that there are */
    bool shared; /* others run beside: a reference is made on the threads of its job */
    bool cold;   /* no warm-up */
    const volatile sig_atomic_t *stop; /* as in struct run_options */
    /* Before each half of a reference that must be rendered (from 0); while something
     * renders; may be NULL. */
    void (*on_half)(void *hook_ctx, const char *folder, int half);
    void (*on_progress)(void *hook_ctx, const struct run_progress *progress);
    void *hook_ctx;
};

/* What is told of a finished job. */
struct outcome {
    double seconds, paths; /* of rendering */
    double relmse;         /* NAN: there is no reference */
    double noise;          /* the reference's own relmse; NAN: not known */
    bool black;            /* no light-carrying path was found */
};

struct job_context;

struct job_context *job_context_create(const struct job_context_options *options);
void job_context_destroy(struct job_context *context);

/* Makes the job's reference if it has one that is rendered and is not there yet. */
bool job_context_make_reference(struct job_context *context, const struct job *job,
                                struct err *err);
/* That of the last job; its picture is NULL if there was none. */
const struct reference *job_context_reference(const struct job_context *context);

/* Runs the job and puts it into the store. The first job on a scene that has a budget in
 * time runs a moment before, for nothing: page faults and a processor that was asleep are
 * not charged to it. False on failure, or, with err->code ERR_NONE, if it was stopped: it
 * leaves nothing then. */
bool job_context_run(struct job_context *context, const struct job *job,
                     struct store *store, struct outcome *outcome, struct err *err);

#endif

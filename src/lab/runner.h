#ifndef ETALON_LAB_RUNNER_H
#define ETALON_LAB_RUNNER_H

/* Runs the jobs of an experiment that have no row in its results yet, one after the
 * other, each on all threads. A job that is stopped leaves nothing, so the next batch
 * begins it anew; with a budget in mutations its outcome is the same. */

#include "lab/jobs.h"
#include "lab/store.h"

struct runner_report {
    size_t number, of; /* this is job `number` (from 1) of all that were to run */
    const struct job *job;
    const struct run_result *result;
    const struct metric *metric; /* NULL: there is no reference */
};

struct runner_options {
    const struct experiment *experiment;
    const struct jobs *jobs;
    const char *folder;     /* of results, lab/store.h */
    const char *references; /* folder of rendered references, lab/reference.h */
    const char *only;       /* pattern for job_matches, or NULL */
    const volatile sig_atomic_t *stop; /* as in struct run_options */
    /* May be NULL: the notes of loading a scene, once each; before each half of a
     * reference that must be rendered (from 0); while something renders; after a job. */
    void (*on_log)(void *hook_ctx, const struct log *log);
    void (*on_half)(void *hook_ctx, const char *folder, int half);
    void (*on_progress)(void *hook_ctx, const struct run_progress *progress);
    void (*on_job)(void *hook_ctx, const struct runner_report *report);
    void *hook_ctx;
};

struct runner_summary {
    size_t jobs; /* that `only` lets through */
    size_t done_before, done_now;
    bool interrupted;
};

/* summary is filled as far as it came, also on failure; err must be given. */
bool runner_run(const struct runner_options *options, struct runner_summary *summary,
                struct err *err);

#endif

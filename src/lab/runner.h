#ifndef ETALON_LAB_RUNNER_H
#define ETALON_LAB_RUNNER_H

/* Runs the jobs of an experiment that have no row in its results yet: one after the
 * other, each on all threads, or several side by side on a share of them. A job that is
 * stopped leaves nothing, so the next batch begins it anew; with a budget in mutations
 * its outcome is the same. Rows come in the order of the jobs, however they ended. */

#include "lab/job_context.h"

struct runner_report {
    size_t number, of; /* this is job `number` (from 1) of all that were to run */
    const struct job *job;
    const struct outcome *outcome;
    bool taken; /* its part was there already (lab/parts.h) */
};

struct runner_options {
    const struct experiment *experiment;
    const struct jobs *jobs;
    const char *folder;     /* of results, lab/store.h */
    const char *references; /* folder of rendered references, lab/reference.h */
    const char *only;       /* pattern for job_matches, or NULL */
    int workers;            /* jobs at once; up to 1: one, in this process */
    bool force;             /* pass over unfair references, lab/reference_check.h */
    bool cold;              /* no warm-up, lab/job_context.h */
    const volatile sig_atomic_t *stop; /* as in struct run_options */
    /* May be NULL: notes of loading a scene and of the tables, once each; before each
     * half of a reference that must be rendered (from 0); a reference that was made;
     * while something renders; after a job; when a worker died, in words. */
    void (*on_log)(void *hook_ctx, const struct log *log);
    void (*on_half)(void *hook_ctx, const char *folder, int half);
    void (*on_reference)(void *hook_ctx, const struct job *job,
                         const struct reference *reference);
    void (*on_progress)(void *hook_ctx, const struct run_progress *progress);
    void (*on_job)(void *hook_ctx, const struct runner_report *report);
    void (*on_death)(void *hook_ctx, const struct job *job, const char *how);
    void *hook_ctx;
};

struct runner_summary {
    size_t jobs; /* that `only` lets through */
    size_t done_before, done_now;
    size_t waiting;    /* of these: finished, but in parts: those before them are not */
    size_t lost;       /* whose worker died */
    size_t references; /* made by runner_references */
    bool interrupted;
};

/* summary is filled as far as it came, also on failure; err must be given. */
bool runner_run(const struct runner_options *options, struct runner_summary *summary,
                struct err *err);

/* The job of that number (from 1) alone, into its part of the results: without a lock on
 * them, so that others can do the same. */
bool runner_run_one(const struct runner_options *options, size_t number,
                    struct runner_summary *summary, struct err *err);

/* Joins the parts that are finished, and runs nothing. */
bool runner_collect(const struct runner_options *options, struct runner_summary *summary,
                    struct err *err);

/* Makes the references that are to be rendered, and runs nothing. */
bool runner_references(const struct runner_options *options,
                       struct runner_summary *summary, struct err *err);

#endif

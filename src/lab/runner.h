#ifndef ETALON_LAB_RUNNER_H
#define ETALON_LAB_RUNNER_H

/* Runs the jobs of an experiment that have no row in its results yet: one after the
 * other, each on all threads, or several side by side on a share of them. A job that is
 * stopped leaves nothing, so the next batch starts it again; under a budget in mutations
 * its result is the same. Rows are in the order of the jobs, not in that of their ends.
 */

#include "lab/job_context.h"

struct runner_report {
    size_t number, of; /* this is job `number` (from 1) of all jobs to run */
    const struct job *job;
    const struct outcome *outcome;
    bool taken; /* it was finished in its part before this batch (lab/parts.h) */
};

struct runner_options {
    const struct experiment *experiment;
    const struct jobs *jobs;
    const char *folder;     /* of results, lab/store.h */
    const char *references; /* folder of rendered references, lab/reference.h */
    const char *only;       /* pattern for job_matches, or NULL */
    int workers;            /* jobs at once; 0 or 1: one, in this process */
    bool force;             /* accepts references that lab/reference_check.h rejects */
    bool own_method;        /* accepts those by the method under test */
    bool cold;              /* no warm-up, lab/job_context.h */
    const volatile sig_atomic_t *stop; /* as in struct run_options */
    /* Hooks, each may be NULL. Called with: the notes of loading a scene and of the
     * tables, once each; each half of a reference before it is rendered (from 0); a
     * reference that was made; progress while something renders; a finished job; a job
     * whose worker died, with the cause in words. */
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
    size_t jobs; /* that `only` matches */
    size_t done_before, done_now;
    size_t waiting;    /* finished, but in parts, as jobs before them are not finished */
    size_t lost;       /* whose worker died */
    size_t references; /* made by runner_references */
    bool interrupted;
};

/* summary is filled in on failure too; err must not be NULL. */
bool runner_run(const struct runner_options *options, struct runner_summary *summary,
                struct err *err);

/* Runs the job of that number (from 1) into its part of the results. Takes no lock on the
 * results, so any number of processes can do so at once. */
bool runner_run_one(const struct runner_options *options, size_t number,
                    struct runner_summary *summary, struct err *err);

/* Joins the finished parts; runs nothing. */
bool runner_collect(const struct runner_options *options, struct runner_summary *summary,
                    struct err *err);

/* Renders the missing references; runs no job. */
bool runner_references(const struct runner_options *options,
                       struct runner_summary *summary, struct err *err);

#endif

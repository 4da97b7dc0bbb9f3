#ifndef ETALON_LAB_PREFLIGHT_H
#define ETALON_LAB_PREFLIGHT_H

/* All that can be told of a batch before any work: every scene can be read, the settings
 * of every job go with those of its scene file, every reference file can be read, has the
 * size of the pictures that it is for, and is a fair one (lab/reference_check.h). */

#include "lab/jobs.h"

struct preflight_options {
    const struct jobs *jobs;
    const bool *wanted;     /* by job: look at this one */
    const char *references; /* folder of rendered references */
    bool force;             /* pass over unfair references */
    /* NULL, or gets the counted notes of each scene once. */
    void (*on_log)(void *hook_ctx, const struct log *log);
    void *hook_ctx;
};

/* missing[job], which may be NULL, is set for the first wanted job of each reference that
 * is yet to be rendered. Starts no thread. */
bool preflight(const struct preflight_options *options, bool *missing, struct err *err);

#endif

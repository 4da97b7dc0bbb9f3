#ifndef ETALON_LAB_PREFLIGHT_H
#define ETALON_LAB_PREFLIGHT_H

/* Checks a batch before any work: every scene can be read, the settings of every job are
 * compatible with those of its scene file, and every reference file can be read, has the
 * size of the pictures, and is a valid reference (lab/reference_check.h). */

#include "lab/jobs.h"

struct preflight_options {
    const struct jobs *jobs;
    const bool *wanted;     /* by job: whether to check it */
    const char *references; /* folder of rendered references */
    bool force;             /* accepts references that lab/reference_check.h rejects */
    bool own_method;        /* accepts those by the method under test */
    /* NULL, or called once per scene with its log. */
    void (*on_log)(void *hook_ctx, const struct log *log);
    void *hook_ctx;
};

/* Sets missing[job] (may be NULL) for the first wanted job of each reference that is
 * still to be rendered. Starts no thread. */
bool preflight(const struct preflight_options *options, bool *missing, struct err *err);

#endif

#ifndef ETALON_LAB_PREFLIGHT_H
#define ETALON_LAB_PREFLIGHT_H

/* All that can be told of a batch before any work: every scene can be read, the settings
 * of every job go with those of its scene file, every reference file can be read and has
 * the size of the pictures that it is for. */

#include "lab/jobs.h"

/* Looks at the jobs whose `wanted` is set. on_log, which may be NULL, gets the counted
 * notes of each scene once. */
bool preflight(const struct jobs *jobs, const bool *wanted,
               void (*on_log)(void *hook_ctx, const struct log *log), void *hook_ctx,
               struct err *err);

#endif

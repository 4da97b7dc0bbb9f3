#ifndef ETALON_IMPORT_PBRT_FAILURE_H
#define ETALON_IMPORT_PBRT_FAILURE_H

/* Reading goes on after an error, so that all that is wrong is told at once; what only
 * follows from an error is not. */

#include "import/pbrt/pbrt_state.h"

/* p->params are those of this directive, which is in error (NULL: one that is not known).
 * Whoever asks for a name that it would have defined is not. */
void pbrt_failure_mark(struct pbrt *p, const char *directive);

/* Keeps the error. Whether to go on: not where the grammar fails, for nobody knows what
 * would follow; then p->stopped. */
bool pbrt_failure_tell(struct pbrt *p, const struct err *failure);
/* The last one: false. */
bool pbrt_failure_stop(struct pbrt *p, const struct err *failure);

#endif

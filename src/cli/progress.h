#ifndef ETALON_CLI_PROGRESS_H
#define ETALON_CLI_PROGRESS_H

/* One line on a terminal, redrawn in place; nothing elsewhere. */

#include "integrator/run.h"

bool progress_wanted(void); /* stderr is a terminal */
void progress_show(const struct run_progress *progress);
void progress_clear(void);

#endif

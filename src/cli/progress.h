#ifndef ETALON_CLI_PROGRESS_H
#define ETALON_CLI_PROGRESS_H

/* One line on a terminal, redrawn in place; nothing elsewhere. */

#include "run/run.h"

bool progress_wanted(void); /* stderr is a terminal */
void progress_show(const struct run_progress *progress);
/* Shows the loading of a scene: files done of `count`; 0: no number. */
void progress_show_load(const char *what, long done, long count);
void progress_clear(void);

#endif

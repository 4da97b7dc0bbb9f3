#ifndef ETALON_CLI_BENCH_TELL_H
#define ETALON_CLI_BENCH_TELL_H

/* What a batch says while it runs. */

#include "lab/runner.h"

/* Sets the hooks of a batch. terminal: a progress line is shown and must be cleared
 * before a line is printed. */
void bench_tell(struct runner_options *options, bool *terminal);

#endif

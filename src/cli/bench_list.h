#ifndef ETALON_CLI_BENCH_LIST_H
#define ETALON_CLI_BENCH_LIST_H

/* etalon bench --list: the jobs, whether they are done, and the expected time of the
 * others. */

#include "lab/jobs.h"

/* Lists the jobs that `only` matches; NULL: all. `folder`: the results. */
bool bench_list(const struct jobs *jobs, const char *folder, const char *only,
                struct err *err);

/* "1:02:03 h", "2:03 min", or "4.5 s"; to be freed. */
char *bench_duration(double seconds);

#endif

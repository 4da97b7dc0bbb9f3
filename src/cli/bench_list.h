#ifndef ETALON_CLI_BENCH_LIST_H
#define ETALON_CLI_BENCH_LIST_H

/* etalon bench --list: the jobs, which are done, and what the others will take. */

#include "lab/jobs.h"

/* Of those that `only` matches; NULL: all. What is done stands in the folder. */
bool bench_list(const struct jobs *jobs, const char *folder, const char *only,
                struct err *err);

/* "1:02:03 h", "2:03 min", or "4.5 s"; to be freed. */
char *bench_duration(double seconds);

#endif

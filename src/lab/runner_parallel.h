#ifndef ETALON_LAB_RUNNER_PARALLEL_H
#define ETALON_LAB_RUNNER_PARALLEL_H

#include "lab/batch.h"

/* Runs the jobs to do in options->workers worker processes. */
bool runner_parallel(struct batch *batch, struct err *err);

#endif

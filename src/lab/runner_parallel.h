#ifndef ETALON_LAB_RUNNER_PARALLEL_H
#define ETALON_LAB_RUNNER_PARALLEL_H

#include "lab/batch.h"

/* The jobs that are to do, by options->workers workers. */
bool runner_parallel(struct batch *batch, struct err *err);

#endif

#ifndef ETALON_LAB_RUNNER_CREW_H
#define ETALON_LAB_RUNNER_CREW_H

#include "lab/batch.h"

/* The jobs that are to do, by options->workers workers. */
bool runner_crew(struct batch *batch, struct err *err);

#endif

#ifndef ETALON_RUN_RUN_PACK_H
#define ETALON_RUN_RUN_PACK_H

/* A run to a checkpoint and from one. */

#include "run/run_state.h"

/* Writes one if it is due, or the run is over. */
bool run_serve_checkpoint(struct run *run, bool last, struct err *err);
bool run_write_checkpoint(struct run *run, bool last, struct err *err);
/* The state of a run, to a checkpoint or from one. */
void run_pack(struct run *run, struct pack *pack);
/* Reads the state from the file of the run's options, and closes it. */
bool run_resume(struct run *run, struct err *err);

#endif

#ifndef ETALON_RUN_RUN_PACK_H
#define ETALON_RUN_RUN_PACK_H

/* A run to a checkpoint and from one. */

#include "run/run_state.h"

/* Writes one if it is due, or the run is over. */
bool run_serve_checkpoint(struct run *run, bool last, struct err *err);
bool run_write_checkpoint(struct run *run, bool last, struct err *err);
/* The state of a run, to a checkpoint or from one. */
void run_pack(struct run *run, struct pack *pack);
/* Adds the state of a part to that of the run, and closes the pack. */
bool run_add_part(struct run *run, struct pack *pack, struct run_part part,
                  struct err *err);
/* After all: which of `all` parts were added. */
void run_complete_parts(struct run *run, const bool *present, int all);
/* Reads the state from the file of the run's options, and closes it. */
bool run_resume(struct run *run, struct err *err);

#endif

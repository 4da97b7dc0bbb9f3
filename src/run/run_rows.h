#ifndef ETALON_RUN_RUN_ROWS_H
#define ETALON_RUN_RUN_ROWS_H

/* The error log of a run: its picture against a reference, now and then. */

#include "run/run_state.h"

/* Measures the picture and reports a row, unless there is one of this time; false stops
 * the run. */
bool run_error_row(struct run *run, struct err *err);
/* When the next row is due. */
void run_plan_row(struct run *run);
/* All rows so far, to a checkpoint or from one; those that are read are reported. False
 * if the hook refused one. */
bool run_rows_pack(struct run *run, struct pack *pack, bool write);

#endif

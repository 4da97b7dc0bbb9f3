#ifndef ETALON_LAB_PARTS_H
#define ETALON_LAB_PARTS_H

/* Results of single jobs, each a store of its own in RESULTS/parts/JOB, so that any
 * number of processes, on any machine that sees the folder, can work side by side; a
 * batch joins them into RESULTS. A part is finished when its row is in its table. */

#include "lab/job_context.h"

/* outcome: filled if it is; may be NULL. */
bool part_is_finished(const char *results, const struct job *job,
                      struct outcome *outcome);

/* Runs the job unless the part is finished. A second process that wants the same waits
 * for the first. False on failure, or, with err->code ERR_NONE, if it was stopped. */
bool part_run(struct job_context *context, const char *results, const struct job *job,
              struct outcome *outcome, struct err *err);

/* Moves a finished part into the store of the results. */
bool part_join(struct store *store, const char *results, const struct job *job,
               struct err *err);

/* Removes what is left of the part of a job that has its row in the results. */
void part_drop(const char *results, const struct job *job);

/* Removes the folder of the parts if there is none any more. */
void parts_tidy(const char *results);

#endif

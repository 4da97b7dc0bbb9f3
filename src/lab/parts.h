#ifndef ETALON_LAB_PARTS_H
#define ETALON_LAB_PARTS_H

/* Results of single jobs, each a store of its own in RESULTS/parts/JOB, so that any
 * number of processes, on any machine that sees the folder, can work side by side; a
 * batch joins them into RESULTS. A part is finished when its row is in its table. */

#include "lab/job_context.h"

/* outcome: filled if the part is finished; may be NULL. */
bool part_is_finished(const char *results, const struct job *job,
                      struct outcome *outcome);

/* Runs the job unless its part is finished. A second process with the same job waits for
 * the first. False on failure; false with err->code ERR_NONE if it was stopped. */
bool part_run(struct job_context *context, const char *results, const struct job *job,
              struct outcome *outcome, struct err *err);

/* Moves a finished part into the store of the results. */
bool part_join(struct store *store, const char *results, const struct job *job,
               struct err *err);

/* Removes the remains of a part whose job has its row in the results. */
void part_drop(const char *results, const struct job *job);

/* Removes the folder of parts if it is empty. */
void parts_tidy(const char *results);

#endif

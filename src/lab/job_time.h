#ifndef ETALON_LAB_JOB_TIME_H
#define ETALON_LAB_JOB_TIME_H

/* Expected time of rendering of a job, s. Under a time budget that budget; else, from the
 * finished jobs of the same scene and label in `runs` (may be NULL), their mean time per
 * mutation per pixel times the job's budget. NAN if unknown. */

#include "lab/csv.h"
#include "lab/jobs.h"

double job_time_expected(const struct job *job, const struct csv *runs);

/* Time that a finished job took, s; NAN if it has no row. */
double job_time_spent(const struct job *job, const struct csv *runs);

#endif

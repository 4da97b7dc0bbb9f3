#ifndef ETALON_LAB_JOB_TIME_H
#define ETALON_LAB_JOB_TIME_H

/* How long a job will render, s: its budget if that is a time; else, from the finished
 * jobs of the same scene and label in `runs` (which may be NULL), their mean time a
 * mutation per pixel times its own; NAN if there is nothing to tell from. */

#include "lab/csv.h"
#include "lab/jobs.h"

double job_time_expected(const struct job *job, const struct csv *runs);

/* What a finished job took, s; NAN if it has no row. */
double job_time_spent(const struct job *job, const struct csv *runs);

#endif

#ifndef ETALON_CLI_SUMMARY_H
#define ETALON_CLI_SUMMARY_H

/* Prints the summary of a run. */

#include "image/metric.h"
#include "lab/statistics.h"

#include <stdio.h>

/* metric: against the reference, or NULL. */
void summary_print(const struct statistics_record *record, const struct metric *metric,
                   FILE *out);

#endif

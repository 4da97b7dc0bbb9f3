#ifndef ETALON_CLI_REGRESS_TEXT_H
#define ETALON_CLI_REGRESS_TEXT_H

/* Prints a comparison with a baseline. */

#include "analysis/regress.h"

#include <stdio.h>

/* The origin of one side: experiment, commit, number of seeds per cell. */
void regress_print_origin(const char *side, const struct cells *cells, FILE *out);

/* Prints what moved (with `all`: every row), the detectable change by statistic, and the
 * verdict. */
void regress_print(const struct regress *regress, double level, bool all, FILE *out);

#endif

#ifndef ETALON_CLI_REGRESS_TEXT_H
#define ETALON_CLI_REGRESS_TEXT_H

/* A comparison with a baseline as people read it. */

#include "analysis/regress.h"

#include <stdio.h>

/* Where a side comes from: experiment, commit, how many seeds a cell. */
void regress_print_origin(const char *side, const struct cells *cells, FILE *out);

/* What moved (or, with `all`, every row), then how large a change could have been seen,
 * by statistic, then the verdict. */
void regress_print(const struct regress *regress, double level, bool all, FILE *out);

#endif

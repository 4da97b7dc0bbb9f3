#ifndef ETALON_CLI_CURVE_TEXT_H
#define ETALON_CLI_CURVE_TEXT_H

/* The curve of predicted errors in a terminal (rule tours). */

#include "integrator/integrator.h"

#include <stdio.h>

/* Prints a table with a bar for every p_l, as lines of YAML comments; nothing without a
 * curve. */
void curve_print(const struct run_statistics *s, FILE *out);

#endif

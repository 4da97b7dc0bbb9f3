#ifndef ETALON_CLI_CURVE_TEXT_H
#define ETALON_CLI_CURVE_TEXT_H

/* The curve of predicted errors in a terminal (rule tours). */

#include "integrator/integrator.h"

#include <stdio.h>

/* Prints a table, a plot with the chosen and the published p_l, the interval, and the
 * reason in words, all as lines of YAML comments. Without a curve only the two p_l and
 * the reason; nothing if p_l is not automatic. */
void curve_print(const struct run_statistics *s, FILE *out);

#endif

#ifndef ETALON_LAB_SCALAR_H
#define ETALON_LAB_SCALAR_H

/* Single values as text that YAML readers understand and that reads back as the same
 * value. */

#include "base/text.h"

/* The shortest decimal that reads back as the same double; ".nan", ".inf", "-.inf". An
 * exponent always follows a point (1.0e+20): without it YAML 1.1 sees a string. */
void scalar_append_number(struct text *text, double value);

/* Appends a YAML scalar: plain if it cannot be mistaken for another type, else in double
 * quotes. */
void scalar_append_string(struct text *text, const char *value);

#endif

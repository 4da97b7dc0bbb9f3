#ifndef ETALON_IMPORT_NUMBER_H
#define ETALON_IMPORT_NUMBER_H

/* Numbers in scene files: decimal, no nan, inf or hexadecimal, whatever the locale. */

/* Reads the longest number at s; the text must be followed by a byte that no number
 * contains (a terminating zero will do). Returns the first byte after it, NULL if there
 * is none. The value is correctly rounded; it is infinite beyond the range of double. */
const char *number_parse(const char *s, double *value);

/* The first byte after what C libraries print for a number that is not finite (nan, -inf,
 * nan(ind), 1.#QNAN), in upper or lower case; NULL if s begins otherwise. */
const char *number_skip_nonfinite(const char *s);

#endif

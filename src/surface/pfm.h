#ifndef ETALON_SURFACE_PFM_H
#define ETALON_SURFACE_PFM_H

/* Portable float maps: "PF" (colour) or "Pf" (grey), width and height, a
 * scale whose sign is the byte order (negative: little-endian) and whose size multiplies
 * the values; then rows of floats, the bottom one first. */

#include "base/err.h"

#include <stdbool.h>
#include <stddef.h>

bool pfm_is(const unsigned char *data, size_t size);

/* [height][width][3] from the top, owned by the caller. NULL, with *why, if the file is
 * damaged or larger than `most` pixels across. data is zero-terminated. */
float *pfm_read(const char *data, size_t size, int most, int *width, int *height,
                const char **why);

#endif

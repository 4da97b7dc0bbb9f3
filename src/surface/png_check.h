#ifndef ETALON_SURFACE_PNG_CHECK_H
#define ETALON_SURFACE_PNG_CHECK_H

/* Verifies the checksums of a PNG file, which stb_image ignores: it would decode a file
 * with a flipped bit to a wrong picture without an error. */

#include <stddef.h>

/* The defect of the file in words; NULL if there is none, or if it is no PNG. */
const char *png_check(const unsigned char *data, size_t size);

/* Bits a pixel has in the file (1 to 64) as its header says; 0 if it is no PNG. */
int png_bits(const unsigned char *data, size_t size);

#endif

#ifndef ETALON_SURFACE_PNG_CHECK_H
#define ETALON_SURFACE_PNG_CHECK_H

/* The checksums of a PNG file, which stb_image passes over: with a bit flipped it would
 * make another picture and say nothing. */

#include <stddef.h>

/* What is wrong with the file, in words; NULL if nothing is, or it is no PNG. */
const char *png_check(const unsigned char *data, size_t size);

/* Bits a pixel has in the file (1 to 64) as its header says; 0 if it is no PNG. */
int png_bits(const unsigned char *data, size_t size);

#endif

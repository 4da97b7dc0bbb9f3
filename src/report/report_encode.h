#ifndef ETALON_REPORT_REPORT_ENCODE_H
#define ETALON_REPORT_REPORT_ENCODE_H

/* Pictures for the page, as report_pictures.js reads them: half floats of
 * value / 2^exponent, where the largest lies in [2^14, 2^15), so that nothing is clipped
 * and 11 bits are kept down to 2^-29 of it; less the last `shift` of them, by rounding.
 * Of the bits of R, G, B as integers: G, R - G and B - G (the logarithms of ratios,
 * nearly: channels share most of their noise), less the mean of the left and the upper
 * neighbour, as zigzag numbers; low and high bytes of the three apart [6][height][width];
 * zlib; base64. */

#include "base/text.h"
#include "image/image.h"

/* Appends the base64 text; *exponent is as above. */
void report_encode(const struct image *image, int shift, struct text *base64,
                   int *exponent);

/* Appends the bytes as base64. */
void report_append_base64(struct text *text, const unsigned char *bytes, size_t size);

/* Mean over blocks of factor x factor pixels; what does not fill a block is left out. At
 * least one pixel remains. The caller owns it. */
struct image *report_reduce(const struct image *image, int factor);

#endif

#ifndef ETALON_IMAGE_PREVIEW_H
#define ETALON_IMAGE_PREVIEW_H

#include "base/err.h"
#include "base/text.h"
#include "image/image.h"

/* 8-bit sRGB PNG, by a temporary name. exposure in stops: times 2^exposure, clipped at 1;
 * NAN picks it from the picture (log-average to middle grey) and rolls highlights off. */
bool preview_write_png(const char *path, const struct image *image, double exposure,
                       struct err *err);

/* The same, appended to *png; false if there is no memory for it. */
bool preview_append_png(struct text *png, const struct image *image, double exposure);

/* The factor that takes the log-average of the pixels that are not black to middle grey.
 */
double preview_scale(const struct image *image);

#endif

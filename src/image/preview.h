#ifndef ETALON_IMAGE_PREVIEW_H
#define ETALON_IMAGE_PREVIEW_H

#include "base/err.h"
#include "image/image.h"

/* 8-bit sRGB PNG; exposure in stops; NAN picks one from the picture (log-average to
 * middle grey, highlights rolled off). */
bool preview_write_png(const char *path, const struct image *image, double exposure,
                       struct err *err);

#endif

#ifndef ETALON_IMAGE_EXR_H
#define ETALON_IMAGE_EXR_H

/* OpenEXR files (the only user of the library). */

#include "base/err.h"
#include "image/image.h"

/* String attributes: the provenance of the picture, in the file itself. */
struct exr_attribute {
    const char *name, *value;
};

/* More channels beside R, G, B: "failure.Y" and the like; [height][width] float. */
struct exr_layer {
    const char *name;
    const float *values;
};

/* RGB float, ZIP; written to a temporary name and renamed. */
bool exr_write(const char *path, const struct image *image,
               const struct exr_attribute *attributes, int attribute_count,
               const struct exr_layer *layers, int layer_count, struct err *err);

/* Any scanline or tiled single-part file with R, G, B (or Y) in half or float; NULL on
 * failure. Data windows smaller than the display window are cropped to the data. */
struct image *exr_read(const char *path, const struct place *at, struct err *err);

/* Value of a string attribute (owned by the caller) or NULL. */
char *exr_read_attribute(const char *path, const char *name);

#endif

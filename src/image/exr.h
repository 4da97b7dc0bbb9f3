#ifndef ETALON_IMAGE_EXR_H
#define ETALON_IMAGE_EXR_H

/* OpenEXR files (the only user of the library). */

#include "base/err.h"
#include "image/image.h"
#include "image/layers.h"

/* String attributes: the provenance of the picture, in the file itself. */
struct exr_attribute {
    const char *name, *value;
};

/* RGB float, ZIP; written to a temporary name and renamed. The data window is the place
 * of the picture on its whole film, which is the display window. Layers (NULL: none) are
 * more channels beside R, G, B. */
bool exr_write(const char *path, const struct image *image,
               const struct exr_attribute *attributes, int attribute_count,
               const struct layers *layers, struct err *err);

/* Any scanline or tiled single-part file in half or float: R, G, B or Y, else those of
 * the first layer that has them ("diffuse.R"), else the only channel as grey; NULL on
 * failure. A picture that fills a part of the display window knows its place there. */
struct image *exr_read(const char *path, const struct place *at, struct err *err);

/* Such a file, to read its layers one after the other. NULL, without an error, if it
 * cannot be read. The path must live as long. */
struct exr_file;
struct exr_file *exr_open(const char *path);
void exr_close(struct exr_file *file); /* NULL: nothing */
/* A layer: its channels R, G, B, or X, Y, Z, or its only one Y or Z as grey ("albedo",
 * "failures", "depth"). NULL, without an error, if there is none. */
struct image *exr_layer(const struct exr_file *file, const char *layer);

/* Value of a string attribute (owned by the caller) or NULL. */
char *exr_read_attribute(const char *path, const char *name);

#endif

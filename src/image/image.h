#ifndef ETALON_IMAGE_IMAGE_H
#define ETALON_IMAGE_IMAGE_H

/* A picture: float RGB, linear Rec. 709, radiance, row 0 at the top. */

#include "math/rgb.h"

#include <stddef.h>

struct image {
    int width, height;
    float *pixels; /* [height][width][3] */
    /* Where a picture that was cropped lies on the whole film, and the size of that; 0, 0
     * and the picture's own else. */
    int x, y, whole_width, whole_height;
};

struct image *image_create(int width, int height); /* black */
/* Black, of the same size and place. */
struct image *image_create_like(const struct image *image);
struct image *image_copy(const struct image *image);
void image_destroy(struct image *image);
static inline float *image_at(const struct image *image, int x, int y)
{
    return image->pixels + 3 * ((size_t)y * (size_t)image->width + (size_t)x);
}
/* The pixel of that number, row by row. */
static inline struct rgb image_pixel(const struct image *image, long pixel)
{
    const float *p = image->pixels + 3 * pixel;
    return rgb((double)p[0], (double)p[1], (double)p[2]);
}
/* Pixels of which not every value is finite. */
long image_nonfinite(const struct image *image);
/* Mean of blocks of factor x factor pixels; the size must divide. NULL if not. */
struct image *image_reduce(const struct image *image, int factor);
/* (a+b)/2, as of two halves of a longer render; the sizes must be equal. */
struct image *image_mean(const struct image *a, const struct image *b);

#endif

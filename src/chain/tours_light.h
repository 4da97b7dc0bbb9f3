#ifndef ETALON_CHAIN_TOURS_LIGHT_H
#define ETALON_CHAIN_TOURS_LIGHT_H

/* The weights of pixels for chain/tours.h, from the picture that the tapes contain, in
 * tiles of pixels. See tours_light.c. */

#include "chain/tours.h"

struct tours_light;

struct tours_light *tours_light_create(int width, int height);
void tours_light_destroy(struct tours_light *light); /* NULL is legal */
double tours_light_bytes(int width, int height);

/* Adds the tape's splats by their expected values, times `factor`; factor = N b / M gives
 * the mean of M mutations, in the units of b. */
void tours_light_add(struct tours_light *light, const struct tape *tape,
                     const struct tours_target *target, double factor);
/* Adds a sample of one pixel. */
void tours_light_add_pixel(struct tours_light *light, int32_t pixel, double luminance);

/* Sets the weights, once all is added. floor: e of relMSE, in squared units of the
 * picture. Returns the picture's mean. */
double tours_light_weigh(struct tours_light *light, double floor);
/* Valid until the light is destroyed. */
struct tours_pixels tours_light_pixels(const struct tours_light *light);
/* Sum over pixels of tours_pixels.mean^2. */
double tours_light_square(const struct tours_light *light);

#endif

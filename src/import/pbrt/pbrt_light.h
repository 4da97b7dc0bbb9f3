#ifndef ETALON_IMPORT_PBRT_LIGHT_H
#define ETALON_IMPORT_PBRT_LIGHT_H

/* What the readers of LightSource have in common. */

#include "import/pbrt/pbrt_state.h"
#include "scene/light.h"

/* v4: the power or the illuminance of that name, if it is given, replaces what the light
 * has by its spectrum scaled to luminance 1, `unscaled`; rgb and scale stay factors. */
bool pbrt_light_measure(struct pbrt *p, const char *name, double unscaled,
                        struct rgb *value, struct err *err);
/* Reads the scale and adds the light, unless it is black. */
bool pbrt_light_add(struct pbrt *p, struct light_desc *light, struct err *err);

/* The picture that a parameter names. *image is NULL without an error where there is no
 * file: a constant stands for it. */
bool pbrt_light_picture(struct pbrt *p, const struct pbrt_param *name,
                        const struct texture_image **image, struct err *err);

/* LightSource "infinite" (pbrt_light_infinite.c). */
bool pbrt_light_infinite(struct pbrt *p, struct err *err);

#endif

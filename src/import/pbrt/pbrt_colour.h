#ifndef ETALON_IMPORT_PBRT_COLOUR_H
#define ETALON_IMPORT_PBRT_COLOUR_H

/* Colours and numbers that pbrt lets a texture or a spectrum stand for. */

#include "import/pbrt/pbrt_state.h"

/* A colour (or a number, in all three), or what gives it at every point. */
struct pbrt_value {
    struct rgb value;
    const struct texture *texture; /* NULL: the same everywhere */
};

/* Each leaves its value untouched if the parameter is absent; negative components are
 * clamped and counted. */
bool pbrt_colour_value(struct pbrt *p, const char *name, struct pbrt_value *value,
                       struct err *err);
bool pbrt_colour_float_value(struct pbrt *p, const char *name, struct pbrt_value *value,
                             struct err *err);
/* A single value; a varying texture gives its value at the middle, which is noted. */
bool pbrt_colour(struct pbrt *p, const char *name, struct rgb *value, struct err *err);
/* What a light sends: v4 scales spectra and black bodies to luminance 1. */
bool pbrt_colour_light(struct pbrt *p, const char *name, struct rgb *value,
                       struct err *err);
/* The same for a float or a float texture; *found may be NULL. */
bool pbrt_colour_float(struct pbrt *p, const char *name, double *value, bool *found,
                       struct err *err);
/* The texture of a value, made if it is a constant. */
const struct texture *pbrt_colour_node(struct pbrt *p, const struct pbrt_value *value);
/* The directive Texture, its head and list parsed (pbrt_texture.c). */
bool pbrt_colour_texture(struct pbrt *p, struct err *err);

#endif

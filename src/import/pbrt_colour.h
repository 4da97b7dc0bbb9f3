#ifndef ETALON_IMPORT_PBRT_COLOUR_H
#define ETALON_IMPORT_PBRT_COLOUR_H

/* Colours and numbers that pbrt lets a texture or a spectrum stand for. */

#include "import/pbrt_state.h"

/* *value is untouched if the parameter is absent; negative components are clamped and
 * counted. Constant textures only. */
bool pbrt_colour(struct pbrt *p, const char *name, struct rgb *value, struct err *err);
/* The same for a float or a float texture; *found may be NULL. */
bool pbrt_colour_float(struct pbrt *p, const char *name, double *value, bool *found,
                       struct err *err);
/* The directive Texture, its head and list parsed. */
bool pbrt_colour_texture(struct pbrt *p, struct err *err);

#endif

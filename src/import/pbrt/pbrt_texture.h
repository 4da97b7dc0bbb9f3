#ifndef ETALON_IMPORT_PBRT_TEXTURE_H
#define ETALON_IMPORT_PBRT_TEXTURE_H

/* The classes of Texture. */

#include "import/pbrt/pbrt_colour.h"

/* A parameter of the texture's own kind, number or colour. */
bool pbrt_texture_part(struct pbrt *p, const char *name, bool is_float, double fallback,
                       struct pbrt_value *value, struct err *err);
/* uscale, vscale, udelta, vdelta. */
bool pbrt_texture_mapping(struct pbrt *p, struct texture *texture, struct err *err);
/* The texture's own space: the one in which it was named, and LuxRender's scale, rotate
 * and translate. */
bool pbrt_texture_space(struct pbrt *p, struct texture *texture, struct err *err);

/* Those that take noise (pbrt_texture_solid.c). */
bool pbrt_texture_dots(struct pbrt *p, bool is_float, struct pbrt_value *out,
                       struct err *err);
bool pbrt_texture_fbm(struct pbrt *p, bool is_float, struct pbrt_value *out,
                      struct err *err);
bool pbrt_texture_wrinkled(struct pbrt *p, bool is_float, struct pbrt_value *out,
                           struct err *err);
bool pbrt_texture_windy(struct pbrt *p, bool is_float, struct pbrt_value *out,
                        struct err *err);
bool pbrt_texture_marble(struct pbrt *p, bool is_float, struct pbrt_value *out,
                         struct err *err);

#endif

#ifndef ETALON_IMPORT_MITSUBA_TEXTURE_H
#define ETALON_IMPORT_MITSUBA_TEXTURE_H

/* Textures, and properties that may be a colour or a texture. */

#include "import/mitsuba/mitsuba_object.h"

bool mitsuba_texture(struct mitsuba *m, struct mitsuba_node *object,
                     const struct texture **out, struct err *err);
struct rgb mitsuba_texture_mean(struct mitsuba *m, const struct mitsuba_node *object,
                                const struct texture *texture);
/* The picture that an object names. NULL without an error: there is none, as a note says.
 */
const struct texture_image *mitsuba_picture(struct mitsuba *m,
                                            struct mitsuba_node *object, struct err *err);

/* A colour (mitsuba_rgb.h), or a texture. */
struct mitsuba_value {
    const struct texture *texture; /* or NULL: */
    struct rgb value;
};
/* *value is untouched if there is no property of that name. */
bool mitsuba_value(struct mitsuba *m, struct mitsuba_node *object, const char *name,
                   struct mitsuba_value *value, struct err *err);
/* A colour that cannot vary: the mean of a texture, with a note. */
bool mitsuba_colour(struct mitsuba *m, struct mitsuba_node *object, const char *name,
                    struct rgb *value, struct err *err);

#endif

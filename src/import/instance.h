#ifndef ETALON_IMPORT_INSTANCE_H
#define ETALON_IMPORT_INSTANCE_H

/* A part of an object once more, elsewhere. Each is a copy: lights, ids and rays know
 * shapes only, no instances. */

#include "scene/scene_desc.h"

/* Adds the part, which stays the caller's, under the transform. Outside stays outside
 * where that mirrors. */
void instance_place(struct scene_desc *desc, const struct shape_desc *part,
                    const struct xform *to_world, const struct place *at);

#endif

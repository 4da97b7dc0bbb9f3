#ifndef ETALON_SCENE_EMISSION_H
#define ETALON_SCENE_EMISSION_H

/* Lamps whose radiance a texture gives over the shape's parameters. The parameters follow
 * from the place alone, so that lights need no more than points of them: a quadric has
 * formulas, and a mesh has one affine map of space, or is taken apart into triangles that
 * have one each. A lamp is chosen by its mean radiance, a point on it uniformly. */

#include "scene/light.h"
#include "scene/scene_desc.h"

/* More triangles are not taken apart: the mean of the texture shines everywhere, which is
 * noted. */
#define EMISSION_TRIANGLES 4096

/* Takes apart the lamps that want it; before the shapes are built. */
void emission_split(struct scene_desc *desc);

/* The largest component that the texture has over the unit square, by points of a grid.
 */
double emission_max(const struct texture *texture);

/* Sets light->map for the built shape; returns the mean of the texture over the shape's
 * area, by points of a grid. */
struct rgb emission_build(const struct scene *scene, struct light *light,
                          const struct texture *texture);

/* Value of the texture at a point of the lamp. */
struct rgb emission_value(const struct light *light, const struct ray_endpoint *point);

#endif

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

/* Takes apart the lamps that want it, and finds the peak of each one's texture; before
 * the shapes are built. */
void emission_split(struct scene_desc *desc);

/* Sets light->map for the built shape; returns the mean of the texture over the shape's
 * area, by points that are no farther apart than its texels. Where these would be too
 * many, the mean is no less than a small share of the peak, lest a lamp be lost. */
struct rgb emission_build(const struct scene *scene, struct light *light,
                          const struct texture *texture, double peak);

/* Value of the texture at a point of the lamp. */
struct rgb emission_value(const struct light *light, const struct ray_endpoint *point);

#endif

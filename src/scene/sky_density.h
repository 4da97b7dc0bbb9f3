#ifndef ETALON_SCENE_SKY_DENSITY_H
#define ETALON_SCENE_SKY_DENSITY_H

/* A density of directions for light from a picture of the sphere. It follows the
 * picture's luminance over equal areas of the unfolded octahedron [Clarberg08], whatever
 * the picture's own layout, and its resolution need not be the picture's: there is a
 * density wherever the picture shines, known exactly, and that is all that estimates ask
 * of it. It is finest, 8192 cells along an axis, where the picture is brightest, as a sun
 * is.
 *
 * MIS compensation [Karlik19]: the mean over the sphere is subtracted from the density,
 * as directions of about that brightness are sampled well by camera paths that leave the
 * scene (s = 0), and MIS leaves these directions to them. As no direction is a delta,
 * every such path can be sampled with s = 0, so even a density of 0 where the map is
 * dimmer than its mean would be unbiased. But a share of the luminance is kept as the
 * least density, so that light paths start in all directions that shine. A sampled
 * direction that is rounded to floats may lie in a neighbouring cell, which can be black
 * and then has a density of 0: whoever divides by sky_density_pdf asks for that first. */

#include "math/dist_tree.h"
#include "scene/sky_map.h"

/* Returns the integral of the luminance of the picture times the tint over the sphere; 0
 * if it is black, and then there is no density. */
double sky_density_build(struct dist_tree *density, const struct sky_map *map,
                         struct rgb tint);
/* d: a unit vector in the map's space. */
void sky_density_sample(const struct dist_tree *density, const double u[2], double d[3]);
/* u with which sky_density_sample gives d. False if none does. */
bool sky_density_invert(const struct dist_tree *density, const double d[3], double u[2]);
/* Per solid angle. */
double sky_density_pdf(const struct dist_tree *density, const double d[3]);

#endif

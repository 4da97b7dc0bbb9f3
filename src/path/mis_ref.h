#ifndef ETALON_PATH_MIS_REF_H
#define ETALON_PATH_MIS_REF_H

/* The balance heuristic by its definition: the density of the whole path under every
 * technique, summed. Slow; the oracle of tests [Veach97 Eqs. 9.8 and 10.9]. */

#include "path/vertex.h"

/* Whether that path's densities are known beyond rounding. They are not where an edge
 * grazes a surface at its end (cosine below 2e-3, or times the length below 200 times the
 * error of the places), and where the edge, turned by 4e-6, passes other surfaces: at the
 * rim of one, or where the opacity of a mask steps. */
bool mis_ref_sure(const struct scene *scene, const struct vertex *light, int s,
                  const struct vertex *camera, int t);

/* Weight of technique (s,t) for the path light[0..s-1], camera[t-1..0]. A light met by
 * the camera sub-path (s = 0) is camera[t-1].light. */
double mis_ref_weight(const struct scene *scene, const struct vertex *light, int s,
                      const struct vertex *camera, int t);

/* Value (unweighted) of that path by definition: its measurement contribution [Veach97
 * Eq. 8.7] along the camera's direction, where no adjoint enters, over its density. For
 * paths without delta events; black where shading and geometric normals disagree. */
struct rgb mis_ref_value(const struct scene *scene, const struct vertex *light, int s,
                         const struct vertex *camera, int t);

#endif

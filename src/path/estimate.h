#ifndef ETALON_PATH_ESTIMATE_H
#define ETALON_PATH_ESTIMATE_H

/* Path estimators: numbers in, contribution out. The mean of the contribution over
 * uniform numbers is the picture (image/contrib.h). */

#include "image/contrib.h"
#include "path/walk.h"

/* Path tracing with next-event estimation, both weighted by the balance heuristic. One
 * splat; no use of paths->camera beyond its first vertex. */
void estimate_pt(struct subpaths *paths, const struct numbers *numbers,
                 struct contrib *out);

/* All techniques (s,t) but (1,1). One splat for t >= 2 and one for each light vertex that
 * the camera sees. */
void estimate_bdpt(struct subpaths *paths, const struct numbers *numbers,
                   struct contrib *out);

/* The same with one splat per technique, for tests. */
void estimate_bdpt_techniques(struct subpaths *paths, const struct numbers *numbers,
                              struct contrib *out);

/* Splats that a contribution must hold for paths of at most max_depth edges. */
int estimate_splats(int max_depth);
int estimate_splats_techniques(int max_depth);

#endif

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

/* From then on estimate_bdpt spends about `rays` shadow rays on a sample rather than one
 * on every connection (path/estimate_roulette.h). Once, after subpaths_init. */
void estimate_bdpt_roulette(struct subpaths *paths, double rays);
/* Memory that this takes. */
double estimate_roulette_bytes(int max_depth);

/* The same with one splat per technique, for tests, splits and layers. It fills
 * out->weights where there are some. */
void estimate_bdpt_techniques(struct subpaths *paths, const struct numbers *numbers,
                              struct contrib *out);
/* With one splat per technique too, and the target of the estimate that does not keep
 * them apart: equal to the bit, as it is summed in the same order. */
void estimate_pt_layers(struct subpaths *paths, const struct numbers *numbers,
                        struct contrib *out);
void estimate_bdpt_layers(struct subpaths *paths, const struct numbers *numbers,
                          struct contrib *out);

/* The techniques of one path length that a scene can use, by their number t of camera
 * vertices: 1 (light image), 2..k (connections), k+1 (a light hit by chance). */
struct techniques {
    int length;                    /* k, edges */
    int count;                     /* 0: the scene has no path of this length */
    uint8_t t[DIMS_MAX_DEPTH + 1]; /* [count]; s = length + 1 - t */
};
void techniques_init(struct techniques *techniques, const struct needs *needs,
                     int length);

/* One path by the technique (s,t): grows and joins its sub-paths, which paths->camera and
 * ->light then hold; *point receives the light vertex for s = 1. Stops where the path
 * cannot be completed any more. */
struct connection;
enum failure estimate_technique(struct subpaths *paths, const struct numbers *numbers,
                                int s, int t, struct connection *out,
                                struct vertex *point);

/* One path of that length by one technique, which the first number of the connect stream
 * picks; its weighted contribution times the number of techniques [Hachisuka14]. One
 * splat, or the reason for none: it stops where the path cannot be completed any more
 * [Zeng19, Alg. 2]. paths->max_depth must be at least the length. */
void estimate_mmlt(struct subpaths *paths, const struct techniques *techniques,
                   const struct numbers *numbers, struct contrib *out);

/* The same, and keeps the path: the sub-paths' vertices, a light point (s = 1) being
 * paths->light[0]. Returns the technique's t. */
int estimate_mmlt_again(struct subpaths *paths, const struct techniques *techniques,
                        const struct numbers *numbers, struct contrib *out);

/* Splats that a contribution must hold for paths of at most max_depth edges. */
int estimate_splats(int max_depth);
int estimate_splats_techniques(int max_depth);

#endif

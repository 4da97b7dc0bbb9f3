#ifndef ETALON_PATH_WHOLE_PATH_H
#define ETALON_PATH_WHOLE_PATH_H

/* A path as one list of vertices, however it was sampled, and the densities that walks
 * from both ends would give them. */

#include "path/estimate.h"

/* x[0] on the light .. x[edges] on the lens. The vertices belong to the sub-paths. */
struct whole_path {
    const struct scene *scene;
    int edges, s; /* the first s vertices are those of the light sub-path */
    const struct vertex *x[DIMS_MAX_DEPTH + 1];
    /* Of the edge x[i] x[i+1]: its direction, unit, and 1 / distance^2 (1 on an edge from
     * infinity: path/vertex.h). */
    struct vec3 w[DIMS_MAX_DEPTH];
    double inverse_square[DIMS_MAX_DEPTH];
    /* Q of it: the chance that a walk passes what it crosses (path/passage.h). */
    double pass[DIMS_MAX_DEPTH];
    /* Densities of x[i], i < edges, by area: of walks from the light and from the camera.
     */
    double from_light[DIMS_MAX_DEPTH], from_camera[DIMS_MAX_DEPTH];
};

/* The path that s light and t camera vertices of the sub-paths make, which must carry
 * light; a light point (s = 1) is paths->light[0]. False if rounding blocks an edge that
 * crosses surfaces. */
bool whole_path_collect(const struct subpaths *paths, int s, int t,
                        struct whole_path *path);

/* Chance that a walk which comes to x[i] from x[from], its neighbour, ends there rather
 * than passes. */
double whole_path_end_chance(const struct whole_path *path, int from, int i);

/* weight[techniques->count]: the balance heuristic's weights of the techniques for this
 * path [Veach97 Eq. 9.8], in the order of techniques->t. False if they are no finite
 * numbers. */
bool whole_path_weights(const struct whole_path *path,
                        const struct techniques *techniques, double *weight);

#endif

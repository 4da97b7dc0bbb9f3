#ifndef ETALON_PATH_WALK_H
#define ETALON_PATH_WALK_H

/* Grows sub-paths by sampling. */

#include "path/dims.h"
#include "path/vertex.h"

/* max_depth >= 1 edges. */
void subpaths_init(struct subpaths *paths, const struct scene *scene, int max_depth);
void subpaths_deinit(struct subpaths *paths);
/* What one takes beside the struct. */
double subpaths_bytes(const struct scene *scene, int max_depth);

/* Each fills its sub-path with at most max_vertices vertices, the lens or light point
 * included. `filter` holds for the last of max_vertices alone: a surface that it refuses
 * is left out, and paths->filtered_out tells so. */
void walk_camera(struct subpaths *paths, struct ustream *numbers, int max_vertices,
                 enum hit_filter filter);
void walk_light(struct subpaths *paths, struct ustream *numbers, int max_vertices,
                enum hit_filter filter);

#endif

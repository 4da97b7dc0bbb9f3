#ifndef ETALON_PATH_WALK_H
#define ETALON_PATH_WALK_H

/* Grows sub-paths by sampling. */

#include "path/dims.h"
#include "path/vertex.h"

/* max_depth >= 1 edges. */
void subpaths_init(struct subpaths *paths, const struct scene *scene, int max_depth);
void subpaths_deinit(struct subpaths *paths);
/* Memory besides the struct. */
double subpaths_bytes(const struct scene *scene, int max_depth);

/* Each fills its sub-path with at most max_vertices vertices, including the lens or light
 * point. `filter` applies to the last of max_vertices only: a surface that it refuses is
 * left out, and paths->filtered_out is set. */
void walk_camera(struct subpaths *paths, struct ustream *numbers, int max_vertices,
                 enum hit_filter filter);
void walk_light(struct subpaths *paths, struct ustream *numbers, int max_vertices,
                enum hit_filter filter);

#endif

#ifndef ETALON_PATH_CONNECT_H
#define ETALON_PATH_CONNECT_H

/* Joins s light vertices and t camera vertices to a path, with its MIS weight (balance
 * heuristic over all techniques of that length [Veach97, section 10.2]). Each returns
 * FAILURE_NONE, or why the path carries nothing; visibility is tested last. */

#include "image/contrib.h"
#include "path/walk.h"

struct connection {
    struct rgb value; /* contribution of the path over its density, unweighted */
    double weight;    /* balance heuristic */
    int32_t pixel;
};

/* s = 0: the camera sub-path ends at z on a light. `edges`: of the path to z. */
enum failure connect_hit(const struct subpaths *paths, const struct vertex *z, int edges,
                         struct connection *out);
/* s = 1: a new point on a light, by numbers u (pick, point). *point (may be NULL) gets
 * the light vertex. */
enum failure connect_light(const struct subpaths *paths, const double u[3],
                           const struct vertex *z, struct connection *out,
                           struct vertex *point);
/* t = 1: y seen from the lens point of the camera sub-path. */
enum failure connect_camera(const struct subpaths *paths, const struct vertex *y,
                            struct connection *out);
/* s, t >= 2. */
enum failure connect_surfaces(const struct subpaths *paths, const struct vertex *y,
                              const struct vertex *z, struct connection *out);

#endif

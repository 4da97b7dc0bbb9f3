#ifndef ETALON_PATH_MUTATION_H
#define ETALON_PATH_MUTATION_H

/* Mutations of paths [Veach97, section 11.4; CMU17]: the interface and the table, one
 * file mutation_<kind>.c each. A path's class is which of its vertices are delta (S) and
 * which are not (D), between the lens (E) and the light (L). */

#include "path/full_path.h"

/* Distances are drawn as r2 exp(-log(r2/r1) u), the direction uniformly: symmetric
 * kernels [Veach97, section 11.4.3; CMU17]. */
struct mutation_options {
    double film[2];  /* r1, r2 in pixels */
    double angle[2]; /* radians */
    bool weighted;   /* bidirectional: by w_{l,m} which vertices are deleted */
};

struct mutation {
    const char *name;
    /* Whether x can be mutated. Looks for the lobes of delta events. */
    bool (*suits)(struct path_space *space, struct full_path *x);
    /* Makes and evaluates *y, all but full_path_weigh, from x, which it suits.
     * *ratio is q(y->x)/q(x->y), transition densities per area of paths. Returns
     * FAILURE_NONE, or why f is 0: FAILURE_CAMERA_PATH and _LIGHT_PATH where the class
     * changed, or a walk left the scene. */
    enum failure (*propose)(struct path_space *space, const struct mutation_options *o,
                            const struct full_path *x, struct rng *rng,
                            struct full_path *y, struct scaled *ratio);
};

#define MUTATIONS 4
extern const struct mutation mutation_lens, mutation_caustic, mutation_multichain,
    mutation_bidirectional;
extern const struct mutation *const mutation_types[MUTATIONS];

/* --- for mutation_*.c --------------------------------------------------------------- */

/* A distance by that law; a direction at that distance (angle) from w, and an offset of
 * that length across w. */
double mutation_distance(const double range[2], double u);
struct vec3 mutation_turn(struct vec3 w, double angle, double u);
struct vec3 mutation_offset(struct vec3 w, double distance, double u);

/* Follows the ray from `from` along w, past as many surfaces as x's edge i passes, to the
 * next; makes y's edge i, and the vertex at its other end: x[i+1] if side is that of the
 * camera, from where the ray comes, else x[i]. False if the class of the edge or of that
 * vertex changes; x[edges] must be a light, and another vertex must not end the path. */
bool mutation_follow(struct path_space *space, const struct ray_endpoint *from,
                     struct vec3 w, const struct full_path *x, int i, enum side side,
                     struct full_path *y);

/* The same for a walk, which decides at each surface that it could pass whether it does:
 * y->edges is known, and a light or the outside is met at x[edges] only. */
bool mutation_walk(struct path_space *space, const struct ray_endpoint *from,
                   struct vec3 w, int i, enum side side, struct rng *rng,
                   struct full_path *y);

/* The direction (in *w) in which a path that comes from `side` along *w leaves y's delta
 * vertex i by the same kind of lobe; sets the vertex's value and densities. False if
 * there is no such lobe. */
bool mutation_lobe(struct path_space *space, struct full_path *y, int i, enum side side,
                   struct vec3 *w);

/* Whether mutation_lobe would repeat the lobe of the delta vertex i from that side. */
bool mutation_repeats(struct path_space *space, struct full_path *x, int i,
                      enum side side);

/* The density of delta vertex i's lobe, chosen with certainty from that side. */
double mutation_lobe_pdf(const struct full_path *path, int i, enum side side);

/* --- mutation_camera.c: what the lens and multi-chain perturbations share ----------- */

/* The last vertex that a perturbation from the camera moves: the first D before (D|L), or
 * the light if there is no such D. */
int mutation_camera_last(const struct full_path *path);
/* The first D, or edges. */
int mutation_camera_first(const struct full_path *path);
bool mutation_camera_suits(struct path_space *space, struct full_path *x);
enum failure mutation_camera(struct path_space *space, const struct mutation_options *o,
                             const struct full_path *x, struct rng *rng,
                             struct full_path *y, struct scaled *ratio);

/* What a walk from that side carries. */
static inline enum transport mutation_transport(enum side side)
{
    return side == SIDE_CAMERA ? TRANSPORT_RADIANCE : TRANSPORT_IMPORTANCE;
}

#endif

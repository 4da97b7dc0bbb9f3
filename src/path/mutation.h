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

/* Film positions, each uniform and independent of all that the chain has done before, so
 * that the chain knows of no strata; but the n-th positions of all chains of a run are a
 * lattice, shifted at random, and so spread evenly over the film. */
struct film_points {
    uint64_t seed, chain;
    int64_t drawn; /* n */
};
void film_points_next(struct film_points *points, double film[2]);

/* Where mutations get what they draw. */
struct mutation_random {
    struct rng *rng;
    struct film_points film; /* of lens sub-paths */
};

struct mutation {
    const char *name;
    /* Whether x can be mutated. Looks for the lobes of delta events. */
    bool (*suits)(struct path_space *space, struct full_path *x);
    /* Makes and evaluates *y, all but full_path_weigh, from x, which it suits.
     * *ratio is q(y->x)/q(x->y), transition densities per area of paths; where `density`
     * tells it, it is left. Returns FAILURE_NONE, or why f is 0: FAILURE_CLASS where the
     * class changed, FAILURE_CAMERA_PATH and _LIGHT_PATH where a walk or the film was
     * left. */
    enum failure (*propose)(struct path_space *space, const struct mutation_options *o,
                            const struct full_path *x, struct mutation_random *random,
                            struct full_path *y, struct scaled *ratio);
    /* The transition density per area to the path `to`, but for the symmetric kernels, of
     * which it is independent of the path that it comes from; NULL: it is not. */
    struct scaled (*density)(const struct full_path *to);
};

#define MUTATIONS 5
extern const struct mutation mutation_lens, mutation_caustic, mutation_multichain,
    mutation_bidirectional, mutation_lens_subpath;
extern const struct mutation *const mutation_types[MUTATIONS];

/* Proposes, with *ratio in any case. */
enum failure mutation_propose(const struct mutation *type, struct path_space *space,
                              const struct mutation_options *o, const struct full_path *x,
                              struct mutation_random *random, struct full_path *y,
                              struct scaled *ratio);

/* --- for mutation_*.c --------------------------------------------------------------- */

/* A distance by that law; a direction at that distance (angle) from w, and an offset of
 * that length across w. */
double mutation_distance(const double range[2], double u);
struct vec3 mutation_turn(struct vec3 w, double angle, double u);
struct vec3 mutation_offset(struct vec3 w, double distance, double u);

/* Follows the ray from `from` along w, past as many surfaces as x's edge i passes, to the
 * next; makes y's edge i, and the vertex at its other end: x[i+1] if side is that of the
 * camera, from where the ray comes, else x[i]. False if the class of the edge or of that
 * vertex changes; x[edges] must be a light, and another vertex must not end the path.
 * x NULL: the ray is a walk's, which decides at each surface that it could pass whether
 * it does; y->edges is known. */
bool mutation_follow(struct path_space *space, const struct ray_endpoint *from,
                     struct vec3 w, const struct full_path *x, int i, enum side side,
                     struct rng *rng, struct full_path *y);

/* What remains once y has its vertices, of which those from l to m have changed: the
 * connection of y[t-1] and y[t] (t = edges + 1: none, the light was hit), scattering,
 * emission, and visibility last. */
enum failure mutation_finish(struct path_space *space, struct full_path *y, int l, int m,
                             int t);

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

/* --- mutation_walk.c ---------------------------------------------------------------- */

/* A new lens point; the ray that leaves it through y->film, of which it sets pixel and
 * density. */
void mutation_new_lens(struct path_space *space, struct full_path *y, struct rng *rng);
struct vec3 mutation_leave_lens(struct path_space *space, struct full_path *y);
/* Samples the direction *w in which a walk from that side leaves y's vertex i, which is
 * kept from the path before, or at which the walk has ended rather than passed. */
bool mutation_leave_surface(struct path_space *space, struct full_path *y, int i,
                            enum side side, bool kept, struct rng *rng, struct vec3 *w);
/* Add vertices l + 1 to `end` by a walk from x[l], m - 1 down to `end` by one from x[m];
 * l = -1, m = edges + 1: from a new lens point, a new light point. */
bool mutation_walk_camera(struct path_space *space, struct full_path *y, int l, int end,
                          struct rng *rng);
bool mutation_walk_light(struct path_space *space, struct full_path *y, int m, int end,
                         struct rng *rng);

/* --- mutation_camera.c: what the lens and multi-chain perturbations share ----------- */

/* The last vertex that a perturbation from the camera moves: the first D before (D|L), or
 * the light if there is no such D. */
int mutation_camera_last(const struct full_path *path);
/* The first D, or edges. */
int mutation_camera_first(const struct full_path *path);
bool mutation_camera_suits(struct path_space *space, struct full_path *x);
enum failure mutation_camera(struct path_space *space, const struct mutation_options *o,
                             const struct full_path *x, struct mutation_random *random,
                             struct full_path *y, struct scaled *ratio);
struct scaled mutation_camera_density(const struct full_path *to);

/* --- mutation_bidirectional.c, for tests ----------------------------------------------
 */

/* The transition density per area from one path to another that has its vertices to l and
 * from m on, by deletion of those between. */
struct scaled mutation_bidirectional_density(const struct path_space *space,
                                             bool weighted, const struct full_path *from,
                                             int l, int m, const struct full_path *to);

/* What a walk from that side carries. */
static inline enum transport mutation_transport(enum side side)
{
    return side == SIDE_CAMERA ? TRANSPORT_RADIANCE : TRANSPORT_IMPORTANCE;
}

#endif

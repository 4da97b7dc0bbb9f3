#ifndef ETALON_PATH_FULL_PATH_H
#define ETALON_PATH_FULL_PATH_H

/* A path as an explicit list of vertices, x[0] on the lens to x[edges] on a light, and
 * what follows from the list alone, however the path was made [Veach97, chapters 8, 11]:
 *   f     its measurement contribution, per area of every vertex [Veach97 Eq. 8.7], in
 *         the camera's direction, where no adjoint enters; of the whole film, as
 *         image/contrib.h has it;
 *   p     the density of independent bidirectional sampling (full_path_sample), the sum
 *         over all techniques (s,t) [Veach97, section 10.2].
 * At a delta event both have the coefficient of the same delta for a factor. Its unit is
 * free, another one for each vertex; where f and a density of the same path are divided
 * it cancels. Ends at infinity, and surfaces that an edge passes: path/vertex.h,
 * passage.h. */

#include "image/contrib.h"
#include "math/found_numbers.h"
#include "math/scaled.h"
#include "path/edge.h"
#include "path/estimate.h"

enum side { SIDE_CAMERA, SIDE_LIGHT };

struct full_vertex {
    enum vertex_kind kind;
    bool delta;     /* the path scatters here by a delta lobe */
    bool transmits; /* ... to the other side */
    int32_t light;  /* index of the light that it is on, or -1 */
    struct hit hit; /* its bsdf: of the material, textures not evaluated */
    /* The edge to the next vertex: direction, 1/distance^2 (1 from or to infinity), and
     * T, Q and number of the surfaces that it passes. */
    struct edge edge;
    struct rgb transmittance;
    double chance;
    int crossed;
    /* Of inner vertices: f |ns . w| with w to the light; densities per solid angle of the
     * direction to the light (camera) as walks from the camera (light) sample it; |ng .
     * w| of the directions to both sides; c of path/passage.h for walks from there. */
    struct rgb value;
    double pdf_to_light, pdf_to_camera;
    double cos[2], end[2];
    /* Of a delta vertex: the chance of its lobe for walks from that side if
     * full_path_lobe finds it, else -1; 0: not yet looked for. */
    double lobe[2];
};

struct full_path {
    int edges;
    double film[2]; /* position in [0,1)^2 */
    int32_t pixel;
    double pdf_film; /* of the first edge's direction, per solid angle */
    /* At the last vertex. */
    struct rgb emission;
    double pdf_point, pdf_direction;
    struct full_vertex *x; /* [edges + 1] */
    /* By full_path_weigh: f / p, and p. */
    struct rgb ratio;
    struct scaled pdf;
};

/* Scratch of one thread, and the law of the lengths of independent paths. */
struct path_space {
    struct subpaths paths;
    struct bsdf_nodes nodes;
    int first, last; /* lengths */
    struct techniques techniques[DIMS_MAX_DEPTH + 1];
    double length_pdf[DIMS_MAX_DEPTH + 1];
    struct full_path sampled; /* the last path of full_path_sample or _remake */
    double *found[2];         /* of full_path_invert, by side */
    long rays;                /* traced since the caller cleared it */
};

/* Paths of `first` to `last` edges. */
void path_space_init(struct path_space *space, const struct scene *scene, int first,
                     int last);
void path_space_deinit(struct path_space *space);
double path_space_bytes(const struct scene *scene, int last); /* besides the struct */

/* Storage for paths of at most `most` edges. */
void full_path_init(struct full_path *path, int most);
void full_path_deinit(struct full_path *path);
/* Copies all but the vertices; those too, into storage of its own. */
void full_path_copy_ends(struct full_path *to, const struct full_path *from);
void full_path_copy(struct full_path *to, const struct full_path *from);

/* The methods below complete a path. Each returns FAILURE_NONE, or why f is 0. */

/* The edge between x[i] and x[i+1]: geometry, and for i = 0 the film position. */
enum failure full_path_edge(struct path_space *space, struct full_path *path, int i);
/* Its visibility and transmittance, both known to be needed. */
enum failure full_path_unobstructed(struct path_space *space, struct full_path *path,
                                    int i);
/* Scattering at the inner vertex x[i] between its edges; of delta events the lobe is as
 * it was, and the cosines alone are set. */
enum failure full_path_scatter(struct path_space *space, struct full_path *path, int i);
/* Emission of the last vertex along the last edge. */
enum failure full_path_emit(struct path_space *space, struct full_path *path);
/* f / p and p. */
void full_path_weigh(const struct path_space *space, struct full_path *path);

/* Densities per area of x[i] as walks from the camera (light) sample it after x[i-1]
 * (x[i+1]). */
double full_path_pdf(const struct full_path *path, int i, enum side from);
/* Factor from a density of the direction at the neighbour on that side to one per area at
 * x[i]. */
double full_path_conversion(const struct full_path *path, int i, enum side from);
/* Whether the edge between x[t-1] and x[t] can be a connection; its c of passage.h. */
double full_path_connects(const struct path_space *space, const struct full_path *path,
                          int t);

/* Sets what a delta event has, sampled from that side, where it came along wo. */
void full_path_set_delta(struct full_vertex *v, const struct bsdf_sample *s,
                         struct vec3 wo, enum side side);

/* The material of a surface vertex at its point, valid until the next call. */
const struct bsdf *full_path_bsdf(struct path_space *space, const struct hit *hit);

/* One path of independent bidirectional sampling: a length, a technique of this length,
 * all uniform (of lengths: see path_space). It becomes space->sampled, and its f / p the
 * splat. */
void full_path_sample(struct path_space *space, const struct numbers *numbers,
                      struct contrib *out);

/* A technique drawn by the balance heuristic's weights for the path; its t. So a
 * symmetric step of the technique's numbers, which makes another path of it, has
 * transition densities in the ratio of p [Bitterli18]. 0: there is none. */
int full_path_technique(const struct path_space *space, const struct full_path *path,
                        double u);
/* The numbers with which the technique of t camera vertices makes the path, in the
 * space's storage; those that it does not determine are drawn by the law that uniform
 * numbers have given the path (path/invert.h). Values below 0 are undetermined. False if
 * there are none. */
bool full_path_invert(struct path_space *space, const struct full_path *path, int t,
                      struct rng *rng, struct found *found);
/* The path of k edges that this technique makes of numbers becomes space->sampled. */
void full_path_remake(struct path_space *space, const struct numbers *numbers, int k,
                      int t, struct contrib *out);

/* The splat of a weighted path. */
void full_path_contribute(const struct full_path *path, struct contrib *out);

static inline bool full_path_delta(const struct full_path *path, int i)
{
    return i > 0 && i < path->edges && path->x[i].delta;
}

#endif

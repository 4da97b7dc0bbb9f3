#ifndef ETALON_PATH_PASSAGE_H
#define ETALON_PATH_PASSAGE_H

/* Surfaces that let light go straight on: panes of thin glass, masks, null.
 *
 * Passing straight through a surface is no vertex of a path. A path consists of the
 * vertices where its direction changes, joined by edges, and an edge may cross surfaces
 * that have a straight lobe (surface/bsdf.h:bsdf_straight): with transmittance T_i, and
 * with the chance q_i that a walk which arrives there goes straight on rather than
 * choosing another lobe. Of an edge, T = product of T_i multiplies the contribution, and
 * Q = product of q_i the density of every walk that makes this edge. So
 *   - a walk decides at each such surface: with the chance q_i it goes on along the same
 *     edge with weight T_i / q_i, else the surface becomes its next vertex;
 *   - a connection crosses with weight T;
 *   - in MIS ratios, densities per area of walks have the factor Q of their edge. It is
 *     the same from both sides, as q_i is, and a technique that connects the two ends of
 *     the edge does not have it.
 * The samples of a vertex's other lobes have densities that include the chance of not
 * passing, as those of any lobe include the chance of this lobe. A walk that ends at the
 * surface, for a connection, samples no lobe; the chance c = 1 - q of ending there rather
 * than passing is a factor of this technique's density alone. So in the sums of
 * path/vertex.h, d_i is not 0 or 1 but the product of c of both ends that the technique
 * connects, and everything is relative to this product for the technique at hand.
 *
 * What passes is not counted as an edge: a maximum depth of so many edges has the same
 * meaning with a pane before the camera as without it (pbrt's alpha and interfaces do the
 * same; Mitsuba counts). A lamp that is itself such a surface stays a vertex, with a
 * delta lobe that goes straight on.
 *
 * The decisions of an edge have one number, that of the lobe at the vertex to which it
 * leads: u < q passes and leaves u / q for the next decision. What remains in the end
 * chooses the lobe. A decision uses up as many bits of u as its outcome is improbable. */

#include "image/contrib.h"
#include "path/dims.h"
#include "path/vertex.h"
#include "scene/accel.h"

/* Most surfaces that one edge may pass; edges with more carry no light, and are counted
 * (scene.edges_cut). */
#define PASSAGE_MOST 256

/* What an unobstructed edge has beside its geometry, for the technique that connects its
 * ends. */
struct passage {
    struct rgb value; /* factor of the path's value: T over both c */
    double density;   /* factor of the densities from the other side: Q over both c */
    /* Chance of ending at y (z) of a walk that comes from z (y): 1 unless it passes. */
    double end_y, end_z;
};

/* FAILURE_BLOCKED if something between y and z lets no light through. w: from y to z. */
enum failure passage_between(const struct subpaths *paths, const struct vertex *y,
                             const struct vertex *z, struct vec3 w,
                             struct passage *passage);

/* Whether light goes straight on through what was hit, its textures evaluated, along w or
 * -w. */
bool passage_straight(const struct hit *hit, struct vec3 w, struct bsdf_straight *out);

/* T and Q of the unblocked segment along w or -w, and the number of surfaces on it; false
 * if one of them lets no light through. */
bool passage_cross(const struct subpaths *paths, struct accel_segment *segment,
                   struct vec3 w, struct bsdf_straight *product, int *crossed);

/* Transmittance of all that the ray from `from` along w passes straight through before it
 * leaves the scene or meets the side of a lamp that shines; black if it ends on another
 * surface. */
struct rgb passage_escape(const struct scene *scene, const struct ray_endpoint *from,
                          struct vec3 w);

/* Chance that a walk which comes to v along -w ends there: 1 unless it may pass. */
double passage_end_chance(const struct vertex *v, struct vec3 w);

/* As accel_trace for a walk's step d from `from`, to the next surface at which the walk
 * does not pass; d then is the step of the whole edge, and paths->lobe what is left of
 * the number at `place`, of the lobe at v (below 0: not drawn). v->hit.bsdf is the BSDF
 * of the point, its textures evaluated. */
enum accel_result passage_trace(struct subpaths *paths, const struct ray_endpoint *from,
                                struct scatter_step *d, struct ustream *numbers,
                                int place, enum hit_filter filter, struct vertex *v);

#endif

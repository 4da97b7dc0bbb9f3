#ifndef ETALON_PATH_CONNECT_H
#define ETALON_PATH_CONNECT_H

/* Joins s light vertices and t camera vertices to a path, with its MIS weight (balance
 * heuristic over all techniques of that length [Veach97, section 10.2]). Each returns
 * FAILURE_NONE, or why the path carries nothing; visibility is tested last, or,
 * with paths->blind, left to the caller where the connection says so: the emission of
 * some lights is looked up after the test only, and the lens point of an orthographic
 * camera is not the one of the sub-path. */

#include "image/contrib.h"
#include "path/edge.h"
#include "path/mis.h"
#include "path/walk.h"

struct connection {
    struct rgb value; /* contribution of the path over its density, unweighted */
    double weight;    /* balance heuristic */
    int32_t pixel;
    bool untested; /* whether its visibility is left to the caller */
};

/* s = 0: the camera sub-path ends at z on a light. `edges`: of the path to z; those of
 * one edge, the emitters that the camera sees directly, may be hidden. */
static inline enum failure connect_hit(const struct subpaths *paths,
                                       const struct vertex *z, int edges,
                                       enum mis_set mis, struct connection *out)
{
    const struct light *light = z->light;
    if (light == NULL || (edges == 1 && paths->scene->hide_emitters))
        return FAILURE_ZERO;
    struct rgb emission = light_emission(light, &z->hit.at, z->wo);
    if (rgb_is_black(emission))
        return FAILURE_ZERO;
    out->value = rgb_mul(z->throughput, emission); /* C_{0,t} [Veach97 Eq. 10.8] */
    out->pixel = paths->pixel;
    out->untested = false;
    out->weight = 1.0; /* (0,2) is the only technique of length 1 */
    if (edges > 1) {
        double q = mis == MIS_BIDIRECTIONAL
                       ? light->type->pdf_direction(light, &z->hit.at, z->wo)
                       : 0.0;
        double pdf_point = light_pdf_point(light, &z->hit.at);
        /* [Veach97 Eqs. 9.8 and 10.9] */
        out->weight = mis_weight(0.0, mis_side(z, pdf_point, q, 1.0));
    }
    return FAILURE_NONE;
}

/* s = 1: connects z to a new point on a light, sampled with the numbers u (pick, point).
 * *point (may be NULL) receives the light vertex. */
static inline __attribute__((always_inline)) enum failure
connect_light(const struct subpaths *paths, const double u[3], const struct vertex *z,
              enum mis_set mis, struct connection *out, struct vertex *point)
{
    struct vertex y;
    struct edge e;
    struct bsdf_value f;
    y.light = light_sample(paths->scene, u[0], u + 1, &y.hit);
    if (!edge_from_light(y.light, &y.hit.at, &z->hit.at, &e))
        return FAILURE_ZERO;
    /* The emission and density of an environment come from large tables, at the price of
     * a ray: they are looked up for unobstructed paths only. */
    bool late = y.light->type->pdf_point != NULL;
    struct rgb emission = late ? rgb_grey(1.0) : light_emission(y.light, &y.hit.at, e.w);
    if (rgb_is_black(emission) ||
        !vertex_scatter(z, vec3_neg(e.w), TRANSPORT_RADIANCE, &f))
        return FAILURE_ZERO;
    bool delta = y.light->delta_position;
    double cos_light = delta ? 1.0 : edge_cos_geometric(&y, e.w);
    double geometry = cos_light * edge_cos_shading(z, e.w) * e.inverse_square;
    y.pdf_fwd = late ? 1.0 : light_pdf_point(y.light, &y.hit.at);
    /* C_{1,t} = (L_e / p) G f alpha_t [Veach97 Eq. 10.8]. */
    out->value = rgb_scale(rgb_mul(rgb_mul(z->throughput, f.f), emission),
                           geometry / y.pdf_fwd);
    out->pixel = paths->pixel;
    out->untested = paths->blind && !late && !paths->passed;
    struct passage passage;
    y.kind = VERTEX_LIGHT;
    y.end_chance = 1.0;
    enum failure failure = edge_unobstructed(paths, &y, z, e.w, out->untested,
                                             &out->value, &passage);
    if (failure != FAILURE_NONE)
        return failure;
    if (late) {
        emission = light_emission(y.light, &y.hit.at, e.w);
        if (rgb_is_black(emission))
            return FAILURE_ZERO;
        /* 0 if the direction was rounded, to floats, into a cell without a density. */
        y.pdf_fwd = light_pdf_point(y.light, &y.hit.at);
        if (!(y.pdf_fwd > 0.0))
            return FAILURE_ZERO;
        out->value = rgb_mul(out->value, rgb_scale(emission, 1.0 / y.pdf_fwd));
        if (rgb_is_black(out->value))
            return FAILURE_ZERO;
    }
    y.prev_connects = delta ? 0.0 : 1.0;
    y.mis_tail = 0.0;
    /* Densities per area of both ends, as the sub-path from the other side would sample
     * them: the ratios of [Veach97 Eq. 10.9]. */
    double per_area = e.inverse_square * passage.density;
    double q_light = f.pdf * cos_light * per_area;
    double camera_side = 0.0; /* the techniques s >= 2 */
    if (mis == MIS_BIDIRECTIONAL) {
        double q_dir = y.light->type->pdf_direction(y.light, &y.hit.at, e.w);
        double q_surface = q_dir * edge_cos_geometric(z, e.w) * per_area;
        camera_side = mis_side(z, q_surface, f.pdf_rev, passage.end_z);
    }
    /* [Veach97 Eqs. 9.8 and 10.9] */
    out->weight = mis_weight(mis_side(&y, q_light, 0.0, 1.0), camera_side);
    if (point) {
        y.connectible = true;
        y.delta_event = false;
        *point = y;
    }
    return FAILURE_NONE;
}

/* t = 1: y seen from the lens point of the camera sub-path. */
enum failure connect_camera(const struct subpaths *paths, const struct vertex *y,
                            struct connection *out);
/* s, t >= 2. */
enum failure connect_surfaces(const struct subpaths *paths, const struct vertex *y,
                              const struct vertex *z, struct connection *out);

#endif

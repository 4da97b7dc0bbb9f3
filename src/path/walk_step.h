#ifndef ETALON_PATH_WALK_STEP_H
#define ETALON_PATH_WALK_STEP_H

/* The steps of a walk: the camera's ray, the hit of a ray, the scattering there. Inlined
 * into each walk, which passes `mode`, `mis` and `passes` (whether edges may pass
 * surfaces: path/passage.h) as constants: the compiler drops what a walk does not use. */

#include "path/edge.h"
#include "path/mis.h"
#include "path/passage.h"

/* Inlined always: scenes without surfaces to pass pay nothing for those of others. */
#define WALK_STEP static inline __attribute__((always_inline))

/* Makes the lens point that the numbers u give vertex 0 of the camera sub-path. */
static inline void sample_lens(struct subpaths *paths, const double u[2])
{
    struct vertex *v = paths->camera;
    v->kind = VERTEX_CAMERA;
    v->hit.at = camera_sample_lens(&paths->scene->camera, u);
    if (paths->special && paths->scene->camera.orthographic)
        v->wo = camera_parallel(&paths->scene->camera, &v->hit.at);
    v->connectible = true;
    v->end_chance = 1.0;
    v->prev_connects = 0.0;
    v->delta_event = false;
    v->throughput = rgb_grey(1.0);
    v->pdf_fwd = 1.0;
    v->mis_tail = 0.0;
    v->light = NULL;
}

/* The step from the lens through the film position u; sets paths->pixel. */
static inline struct scatter_step sample_film(struct subpaths *paths, const double u[2])
{
    struct vertex *v = paths->camera;
    struct vec3 w;
    double pdf;
    paths->pixel = camera_sample_direction(&paths->scene->camera, &v->hit.at, u, &w,
                                           &pdf);
    v->event_pdf = pdf;
    v->event_pdf_rev = 0.0;
    /* No technique lets the light path hit the lens (t = 0): T_0 = 0. */
    return (struct scatter_step){
        .w = w, .pdf = pdf, .throughput = {1.0, 1.0, 1.0}, .cos = 1.0, .connects = 1.0};
}

static inline void set_incident(struct vertex *v, const struct scatter_step *d,
                                enum transport mode, bool has_shading_normal)
{
    v->has_shading_normal = has_shading_normal;
    v->wo = vec3_neg(d->w);
    v->wo_local = frame_to_local(&v->hit.shading, v->wo);
    v->cos_wo = vec3_dot(v->hit.at.ng, v->wo);
    /* [Veach97 Eq. 5.19]: the factor of the adjoint BSDF under shading normals. */
    if (mode == TRANSPORT_IMPORTANCE)
        v->adjoint = has_shading_normal
                         ? fabs((double)v->wo_local.z) / fabs((double)v->cos_wo)
                         : 1.0;
}

/* Makes *v the vertex of a walk that left the scene: a point of the environment. */
static inline void escape(struct vertex *v, const struct scatter_step *d,
                          const struct light *environment)
{
    v->kind = VERTEX_LIGHT;
    v->light = environment;
    v->hit = (struct hit){
        .at = {.ng = vec3_neg(d->w)}, .bsdf = &bsdf_nothing, .light = -1, .shape = -1};
    v->wo = v->hit.at.ng;
    v->connectible = false;
    v->prev_connects = d->connects;
    v->delta_event = false;
    v->throughput = d->throughput;
    v->pdf_fwd = d->pdf;
    v->mis_tail = d->tail_over_pdf * d->cos;
}

/* Fills in the densities per area; an edge from infinity has no 1/distance^2. False if
 * the ray meets the surface so exactly edge-on that the density per area is zero. */
static inline bool set_densities(struct subpaths *paths, const struct vertex *from,
                                 const struct scatter_step *d, struct vertex *v)
{
    double inverse_square = inverse_square_between(&from->hit.at, &v->hit.at);
    if (paths->special && vertex_is_direction(from, &paths->scene->camera))
        inverse_square = 1.0;
    /* Density per solid angle to density per area [Veach97, section 8.2.2]. */
    v->pdf_fwd = d->pdf * fabs((double)v->cos_wo) * inverse_square;
    v->mis_tail = d->tail_over_pdf * d->cos * inverse_square;
    bool regular = v->cos_wo != 0.0f && isfinite(v->pdf_fwd);
    paths->nonfinite += !regular;
    return regular;
}

/* Traces the ray of step d from vertex `from` and fills the vertex *v of paths that it
 * hits. False if the ray leaves the scene, if the filter refuses the surface, or if the
 * density per area is zero. A path tracer weights only hits of lights, so other vertices
 * of it get no densities. */
WALK_STEP bool trace_step(struct subpaths *paths, const struct vertex *from,
                          struct scatter_step *d, struct ustream *numbers, int place,
                          enum transport mode, enum mis_set mis, bool passes,
                          enum hit_filter filter, struct vertex *v)
{
    enum accel_result found;
    v->end_chance = 1.0;
    if (passes) {
        struct scatter_step edge = *d; /* so that d itself can stay in registers */
        found = passage_trace(paths, &from->hit.at, &edge, numbers, place, filter, v);
        *d = edge;
    } else {
        found = accel_trace(paths->scene, &from->hit.at, d->w, filter, &v->hit);
    }
    paths->filtered_out = found == ACCEL_FILTERED_OUT;
    /* Only camera paths end at infinity. */
    const struct light *environment = mode == TRANSPORT_RADIANCE
                                          ? paths->scene->environment
                                          : NULL;
    if (found == ACCEL_MISS && environment) {
        paths->filtered_out =
            filter == HIT_CONNECTIBLE; /* the environment is no connectible vertex */
        escape(v, d, environment);
        return !paths->filtered_out;
    }
    if (found != ACCEL_HIT)
        return false;
    v->kind = VERTEX_SURFACE;
    v->light = v->hit.light >= 0 ? &paths->scene->lights[v->hit.light] : NULL;
    set_incident(v, d, mode, paths->scene->needs.shading_normals);
    if (paths->special && paths->nodes)
        hit_evaluate_textures(&v->hit, &paths->nodes[v - paths->camera]);
    v->connectible = !(v->hit.bsdf->flags & (BSDF_DELTA | BSDF_BLACK));
    v->prev_connects = d->connects;
    v->delta_event = false;
    v->throughput = d->throughput;
    return (mis == MIS_UNIDIRECTIONAL && !v->light) || set_densities(paths, from, d, v);
}

/* The numbers of the scattering at the vertex. Where the walk has decided whether to pass
 * something on its way, the lobe's number is what this has left of it. */
WALK_STEP void scatter_numbers(const struct subpaths *paths, struct ustream *numbers,
                               int first, int vertex, const struct vertex *v, bool passes,
                               double u[3])
{
    unsigned flags = v->hit.bsdf->flags | paths->keep;
    if (!passes || paths->lobe < 0.0) {
        dims_scatter(numbers, first, vertex, flags, u);
        return;
    }
    dims_scatter(numbers, first, vertex, flags & ~(unsigned)BSDF_U_LOBE, u);
    u[0] = paths->lobe;
}

/* Samples, with the numbers u, the direction in which the walk leaves v; false where the
 * walk ends. */
WALK_STEP bool sample_step(struct subpaths *paths, struct vertex *v, const double u[3],
                           enum transport mode, enum mis_set mis, bool passes,
                           struct scatter_step *d)
{
    struct bsdf_sample s;
    if (!bsdf_sample(v->hit.bsdf, v->wo_local, u, mode, &s))
        return false;
    d->w = frame_to_world(&v->hit.shading, s.wi);
    if (!s.delta && !vertex_sides_agree(v, d->w, s.wi.z))
        return false;
    d->pdf = s.pdf;
    d->cos = fabs((double)vec3_dot(v->hit.at.ng, d->w));
    double scale = 1.0;
    /* [Veach97 Eq. 5.19] with the cosine of the sampled direction. */
    if (mode == TRANSPORT_IMPORTANCE && v->has_shading_normal)
        scale = v->adjoint * d->cos / fabs((double)s.wi.z);
    /* alpha_{i+1} = alpha_i f cos / p [Veach97 Eqs. 10.6 and 10.7]. */
    d->throughput = rgb_scale(rgb_mul(v->throughput, s.weight), scale);
    d->connects = s.delta ? 0.0 : v->end_chance;
    if (mis == MIS_BIDIRECTIONAL) {
        /* T_e / p(v_e), the recurrence of path/vertex.h [Veach97 Eq. 10.9]. */
        double exists = s.delta ? 0.0 : v->prev_connects;
        if (passes)
            exists *= passage_end_chance(v, d->w);
        d->tail_over_pdf = (exists + s.pdf_rev * v->mis_tail) / v->pdf_fwd;
        v->delta_event = s.delta;
        v->event_pdf = s.pdf;
        v->event_pdf_rev = s.pdf_rev;
        if (s.delta)
            v->event_weight = s.weight;
    }
    bool finite = rgb_is_finite(d->throughput);
    paths->nonfinite += !finite;
    return finite;
}

#endif

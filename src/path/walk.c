#include "path/walk.h"

#include "base/mem.h"

/* One scattering event of a walk: the sampled direction, its density, and the part of the
 * MIS recurrence (path/vertex.h) that is known before the next vertex is found. */
struct scatter_step {
    struct vec3 w;
    double pdf;                      /* 1/sr */
    struct rgb throughput;           /* with this step's weight */
    double tail_over_pdf;            /* T_e / p(v_e) of the vertex left: path/vertex.h */
    double cos;                      /* |ng . w| there (1 without a surface) */
    bool connects;                   /* the event was no delta */
    const struct light *environment; /* the light at infinity, or NULL */
};

void subpaths_init(struct subpaths *paths, const struct scene *scene, int max_depth)
{
    size_t count = (size_t)max_depth + 1;
    *paths = (struct subpaths){
        .scene = scene,
        .max_depth = max_depth,
        .many_lights = scene->light_count > 1 || scene->needs.keep_all,
        .special = scene->needs.uv || scene->needs.environment ||
                   scene->needs.distant_lights,
        .keep = scene->needs.keep_all ? BSDF_U_LOBE | BSDF_U_DIRECTION : 0,
        .camera = mem_aligned(MEM_APART, 2 * count, sizeof(struct vertex)),
    };
    paths->light = paths->camera + count;
    if (scene->needs.uv)
        paths->nodes = mem_alloc(2 * count, sizeof *paths->nodes);
}

double subpaths_bytes(const struct scene *scene, int max_depth)
{
    size_t each = sizeof(struct vertex) +
                  (scene->needs.uv ? sizeof(struct bsdf_nodes) : 0u);
    return 2.0 * (max_depth + 1.0) * (double)each;
}

void subpaths_deinit(struct subpaths *paths)
{
    mem_free(paths->camera);
    mem_free(paths->nodes);
}

static void set_incident(struct vertex *v, const struct scatter_step *d,
                         bool has_shading_normal)
{
    v->has_shading_normal = has_shading_normal;
    v->wo = vec3_neg(d->w);
    v->wo_local = frame_to_local(&v->hit.shading, v->wo);
    v->cos_wo = vec3_dot(v->hit.at.ng, v->wo);
    /* [Veach97 Eq. 5.19]: the factor of the adjoint BSDF under shading normals. */
    v->adjoint = has_shading_normal
                     ? fabs((double)v->wo_local.z) / fabs((double)v->cos_wo)
                     : 1.0;
}

/* Makes *v the vertex of a walk that left the scene: a point of the environment. */
static void escape(struct vertex *v, const struct scatter_step *d)
{
    v->kind = VERTEX_LIGHT;
    v->light = d->environment;
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

/* 1 / distance^2. Two points in a corner may round to the same place; the sum of their
 * ray offsets, which bounds the rounding error, then stands for their distance. */
static double inverse_square_between(const struct ray_endpoint *a,
                                     const struct ray_endpoint *b)
{
    double square = hit_square_distance(a->p, b->p);
    double apart = (double)a->offset + (double)b->offset;
    return 1.0 / (square > 0.0 ? square : apart * apart);
}

/* The two cases that only some scenes have: a BSDF with textures is evaluated at the hit,
 * and an edge from infinity has no 1/distance^2. */
static void resolve_special(const struct subpaths *paths, const struct vertex *from,
                            struct vertex *v, double *inverse_square)
{
    if (v->hit.bsdf->flags & BSDF_TEXTURED) {
        struct bsdf_nodes *nodes = &paths->nodes[v - paths->camera];
        nodes->count = 0;
        v->hit.bsdf = bsdf_at(v->hit.bsdf, (double)v->hit.u, (double)v->hit.v, nodes);
    }
    if (from->kind == VERTEX_LIGHT && from->light->infinite)
        *inverse_square = 1.0;
}

/* Traces the ray of step d from vertex `from` and fills the vertex *v that it hits. False
 * if the ray leaves the scene, if the filter refuses the surface, or if the ray meets the
 * surface so exactly edge-on that the density per area is zero. */
static bool trace_step(struct subpaths *paths, const struct vertex *from,
                       const struct scatter_step *d, enum hit_filter filter,
                       struct vertex *v)
{
    enum accel_result found = accel_trace(paths->scene, &from->hit.at, d->w, filter,
                                          &v->hit);
    paths->filtered_out = found == ACCEL_FILTERED_OUT;
    if (found == ACCEL_MISS && d->environment) {
        paths->filtered_out =
            filter == HIT_CONNECTIBLE; /* the environment is no connectible vertex */
        escape(v, d);
        return !paths->filtered_out;
    }
    if (found != ACCEL_HIT)
        return false;
    v->kind = VERTEX_SURFACE;
    v->light = v->hit.light >= 0 ? &paths->scene->lights[v->hit.light] : NULL;
    set_incident(v, d, paths->scene->needs.shading_normals);
    double inverse_square = inverse_square_between(&from->hit.at, &v->hit.at);
    if (paths->special)
        resolve_special(paths, from, v, &inverse_square);
    v->connectible = !(v->hit.bsdf->flags & (BSDF_DELTA | BSDF_BLACK));
    v->prev_connects = d->connects;
    v->delta_event = false;
    v->throughput = d->throughput;
    /* Density per solid angle to density per area [Veach97, section 8.2.2]. */
    v->pdf_fwd = d->pdf * fabs((double)v->cos_wo) * inverse_square;
    v->mis_tail = d->tail_over_pdf * d->cos * inverse_square;
    bool regular = v->cos_wo != 0.0f && isfinite(v->pdf_fwd);
    paths->nonfinite += !regular;
    return regular;
}

/* Whether shading and geometric normal agree that wo -> w reflects or transmits. */
static inline bool sides_agree(const struct vertex *v, struct vec3 w, float w_local_z)
{
    if (!v->has_shading_normal)
        return true;
    return (v->cos_wo * vec3_dot(v->hit.at.ng, w) > 0.0f) ==
           (v->wo_local.z * w_local_z > 0.0f);
}

bool vertex_scatter(const struct vertex *v, struct vec3 w, enum transport mode,
                    struct bsdf_value *out)
{
    struct vec3 wi = frame_to_local(&v->hit.shading, w);
    return sides_agree(v, w, wi.z) && bsdf_eval(v->hit.bsdf, v->wo_local, wi, mode, out);
}

/* Samples the direction in which the walk leaves v; false where the walk ends. */
static bool sample_step(struct subpaths *paths, struct vertex *v, const double u[3],
                        enum transport mode, struct scatter_step *d)
{
    struct bsdf_sample s;
    if (!bsdf_sample(v->hit.bsdf, v->wo_local, u, mode, &s))
        return false;
    d->w = frame_to_world(&v->hit.shading, s.wi);
    if (!s.delta && !sides_agree(v, d->w, s.wi.z))
        return false;
    d->pdf = s.pdf;
    d->cos = fabs((double)vec3_dot(v->hit.at.ng, d->w));
    double scale = 1.0;
    /* [Veach97 Eq. 5.19] with the cosine of the sampled direction. */
    if (mode == TRANSPORT_IMPORTANCE && v->has_shading_normal)
        scale = v->adjoint * d->cos / fabs((double)s.wi.z);
    /* alpha_{i+1} = alpha_i f cos / p [Veach97 Eqs. 10.6 and 10.7]. */
    d->throughput = rgb_scale(rgb_mul(v->throughput, s.weight), scale);
    d->connects = !s.delta;
    /* T_e / p(v_e), the recurrence of path/vertex.h [Veach97 Eq. 10.9]. */
    double exists = v->prev_connects && !s.delta ? 1.0 : 0.0;
    d->tail_over_pdf = (exists + s.pdf_rev * v->mis_tail) / v->pdf_fwd;
    v->delta_event = s.delta;
    v->event_pdf = s.pdf;
    v->event_pdf_rev = s.pdf_rev;
    bool finite = rgb_is_finite(d->throughput);
    paths->nonfinite += !finite;
    return finite;
}

/* Extends the walk from vertex 0 and its first step d to at most max_vertices vertices;
 * the last of them must pass the filter. Returns the number of vertices. */
static int walk(struct subpaths *paths, struct vertex *v, struct scatter_step d,
                struct ustream *numbers, int first_place, enum transport mode,
                int max_vertices, enum hit_filter filter)
{
    int count = 1;
    while (count < max_vertices) {
        enum hit_filter this_filter = count + 1 == max_vertices ? filter : HIT_ANY;
        if (!trace_step(paths, &v[count - 1], &d, this_filter, &v[count]))
            break;
        struct vertex *here = &v[count++];
        if (count == max_vertices || here->hit.bsdf->flags & BSDF_BLACK)
            break;
        double u[3];
        dims_scatter(numbers, first_place, count - 1, here->hit.bsdf->flags | paths->keep,
                     u);
        if (!sample_step(paths, here, u, mode, &d))
            break;
    }
    return count;
}

void walk_camera(struct subpaths *paths, struct ustream *numbers, int max_vertices,
                 enum hit_filter filter)
{
    const struct scene *scene = paths->scene;
    static const double centre[2] = {0.5, 0.5};
    struct vertex *v = paths->camera;
    const double *lens = scene->needs.lens ? ustream_take(numbers, DIMS_LENS, 2) : centre;
    struct scatter_step d = {.throughput = {1.0, 1.0, 1.0},
                             .connects = true,
                             .cos = 1.0,
                             .environment = scene->environment};
    v->kind = VERTEX_CAMERA;
    v->hit.at = camera_sample_lens(&scene->camera, lens);
    v->connectible = true;
    v->prev_connects = false;
    v->delta_event = false;
    v->throughput = d.throughput;
    v->pdf_fwd = 1.0;
    v->mis_tail = 0.0;
    v->light = NULL;
    paths->camera_count = 1;
    paths->filtered_out = false;
    if (max_vertices < 2)
        return;
    /* No technique lets the light path hit the lens (t = 0): T_0 = 0. */
    const double *u = ustream_take(numbers, DIMS_FILM, 2);
    paths->pixel = camera_sample_direction(&scene->camera, &v->hit.at, u, &d.w, &d.pdf);
    v->event_pdf = d.pdf;
    v->event_pdf_rev = 0.0;
    paths->camera_count = walk(paths, v, d, numbers, DIMS_CAMERA_VERTEX,
                               TRANSPORT_RADIANCE, max_vertices, filter);
}

void walk_light(struct subpaths *paths, struct ustream *numbers, int max_vertices,
                enum hit_filter filter)
{
    struct vertex *v = paths->light;
    paths->light_count = 0;
    paths->filtered_out = false;
    if (max_vertices < 2)
        return;
    double u[3];
    dims_light(numbers, DIMS_LIGHT_PICK, paths->many_lights, u);
    const struct light *light = light_sample(paths->scene, u[0], u + 1, &v->hit.at);
    const double *direction = ustream_take(numbers, DIMS_LIGHT_DIRECTION, 2);
    struct scatter_step d = {.connects = true};
    struct rgb weight;
    if (!light->type->sample_direction(light, &v->hit.at, direction, &d.w, &d.pdf,
                                       &weight))
        return;
    v->kind = VERTEX_LIGHT;
    v->connectible = true;
    v->prev_connects = !light->delta_position; /* s = 0 exists */
    v->delta_event = false;
    v->light = light;
    v->pdf_fwd = light_pdf_point(light, &v->hit.at);
    v->throughput = rgb_grey(1.0 / v->pdf_fwd);
    v->mis_tail = 0.0;
    v->event_pdf = d.pdf;
    v->event_pdf_rev = 0.0;
    d.throughput = rgb_scale(weight, 1.0 / v->pdf_fwd);
    d.cos = light->delta_position ? 1.0 : fabs((double)vec3_dot(v->hit.at.ng, d.w));
    d.tail_over_pdf = light->delta_position ? 0.0 : 1.0 / v->pdf_fwd;
    paths->light_count = walk(paths, v, d, numbers, DIMS_LIGHT_VERTEX,
                              TRANSPORT_IMPORTANCE, max_vertices, filter);
}

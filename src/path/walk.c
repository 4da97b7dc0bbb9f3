#include "path/walk.h"

#include "base/mem.h"

/* A step of the walk: the direction it takes and what is known of it. */
struct departure {
    struct vec3 w;
    double pdf;                      /* 1/sr */
    struct rgb throughput;           /* with this step's weight */
    double reach;                    /* T_e / p(v_e) of the vertex left, see vertex.h */
    double cos;                      /* |ng . w| there (1 without a surface) */
    bool connects;                   /* the event was no delta */
    const struct light *environment; /* what the walk meets where it leaves the scene */
};

void subpaths_init(struct subpaths *paths, const struct scene *scene, int max_depth)
{
    size_t count = (size_t)max_depth + 1;
    *paths = (struct subpaths){
        .scene = scene,
        .max_depth = max_depth,
        .many_lights = scene->light_count > 1 || scene->needs.keep_all,
        .rare = scene->needs.uv || scene->needs.environment ||
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

static void set_incoming(struct vertex *v, const struct departure *d, bool bent)
{
    v->bent = bent;
    v->wo = vec3_neg(d->w);
    v->wo_local = frame_to_local(&v->hit.shading, v->wo);
    v->cos_wo = vec3_dot(v->hit.at.ng, v->wo);
    v->adjoint = bent ? fabs((double)v->wo_local.z) / fabs((double)v->cos_wo) : 1.0;
}

/* The walk ends at infinity. */
static void escape(struct vertex *v, const struct departure *d)
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
    v->mis_tail = d->reach * d->cos;
}

/* 1 / distance^2. In a corner two points may be rounded to one; they are then as far
 * apart as what clears their rounding, which is all that is known of it. */
static double inverse_square_between(const struct anchor *a, const struct anchor *b)
{
    double square = hit_square_distance(a->p, b->p);
    double apart = (double)a->offset + (double)b->offset;
    return 1.0 / (square > 0.0 ? square : apart * apart);
}

/* What few scenes need: a BSDF made of textures, an edge from infinity. */
static void arrive_rare(const struct subpaths *paths, const struct vertex *from,
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

/* Follows d from `from`; fills *v. False if the ray leaves the scene or misses its aim,
 * or where it meets a surface so exactly edge-on that densities are zero. */
static bool arrive(struct subpaths *paths, const struct vertex *from,
                   const struct departure *d, enum accel_aim aim, struct vertex *v)
{
    enum accel_found found = accel_seek(paths->scene, &from->hit.at, d->w, aim, &v->hit);
    paths->missed_aim = found == ACCEL_OTHER;
    if (found == ACCEL_NOTHING && d->environment) {
        paths->missed_aim = aim == ACCEL_CONNECTIBLE; /* the sky is none */
        escape(v, d);
        return !paths->missed_aim;
    }
    if (found != ACCEL_HIT)
        return false;
    v->kind = VERTEX_SURFACE;
    v->light = v->hit.light >= 0 ? &paths->scene->lights[v->hit.light] : NULL;
    set_incoming(v, d, paths->scene->needs.shading_normals);
    double inverse_square = inverse_square_between(&from->hit.at, &v->hit.at);
    if (paths->rare)
        arrive_rare(paths, from, v, &inverse_square);
    v->connectible = !(v->hit.bsdf->flags & (BSDF_DELTA | BSDF_BLACK));
    v->prev_connects = d->connects;
    v->delta_event = false;
    v->throughput = d->throughput;
    v->pdf_fwd = d->pdf * fabs((double)v->cos_wo) * inverse_square;
    v->mis_tail = d->reach * d->cos * inverse_square;
    bool regular = v->cos_wo != 0.0f && isfinite(v->pdf_fwd);
    paths->nonfinite += !regular;
    return regular;
}

/* Whether shading and geometric normal agree that wo -> w reflects or transmits. */
static inline bool sides_agree(const struct vertex *v, struct vec3 w, float w_local_z)
{
    if (!v->bent)
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

/* Samples how the walk leaves v; false where it ends. */
static bool depart(struct subpaths *paths, struct vertex *v, const double u[3],
                   enum transport mode, struct departure *d)
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
    if (mode == TRANSPORT_IMPORTANCE && v->bent)
        scale = v->adjoint * d->cos / fabs((double)s.wi.z);
    d->throughput = rgb_scale(rgb_mul(v->throughput, s.weight), scale);
    d->connects = !s.delta;
    double exists = v->prev_connects && !s.delta ? 1.0 : 0.0;
    d->reach = (exists + s.pdf_rev * v->mis_tail) / v->pdf_fwd;
    v->delta_event = s.delta;
    v->event_pdf = s.pdf;
    v->event_pdf_rev = s.pdf_rev;
    bool finite = rgb_is_finite(d->throughput);
    paths->nonfinite += !finite;
    return finite;
}

/* From vertex 0 with its departure to at most max_vertices vertices, the last of them as
 * aimed at; returns how many. */
static int walk(struct subpaths *paths, struct vertex *v, struct departure d,
                struct ustream *numbers, int first_place, enum transport mode,
                int max_vertices, enum accel_aim aim)
{
    int count = 1;
    while (count < max_vertices) {
        enum accel_aim this_aim = count + 1 == max_vertices ? aim : ACCEL_ANY;
        if (!arrive(paths, &v[count - 1], &d, this_aim, &v[count]))
            break;
        struct vertex *here = &v[count++];
        if (count == max_vertices || here->hit.bsdf->flags & BSDF_BLACK)
            break;
        double u[3];
        dims_scatter(numbers, first_place, count - 1, here->hit.bsdf->flags | paths->keep,
                     u);
        if (!depart(paths, here, u, mode, &d))
            break;
    }
    return count;
}

void walk_camera(struct subpaths *paths, struct ustream *numbers, int max_vertices,
                 enum accel_aim aim)
{
    const struct scene *scene = paths->scene;
    static const double centre[2] = {0.5, 0.5};
    struct vertex *v = paths->camera;
    const double *lens = scene->needs.lens ? ustream_take(numbers, DIMS_LENS, 2) : centre;
    struct departure d = {.throughput = {1.0, 1.0, 1.0},
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
    paths->missed_aim = false;
    if (max_vertices < 2)
        return;
    /* No technique has the lens hit by chance (t = 0): T_0 = 0, so reach stays 0. */
    const double *u = ustream_take(numbers, DIMS_FILM, 2);
    paths->pixel = camera_sample_direction(&scene->camera, &v->hit.at, u, &d.w, &d.pdf);
    v->event_pdf = d.pdf;
    v->event_pdf_rev = 0.0;
    paths->camera_count = walk(paths, v, d, numbers, DIMS_CAMERA_VERTEX,
                               TRANSPORT_RADIANCE, max_vertices, aim);
}

void walk_light(struct subpaths *paths, struct ustream *numbers, int max_vertices,
                enum accel_aim aim)
{
    struct vertex *v = paths->light;
    paths->light_count = 0;
    paths->missed_aim = false;
    if (max_vertices < 2)
        return;
    double u[3];
    dims_light(numbers, DIMS_LIGHT_PICK, paths->many_lights, u);
    const struct light *light = light_sample(paths->scene, u[0], u + 1, &v->hit.at);
    const double *direction = ustream_take(numbers, DIMS_LIGHT_DIRECTION, 2);
    struct departure d = {.connects = true};
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
    d.reach = light->delta_position ? 0.0 : 1.0 / v->pdf_fwd;
    paths->light_count = walk(paths, v, d, numbers, DIMS_LIGHT_VERTEX,
                              TRANSPORT_IMPORTANCE, max_vertices, aim);
}

#include "path/full_path.h"

#include "base/mem.h"
#include "path/connect.h"

/* --- storage ------------------------------------------------------------------------ */

void full_path_init(struct full_path *path, int most)
{
    *path = (struct full_path){0};
    path->x = mem_alloc((size_t)most + 1, sizeof *path->x);
}

void full_path_deinit(struct full_path *path)
{
    mem_free(path->x);
}

void full_path_copy_ends(struct full_path *to, const struct full_path *from)
{
    struct full_vertex *x = to->x;
    *to = *from;
    to->x = x;
}

void full_path_copy(struct full_path *to, const struct full_path *from)
{
    full_path_copy_ends(to, from);
    for (int i = 0; i <= from->edges; i++)
        to->x[i] = from->x[i];
}

/* --- directions --------------------------------------------------------------------- */

static const struct light *light_of(const struct path_space *space,
                                    const struct full_vertex *v)
{
    return &space->paths.scene->lights[v->light];
}

static bool infinite(const struct path_space *space, const struct full_vertex *v)
{
    return v->kind == VERTEX_LIGHT && light_of(space, v)->infinite;
}

const struct bsdf *full_path_bsdf(struct path_space *space, const struct hit *hit)
{
    return hit->bsdf->flags & BSDF_TEXTURED ? hit_bsdf(hit, &space->nodes) : hit->bsdf;
}

/* The other end of the edge from z along w to a light at infinity: a point outside. */
static struct ray_endpoint outside(const struct light *light,
                                   const struct ray_endpoint *z, struct vec3 w)
{
    float far = (float)(2.0 * light->sphere.radius);
    return (struct ray_endpoint){.p = vec3_mad(z->p, far, w)};
}

static enum failure camera_edge(struct path_space *space, struct full_path *path)
{
    const struct camera *camera = &space->paths.scene->camera;
    struct full_vertex *x = path->x;
    double cos;
    if (camera->orthographic) {
        if (!camera_meet(camera, x[0].edge.w, x[1].hit.at.p, &x[0].hit.at))
            return FAILURE_ZERO;
        x[0].edge.inverse_square = 1.0;
    } else if (!edge_between(&x[0].hit.at, &x[1].hit.at, &x[0].edge)) {
        return FAILURE_ZERO;
    }
    path->pixel = camera_project(camera, &x[0].hit.at, x[0].edge.w, &path->pdf_film,
                                 &cos);
    if (path->pixel < 0)
        return FAILURE_ZERO;
    camera_invert_direction(camera, &x[0].hit.at, x[0].edge.w, path->film);
    return FAILURE_NONE;
}

enum failure full_path_edge(struct path_space *space, struct full_path *path, int i)
{
    struct full_vertex *x = path->x;
    if (infinite(space, &x[i + 1]))
        x[i].edge = (struct edge){vec3_neg(x[i + 1].hit.at.ng), 1.0};
    else if (i == 0)
        return camera_edge(space, path);
    else if (!edge_between(&x[i].hit.at, &x[i + 1].hit.at, &x[i].edge))
        return FAILURE_ZERO;
    return FAILURE_NONE;
}

enum failure full_path_unobstructed(struct path_space *space, struct full_path *path,
                                    int i)
{
    const struct scene *scene = space->paths.scene;
    struct full_vertex *a = &path->x[i], *b = &path->x[i + 1];
    struct ray_endpoint end = b->hit.at;
    struct bsdf_straight product = {{1.0, 1.0, 1.0}, 1.0};
    if (infinite(space, b))
        end = outside(light_of(space, b), &a->hit.at, a->edge.w);
    a->crossed = 0;
    space->rays++;
    if (space->paths.passed) {
        struct accel_segment segment;
        if (!accel_unblocked(scene, &a->hit.at, &end, &segment) ||
            (segment.passing &&
             !passage_cross(&space->paths, &segment, a->edge.w, &product, &a->crossed)))
            return FAILURE_BLOCKED;
    } else if (!accel_visible(scene, &a->hit.at, &end)) {
        return FAILURE_BLOCKED;
    }
    a->transmittance = product.transmittance;
    a->chance = product.chance;
    return FAILURE_NONE;
}

/* --- vertices ----------------------------------------------------------------------- */

/* c of path/passage.h. */
static double end_chance(const struct full_vertex *v, const struct bsdf *bsdf,
                         struct vec3 local)
{
    struct bsdf_straight s;
    return v->hit.light < 0 && bsdf_straight(bsdf, local, &s) ? 1.0 - s.chance : 1.0;
}

enum failure full_path_scatter(struct path_space *space, struct full_path *path, int i)
{
    struct full_vertex *v = &path->x[i];
    struct vec3 to_camera = vec3_neg(path->x[i - 1].edge.w), to_light = v->edge.w;
    double cos_camera = (double)vec3_dot(v->hit.at.ng, to_camera);
    double cos_light = (double)vec3_dot(v->hit.at.ng, to_light);
    v->cos[SIDE_CAMERA] = fabs(cos_camera);
    v->cos[SIDE_LIGHT] = fabs(cos_light);
    /* An edge within the surface's plane, between two points of it: no technique has a
     * density there, but a bumped normal may have a BSDF. */
    if (cos_camera * cos_light == 0.0)
        return FAILURE_ZERO;
    if (v->delta)
        return FAILURE_NONE;
    const struct bsdf *bsdf = full_path_bsdf(space, &v->hit);
    struct vec3 wo = frame_to_local(&v->hit.shading, to_camera);
    struct vec3 wi = frame_to_local(&v->hit.shading, to_light);
    struct bsdf_value f;
    if ((space->paths.scene->needs.shading_normals &&
         (cos_camera * cos_light > 0.0) != (wo.z * wi.z > 0.0f)) ||
        !bsdf_eval(bsdf, wo, wi, TRANSPORT_RADIANCE, &f))
        return FAILURE_ZERO;
    v->value = rgb_scale(f.f, fabs((double)wi.z));
    v->pdf_to_light = f.pdf;
    v->pdf_to_camera = f.pdf_rev;
    v->end[SIDE_CAMERA] = v->end[SIDE_LIGHT] = 1.0;
    if (bsdf->flags & BSDF_STRAIGHT) {
        v->end[SIDE_CAMERA] = end_chance(v, bsdf, wo);
        v->end[SIDE_LIGHT] = end_chance(v, bsdf, wi);
    }
    return rgb_is_black(v->value) ? FAILURE_ZERO : FAILURE_NONE;
}

void full_path_set_delta(struct full_vertex *v, const struct bsdf_sample *s,
                         struct vec3 wo, enum side side)
{
    /* f |ns . w_l| from f* |ng . w_c| by [Veach97 Eq. 5.19]; in units of the delta that
     * was sampled. */
    double turn = side == SIDE_CAMERA ? 1.0 : fabs((double)wo.z / (double)s->wi.z);
    v->value = rgb_scale(s->weight, s->pdf * turn);
    v->pdf_to_light = side == SIDE_CAMERA ? s->pdf : s->pdf_rev;
    v->pdf_to_camera = side == SIDE_CAMERA ? s->pdf_rev : s->pdf;
}

enum failure full_path_emit(struct path_space *space, struct full_path *path)
{
    struct full_vertex *y = &path->x[path->edges];
    const struct light *light = light_of(space, y);
    struct vec3 w = vec3_neg(path->x[path->edges - 1].edge.w);
    path->emission = light_emission(light, &y->hit.at, w);
    if (rgb_is_black(path->emission))
        return FAILURE_ZERO;
    path->pdf_point = light_pdf_point(light, &y->hit.at);
    path->pdf_direction = light->type->pdf_direction(light, &y->hit.at, w);
    bool surface = !light->delta_position && !light->infinite;
    y->cos[SIDE_CAMERA] = surface ? fabs((double)vec3_dot(y->hit.at.ng, w)) : 1.0;
    return FAILURE_NONE;
}

/* --- densities ---------------------------------------------------------------------- */

double full_path_conversion(const struct full_path *path, int i, enum side from)
{
    const struct full_vertex *v = &path->x[i];
    return from == SIDE_CAMERA ? v->cos[SIDE_CAMERA] * path->x[i - 1].edge.inverse_square
                               : v->cos[SIDE_LIGHT] * v->edge.inverse_square;
}

double full_path_pdf(const struct full_path *path, int i, enum side from)
{
    const struct full_vertex *x = path->x;
    if (from == SIDE_CAMERA) {
        double pdf = i == 1 ? path->pdf_film : x[i - 1].pdf_to_light;
        return pdf * x[i - 1].chance * full_path_conversion(path, i, SIDE_CAMERA);
    }
    if (i == path->edges)
        return path->pdf_point;
    double pdf = i + 1 == path->edges ? path->pdf_direction : x[i + 1].pdf_to_camera;
    return pdf * x[i].chance * full_path_conversion(path, i, SIDE_LIGHT);
}

double full_path_connects(const struct path_space *space, const struct full_path *path,
                          int t)
{
    const struct full_vertex *x = path->x;
    int k = path->edges;
    if (t == k + 1)
        return light_of(space, &x[k])->delta_position ? 0.0 : 1.0;
    if (k == 1 || full_path_delta(path, t - 1) || full_path_delta(path, t))
        return 0.0;
    double chance = t > 1 ? x[t - 1].end[SIDE_CAMERA] : 1.0;
    return t < k ? chance * x[t].end[SIDE_LIGHT] : chance;
}

void full_path_weigh(const struct path_space *space, struct full_path *path)
{
    int k = path->edges;
    struct rgb value = path->emission;
    path->pdf = scaled(1.0);
    /* Of all techniques, over that of the camera's walk to the light (s = 0), exist it or
     * not [Veach97 Eq. 10.9]. */
    double sum = full_path_connects(space, path, k + 1), ratio = 1.0;
    for (int i = k; i >= 1; i--) {
        const struct full_vertex *v = &path->x[i], *before = v - 1;
        double pdf = full_path_pdf(path, i, SIDE_CAMERA);
        path->pdf = scaled_by(path->pdf, pdf);
        ratio *= full_path_pdf(path, i, SIDE_LIGHT) / pdf;
        sum += ratio * full_path_connects(space, path, i);
        if (i < k)
            value = rgb_scale(rgb_mul(value, v->value), 1.0 / v->pdf_to_light);
        value = rgb_scale(rgb_mul(value, before->transmittance), 1.0 / before->chance);
    }
    sum *= space->length_pdf[k] / space->techniques[k].count;
    path->ratio = rgb_scale(value, 1.0 / sum);
    path->pdf = scaled_by(path->pdf, sum);
}

void full_path_contribute(const struct full_path *path, struct contrib *out)
{
    contrib_add(out, path->pixel, path->ratio, 0, 0);
}

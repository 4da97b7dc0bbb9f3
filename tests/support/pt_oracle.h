#ifndef ETALON_TESTS_SUPPORT_PT_ORACLE_H
#define ETALON_TESTS_SUPPORT_PT_ORACLE_H

/* A path tracer by hand, with a camera ray, light sampling and scattering of its own: the
 * oracle of estimate_pt. It draws the same numbers at the same places. */

#include "path/estimate.h"

/* The ray that the path is about to follow. */
struct ray_state {
    struct ray_endpoint from;
    struct vec3 w;
    double pdf;    /* of w and of passing what was passed, 1/sr */
    bool specular; /* w came from the camera or a delta lobe: no other technique */
    struct rgb throughput;
    double ends;     /* chance of ending where the ray comes from rather than passing */
    double ends_hit; /* the same where it goes to */
    double lobe;     /* the lobe's number there, if drawn; else below 0 */
};

/* Emission of the surface that the ray met, weighted against next-event estimation. */
static inline struct rgb hit_emission(const struct scene *scene,
                                      const struct ray_state *ray, const struct hit *hit)
{
    const struct light *light = &scene->lights[hit->light];
    struct vec3 wo = vec3_neg(ray->w);
    struct rgb emission = light_emission(light, &hit->at, wo);
    if (ray->specular || rgb_is_black(emission))
        return rgb_mul(ray->throughput, emission);
    double cos = fabs((double)vec3_dot(hit->at.ng, wo));
    double other = light_pdf_point(light, &hit->at) *
                   hit_square_distance(hit->at.p, ray->from.p) * ray->ends;
    double own = ray->pdf * cos;
    return rgb_scale(rgb_mul(ray->throughput, emission), own / (own + other));
}

/* What comes from infinity along the ray: a light met by chance, without distance or
 * cosine. */
static inline struct rgb escaped_emission(const struct scene *scene,
                                          const struct ray_state *ray)
{
    const struct light *light = scene->environment;
    struct ray_endpoint at = {.ng = vec3_neg(ray->w)};
    struct rgb value = rgb_mul(ray->throughput, light_emission(light, &at, at.ng));
    double other = ray->specular ? 0.0 : light_pdf_point(light, &at) * ray->ends;
    return rgb_scale(value, ray->pdf / (ray->pdf + other));
}

/* Whether shading and geometric normal agree that wo -> w reflects or transmits. */
static inline bool sides_agree(const struct hit *hit, struct vec3 wo, struct vec3 w,
                               float wo_z, float w_z, bool shading_normals)
{
    if (!shading_normals)
        return true;
    float geometric = vec3_dot(hit->at.ng, wo) * vec3_dot(hit->at.ng, w);
    return (geometric > 0.0f) == (wo_z * w_z > 0.0f);
}

/* From a to b, rounded to float once, as an edge is (path/edge.h). */
static inline struct vec3 rounded_direction(struct vec3 a, struct vec3 b, double square)
{
    struct vec3 d = vec3_sub(b, a);
    double inverse = 1.0 / sqrt(square);
    return vec3((float)((double)d.x * inverse), (float)((double)d.y * inverse),
                (float)((double)d.z * inverse));
}

/* The straight lobe of what was hit, which passes light (path/passage.h). */
static inline bool passes(const struct hit *hit, struct vec3 w, struct bsdf_straight *s)
{
    return hit->light < 0 &&
           bsdf_straight(hit->bsdf, frame_to_local(&hit->shading, w), s);
}

static inline void evaluate_textures(struct hit *hit, struct bsdf_nodes *nodes)
{
    if (hit->bsdf->flags & BSDF_TEXTURED)
        hit->bsdf = hit_bsdf(hit, nodes);
}

/* Transmittance and chance of walks of all that lies between a hit and a light's point;
 * false if something else does. The light's own surface ends the way. */
static inline bool passed(const struct scene *scene, const struct ray_endpoint *from,
                          const struct ray_endpoint *to, struct vec3 w,
                          struct bsdf_straight *all)
{
    struct ray_endpoint at = *from;
    struct bsdf_nodes nodes;
    struct bsdf_straight s;
    struct hit hit;
    double length = sqrt(hit_square_distance(from->p, to->p));
    *all = (struct bsdf_straight){{1.0, 1.0, 1.0}, 1.0};
    if (!scene->needs.straight)
        return accel_visible(scene, from, to);
    while (accel_intersect(scene, &at, w, &hit) &&
           sqrt(hit_square_distance(from->p, hit.at.p)) < length * (1.0 - 1e-4)) {
        evaluate_textures(&hit, &nodes);
        if (!passes(&hit, w, &s))
            return false;
        all->transmittance = rgb_mul(all->transmittance, s.transmittance);
        all->chance *= s.chance;
        at = hit.at;
    }
    return true;
}

/* Next-event estimation at a hit, weighted against hitting the light by chance. */
static inline struct rgb direct_light(const struct scene *scene,
                                      const struct ray_state *ray, const struct hit *hit,
                                      struct vec3 wo_local, const double u[3])
{
    const struct rgb none = {0.0, 0.0, 0.0};
    struct hit sampled;
    const struct light *light = light_sample(scene, u[0], u + 1, &sampled);
    struct ray_endpoint point = sampled.at;
    if (light->infinite)
        point.p = vec3_mad(hit->at.p, (float)(-2.0 * light->sphere.radius), point.ng);
    double square = hit_square_distance(point.p, hit->at.p);
    if (!(square > 0.0))
        return none;
    struct vec3 w = light->infinite ? vec3_neg(point.ng)
                                    : rounded_direction(hit->at.p, point.p, square);
    struct rgb emission = light_emission(light, &point, vec3_neg(w));
    if (rgb_is_black(emission))
        return none;
    struct vec3 wi = frame_to_local(&hit->shading, w);
    struct bsdf_value f;
    if (!sides_agree(hit, vec3_neg(ray->w), w, wo_local.z, wi.z,
                     scene->needs.shading_normals) ||
        !bsdf_eval(hit->bsdf, wo_local, wi, TRANSPORT_RADIANCE, &f))
        return none;
    bool delta = light->delta_position;
    double cos_light = delta ? 1.0 : fabs((double)vec3_dot(point.ng, w));
    struct bsdf_straight between;
    if (!(cos_light > 0.0) || !passed(scene, &hit->at, &point, w, &between))
        return none;
    double own = light_pdf_point(light, &point) * (light->infinite ? 1.0 : square) *
                 ray->ends_hit;
    double other = delta ? 0.0 : f.pdf * cos_light * between.chance;
    emission = rgb_mul(emission, between.transmittance);
    double scale = cos_light * fabs((double)wi.z) / (own + other);
    return rgb_scale(rgb_mul(rgb_mul(ray->throughput, f.f), emission), scale);
}

static inline bool scatter(struct ray_state *ray, const struct hit *hit,
                           struct vec3 wo_local, const double u[3], bool shading_normals)
{
    struct bsdf_sample s;
    if (!bsdf_sample(hit->bsdf, wo_local, u, TRANSPORT_RADIANCE, &s))
        return false;
    struct vec3 w = frame_to_world(&hit->shading, s.wi);
    if (!s.delta &&
        !sides_agree(hit, vec3_neg(ray->w), w, wo_local.z, s.wi.z, shading_normals))
        return false;
    ray->from = hit->at;
    ray->w = w;
    ray->pdf = s.pdf;
    ray->specular = s.delta;
    ray->ends = ray->ends_hit;
    ray->throughput = rgb_mul(ray->throughput, s.weight);
    return true;
}

static inline struct ray_state camera_ray(const struct subpaths *paths,
                                          struct ustream *numbers, int32_t *pixel)
{
    static const double centre[2] = {0.5, 0.5};
    const struct scene *scene = paths->scene;
    struct ray_state ray = {.specular = true, .throughput = {1.0, 1.0, 1.0}};
    const double *film = ustream_take(numbers, DIMS_FILM, 2);
    const double u[2] = {film[0], film[1]};
    const double *lens = scene->needs.lens ? ustream_take(numbers, DIMS_LENS, 2) : centre;
    ray.from = camera_sample_lens(&scene->camera, lens);
    *pixel = camera_sample_direction(&scene->camera, &ray.from, u, &ray.w, &ray.pdf);
    return ray;
}

/* The next surface that the ray does not pass; false if it leaves the scene. */
static inline bool next_surface(const struct scene *scene, struct ustream *numbers,
                                int place, struct ray_state *ray, struct hit *hit,
                                struct bsdf_nodes *nodes)
{
    struct ray_endpoint at = ray->from;
    struct bsdf_straight s;
    ray->lobe = -1.0;
    ray->ends_hit = 1.0;
    while (accel_intersect(scene, &at, ray->w, hit)) {
        evaluate_textures(hit, nodes);
        if (!passes(hit, ray->w, &s))
            return true;
        if (s.chance < 1.0 && ray->lobe < 0.0)
            ray->lobe = *ustream_take(numbers, place, 1);
        if (s.chance < 1.0 && ray->lobe >= s.chance) {
            ray->ends_hit = 1.0 - s.chance;
            return true;
        }
        ray->lobe = s.chance < 1.0 ? ray->lobe / s.chance : ray->lobe;
        ray->pdf *= s.chance;
        ray->throughput = rgb_mul(ray->throughput,
                                  rgb_scale(s.transmittance, 1.0 / s.chance));
        at = hit->at;
    }
    return false;
}

static inline void pt_oracle(struct subpaths *paths, const struct numbers *numbers,
                             struct contrib *out)
{
    const struct scene *scene = paths->scene;
    struct rgb sum = {0.0, 0.0, 0.0};
    struct hit hit;
    struct bsdf_nodes nodes;
    contrib_clear(out);
    struct ray_state ray = camera_ray(paths, numbers->camera, &paths->pixel);
    for (int edges = 1; edges <= paths->max_depth; edges++) {
        int place = DIMS_CAMERA_VERTEX + 3 * (edges - 1);
        if (!next_surface(scene, numbers->camera, place, &ray, &hit, &nodes)) {
            if (scene->environment)
                sum = rgb_add(sum, escaped_emission(scene, &ray));
            break;
        }
        if (hit.light >= 0)
            sum = rgb_add(sum, hit_emission(scene, &ray, &hit));
        unsigned flags = hit.bsdf->flags;
        if (edges == paths->max_depth || flags & BSDF_BLACK)
            break;
        struct vec3 wo_local = frame_to_local(&hit.shading, vec3_neg(ray.w));
        double u[3];
        if (!(flags & BSDF_DELTA)) {
            dims_light(numbers->connect, DIMS_DIRECT + 3 * (edges - 1),
                       paths->many_lights, u);
            sum = rgb_add(sum, direct_light(scene, &ray, &hit, wo_local, u));
        }
        if (edges + 1 == paths->max_depth && !scene->needs.light_hits)
            break;
        flags |= paths->keep;
        if (ray.lobe >= 0.0)
            flags &= ~(unsigned)BSDF_U_LOBE;
        dims_scatter(numbers->camera, DIMS_CAMERA_VERTEX, edges, flags, u);
        if (ray.lobe >= 0.0)
            u[0] = ray.lobe;
        if (!scatter(&ray, &hit, wo_local, u, scene->needs.shading_normals))
            break;
    }
    contrib_add(out, paths->pixel, sum, 0, 0);
}

#endif

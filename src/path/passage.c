#include "path/passage.h"

#include "math/warp.h"

bool passage_straight(const struct hit *hit, struct vec3 w, struct bsdf_straight *out)
{
    return hit->light < 0 &&
           bsdf_straight(hit->bsdf, frame_to_local(&hit->shading, w), out);
}

double passage_end_chance(const struct vertex *v, struct vec3 w)
{
    struct bsdf_straight s;
    return v->kind == VERTEX_SURFACE && passage_straight(&v->hit, w, &s) ? 1.0 - s.chance
                                                                         : 1.0;
}

/* Whether a surface may be passed after so many others on the same edge. */
static bool may_pass(const struct scene *scene, int crossed)
{
    if (crossed < PASSAGE_MOST)
        return true;
    __atomic_fetch_add(scene->edges_cut, 1, __ATOMIC_RELAXED);
    return false;
}

bool passage_cross(const struct subpaths *paths, struct accel_segment *segment,
                   struct vec3 w, struct bsdf_straight *product, int *crossed)
{
    struct hit hit;
    *product = (struct bsdf_straight){{1.0, 1.0, 1.0}, 1.0};
    for (*crossed = 0; accel_next(paths->scene, segment, &hit); ++*crossed) {
        struct bsdf_straight s;
        hit_evaluate_textures(&hit, paths->passed);
        if (!passage_straight(&hit, w, &s) || !may_pass(paths->scene, *crossed))
            return false;
        product->transmittance = rgb_mul(product->transmittance, s.transmittance);
        product->chance *= s.chance;
    }
    return true;
}

struct rgb passage_escape(const struct scene *scene, const struct ray_endpoint *from,
                          struct vec3 w)
{
    struct rgb transmittance = rgb_grey(1.0);
    struct ray_endpoint at = *from;
    struct bsdf_nodes nodes;
    struct hit hit;
    for (int crossed = 0; accel_intersect(scene, &at, w, &hit); crossed++) {
        struct bsdf_straight s;
        if (hit.light >= 0 &&
            (scene->lights[hit.light].two_sided || vec3_dot(hit.at.ng, w) < 0.0f))
            return transmittance;
        hit_evaluate_textures(&hit, &nodes);
        if (!passage_straight(&hit, w, &s) || !may_pass(scene, crossed))
            return rgb_grey(0.0);
        transmittance = rgb_mul(transmittance, s.transmittance);
        at = hit.at;
    }
    return transmittance;
}

enum failure passage_between(const struct subpaths *paths, const struct vertex *y,
                             const struct vertex *z, struct vec3 w,
                             struct passage *passage)
{
    struct accel_segment segment;
    struct bsdf_straight product = {{1.0, 1.0, 1.0}, 1.0};
    int crossed;
    if (!accel_unblocked(paths->scene, &y->hit.at, &z->hit.at, &segment) ||
        (segment.passing && !passage_cross(paths, &segment, w, &product, &crossed)))
        return FAILURE_BLOCKED;
    double ends = y->end_chance * z->end_chance;
    *passage = (struct passage){.value = rgb_scale(product.transmittance, 1.0 / ends),
                                .density = product.chance / ends,
                                .end_y = passage_end_chance(y, w),
                                .end_z = passage_end_chance(z, w)};
    return FAILURE_NONE;
}

/* Decides whether the walk passes, with what is left of its number; if so, makes that a
 * part of the step. */
static bool decide(struct subpaths *paths, const struct bsdf_straight *s,
                   struct ustream *numbers, int place, struct scatter_step *d)
{
    if (s->chance < 1.0) {
        if (paths->lobe < 0.0)
            paths->lobe = *ustream_take(numbers, place, 1);
        if (paths->lobe >= s->chance)
            return false;
        paths->lobe = fmin(paths->lobe / s->chance, WARP_BELOW_ONE);
    }
    d->throughput = rgb_scale(rgb_mul(d->throughput, s->transmittance), 1.0 / s->chance);
    /* Both densities of the edge: that of v, and that of `from` as seen from v. */
    d->pdf *= s->chance;
    d->tail_over_pdf *= s->chance;
    return true;
}

enum accel_result passage_trace(struct subpaths *paths, const struct ray_endpoint *from,
                                struct scatter_step *d, struct ustream *numbers,
                                int place, enum hit_filter filter, struct vertex *v)
{
    struct ray_endpoint at = *from;
    paths->lobe = -1.0;
    for (int crossed = 0;; crossed++) {
        struct bsdf_straight s;
        if (accel_trace(paths->scene, &at, d->w, HIT_ANY, &v->hit) == ACCEL_MISS)
            return ACCEL_MISS;
        if (paths->nodes)
            hit_evaluate_textures(&v->hit, &paths->nodes[v - paths->camera]);
        v->end_chance = 1.0;
        if (!passage_straight(&v->hit, d->w, &s))
            break;
        if (!decide(paths, &s, numbers, place, d)) {
            v->end_chance = 1.0 - s.chance;
            break;
        }
        if (!may_pass(paths->scene, crossed))
            return ACCEL_FILTERED_OUT;
        at = v->hit.at;
    }
    return hit_filter_passes(&v->hit, filter) ? ACCEL_HIT : ACCEL_FILTERED_OUT;
}

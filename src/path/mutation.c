#include "path/mutation.h"

#include "math/warp.h"

const struct mutation *const mutation_types[MUTATIONS] = {
    &mutation_lens,          &mutation_caustic,      &mutation_multichain,
    &mutation_bidirectional, &mutation_lens_subpath,
};

enum failure mutation_propose(const struct mutation *type, struct path_space *space,
                              const struct mutation_options *o, const struct full_path *x,
                              struct mutation_random *random, struct full_path *y,
                              struct scaled *ratio)
{
    enum failure failure = type->propose(space, o, x, random, y, ratio);
    if (failure == FAILURE_NONE && type->density)
        *ratio = scaled_div(type->density(x), type->density(y));
    return failure;
}

/* --- kernels ------------------------------------------------------------------------ */

double mutation_distance(const double range[2], double u)
{
    /* R = r2 exp(-log(r2/r1) xi) [Veach97, section 11.4.3; CMU17]. */
    return range[1] * exp(-log(range[1] / range[0]) * u);
}

struct vec3 mutation_turn(struct vec3 w, double angle, double u)
{
    struct frame frame = frame_from_normal(w);
    struct vec2 round = warp_circle(u);
    double sine = sin(angle);
    struct vec3 local = {(float)(sine * round.x), (float)(sine * round.y),
                         (float)cos(angle)};
    return vec3_normalize(frame_to_world(&frame, local));
}

struct vec3 mutation_offset(struct vec3 w, double distance, double u)
{
    struct frame frame = frame_from_normal(w);
    struct vec2 round = warp_circle(u);
    struct vec3 local = {(float)(distance * round.x), (float)(distance * round.y), 0.0f};
    return frame_to_world(&frame, local);
}

/* --- rays --------------------------------------------------------------------------- */

/* Whether a walk (rng) passes the surface, or a path that passes another `left`. False as
 * well where the latter cannot. */
static bool passes(struct path_space *space, const struct hit *hit, struct vec3 w,
                   struct rng *rng, int left, struct bsdf_straight *s)
{
    struct hit pane = *hit;
    if (rng ? !space->paths.passed : left == 0)
        return false;
    pane.bsdf = full_path_bsdf(space, hit);
    return passage_straight(&pane, w, s) && (!rng || rng_double(rng) < s->chance);
}

/* The next hit after surfaces that are passed, whose product is *passed: *crossed of
 * them, or, with rng, as many as a walk passes, which is returned there. */
static enum accel_result trace(struct path_space *space, const struct ray_endpoint *from,
                               struct vec3 w, int *crossed, struct rng *rng,
                               struct hit *hit, struct bsdf_straight *passed)
{
    struct ray_endpoint at = *from;
    int wanted = *crossed;
    *passed = (struct bsdf_straight){{1.0, 1.0, 1.0}, 1.0};
    enum accel_result found = ACCEL_MISS;
    for (*crossed = 0; *crossed <= PASSAGE_MOST; ++*crossed) {
        struct bsdf_straight s;
        space->rays++;
        found = accel_trace(space->paths.scene, &at, w, HIT_ANY, hit);
        if (found != ACCEL_HIT || !passes(space, hit, w, rng, wanted - *crossed, &s))
            break;
        passed->transmittance = rgb_mul(passed->transmittance, s.transmittance);
        passed->chance *= s.chance;
        at = hit->at;
    }
    return rng || *crossed == wanted ? found : ACCEL_FILTERED_OUT;
}

/* The point at infinity that a path meets which leaves the scene along w. */
static bool end_outside(const struct scene *scene, struct vec3 w, struct full_vertex *v)
{
    if (!scene->environment)
        return false;
    v->kind = VERTEX_LIGHT;
    v->light = (int32_t)(scene->environment - scene->lights);
    v->hit = (struct hit){
        .at = {.ng = vec3_neg(w)}, .bsdf = &bsdf_nothing, .light = -1, .shape = -1};
    return true;
}

/* Makes y's edge i, along w or -w, and the vertex at its far end. */
static bool set_edge(struct path_space *space, const struct ray_endpoint *from,
                     struct vec3 w, int i, enum side side, enum accel_result found,
                     const struct hit *hit, const struct bsdf_straight *passed,
                     struct full_path *y)
{
    const struct scene *scene = space->paths.scene;
    int to = side == SIDE_CAMERA ? i + 1 : i;
    bool last = to == y->edges;
    struct full_vertex *v = &y->x[to], *edge = &y->x[i];
    v->lobe[SIDE_CAMERA] = v->lobe[SIDE_LIGHT] = 0.0;
    if (found == ACCEL_HIT) {
        v->kind = VERTEX_SURFACE;
        v->light = hit->light;
        v->hit = *hit;
        if (last ? hit->light < 0 : (hit->bsdf->flags & BSDF_BLACK) != 0)
            return false;
    } else if (found != ACCEL_MISS || !last || !end_outside(scene, w, v)) {
        return false;
    }
    edge->edge.w = side == SIDE_CAMERA ? w : vec3_neg(w);
    edge->transmittance = passed->transmittance;
    edge->chance = passed->chance;
    const struct full_vertex *light = &y->x[y->edges];
    bool parallel = (i + 1 == y->edges && light->kind == VERTEX_LIGHT &&
                     scene->lights[light->light].infinite) ||
                    (i == 0 && scene->camera.orthographic);
    edge->edge.inverse_square = parallel ? 1.0 : inverse_square_between(from, &v->hit.at);
    return isfinite(edge->edge.inverse_square);
}

bool mutation_follow(struct path_space *space, const struct ray_endpoint *from,
                     struct vec3 w, const struct full_path *x, int i, enum side side,
                     struct rng *rng, struct full_path *y)
{
    int to = side == SIDE_CAMERA ? i + 1 : i, crossed = x ? x->x[i].crossed : 0;
    struct hit hit;
    struct bsdf_straight passed;
    enum accel_result found = trace(space, from, w, &crossed, x ? NULL : rng, &hit,
                                    &passed);
    y->x[to].delta = x && to < x->edges && x->x[to].delta;
    y->x[to].transmits = x && x->x[to].transmits;
    y->x[i].crossed = crossed;
    return set_edge(space, from, w, i, side, found, &hit, &passed, y);
}

enum failure mutation_finish(struct path_space *space, struct full_path *y, int l, int m,
                             int t)
{
    int k = y->edges;
    bool hit = t > k;
    enum failure failure = FAILURE_NONE;
    if (!hit) {
        y->x[t - 1].delta = y->x[t].delta = false;
        failure = full_path_edge(space, y, t - 1);
    }
    for (int i = l > 1 ? l : 1; failure == FAILURE_NONE && i <= m && i < k; i++)
        failure = full_path_scatter(space, y, i);
    if (failure == FAILURE_NONE && m >= k)
        failure = full_path_emit(space, y);
    if (failure == FAILURE_NONE && !(full_path_connects(space, y, t) > 0.0))
        failure = FAILURE_ZERO;
    if (failure == FAILURE_NONE && !hit)
        failure = full_path_unobstructed(space, y, t - 1);
    return failure;
}

/* --- lobes -------------------------------------------------------------------------- */

/* Numbers that are tried for a lobe, in this order: the ends of [0,1), where a material
 * of two lobes has them, then its parts. */
static const double lobe_numbers[] = {0.0,   WARP_BELOW_ONE, 0.5,   0.25, 0.75,
                                      0.125, 0.375,          0.625, 0.875};
#define LOBE_NUMBERS (sizeof lobe_numbers / sizeof lobe_numbers[0])

/* The first delta lobe found that leaves on the side wanted. A function of the vertex
 * and of that side alone, so that the way back finds the lobe of the way forth. */
static bool find_lobe(const struct bsdf *bsdf, struct vec3 wo, bool transmits,
                      enum transport mode, struct bsdf_sample *s)
{
    for (size_t i = 0; i < LOBE_NUMBERS; i++) {
        double u[3] = {lobe_numbers[i], 0.5, 0.5};
        if (bsdf_sample(bsdf, wo, u, mode, s) && s->delta &&
            (wo.z * s->wi.z < 0.0f) == transmits)
            return true;
    }
    return false;
}

bool mutation_lobe(struct path_space *space, struct full_path *y, int i, enum side side,
                   struct vec3 *w)
{
    struct full_vertex *v = &y->x[i];
    struct vec3 wo = frame_to_local(&v->hit.shading, vec3_neg(*w));
    struct bsdf_sample s;
    if (!find_lobe(full_path_bsdf(space, &v->hit), wo, v->transmits,
                   mutation_transport(side), &s))
        return false;
    *w = frame_to_world(&v->hit.shading, s.wi);
    full_path_set_delta(v, &s, wo, side);
    v->lobe[side] = s.pdf;
    return v->pdf_to_light > 0.0 && v->pdf_to_camera > 0.0;
}

/* Two lobes into one direction differ in what they weigh. */
#define SAME_DIRECTION 1e-4 /* of |w - w'|^2: half a degree */
#define SAME_WEIGHT    0.02 /* relative */

static bool is_repeated(struct path_space *space, const struct full_vertex *v,
                        enum side side, double *chance)
{
    struct vec3 local[2] = {frame_to_local(&v->hit.shading, vec3_neg(v[-1].edge.w)),
                            frame_to_local(&v->hit.shading, v->edge.w)};
    struct vec3 wo = local[side], wi = local[1 - side];
    struct bsdf_sample s;
    if (!find_lobe(full_path_bsdf(space, &v->hit), wo, v->transmits,
                   mutation_transport(side), &s))
        return false;
    struct vec3 apart = vec3_sub(s.wi, wi);
    double weight = rgb_luminance(v->value) / v->pdf_to_light;
    if (side == SIDE_LIGHT)
        weight = rgb_luminance(v->value) / v->pdf_to_camera *
                 fabs((double)wi.z / (double)wo.z);
    *chance = s.pdf;
    double expected = rgb_luminance(s.weight);
    return (double)vec3_dot(apart, apart) < SAME_DIRECTION &&
           fabs(weight - expected) < SAME_WEIGHT * expected;
}

bool mutation_repeats(struct path_space *space, struct full_path *x, int i,
                      enum side side)
{
    struct full_vertex *v = &x->x[i];
    if (v->lobe[side] == 0.0) {
        double chance = -1.0;
        v->lobe[side] = is_repeated(space, v, side, &chance) ? chance : -1.0;
    }
    return v->lobe[side] > 0.0;
}

double mutation_lobe_pdf(const struct full_path *path, int i, enum side side)
{
    const struct full_vertex *v = &path->x[i];
    double pdf = side == SIDE_CAMERA ? v->pdf_to_light : v->pdf_to_camera;
    return pdf / v->lobe[side];
}

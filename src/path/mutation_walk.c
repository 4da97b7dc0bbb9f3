/* Walks from vertices that are kept, or from a new lens or light point, as independent
 * bidirectional sampling makes them (path/full_path.h). */

#include "math/warp.h"
#include "path/mutation.h"

bool mutation_leave_surface(struct path_space *space, struct full_path *y, int i,
                            enum side side, bool kept, struct rng *rng, struct vec3 *w)
{
    struct full_vertex *v = &y->x[i];
    const struct bsdf *bsdf = full_path_bsdf(space, &v->hit);
    struct vec3 from = side == SIDE_CAMERA ? vec3_neg(v[-1].edge.w) : v->edge.w;
    struct vec3 wo = frame_to_local(&v->hit.shading, from);
    struct bsdf_straight straight;
    struct bsdf_sample s;
    double u[3] = {rng_double(rng), rng_double(rng), rng_double(rng)};
    /* A walk that stopped here has decided not to pass: path/passage.h. */
    if (!kept && v->hit.light < 0 && bsdf_straight(bsdf, wo, &straight))
        u[0] = fmin(straight.chance + (1.0 - straight.chance) * u[0], WARP_BELOW_ONE);
    if (!bsdf_sample(bsdf, wo, u, mutation_transport(side), &s))
        return false;
    *w = frame_to_world(&v->hit.shading, s.wi);
    v->delta = s.delta;
    v->lobe[SIDE_CAMERA] = v->lobe[SIDE_LIGHT] = 0.0;
    if (s.delta) {
        v->transmits = wo.z * s.wi.z < 0.0f;
        full_path_set_delta(v, &s, wo, side);
    }
    /* Straight on from a kept vertex that is passed is no event of a path. */
    return !(s.delta && kept && v->hit.light < 0 && bsdf_straight(bsdf, wo, &straight) &&
             u[0] < straight.chance);
}

struct vec3 mutation_leave_lens(struct path_space *space, struct full_path *y)
{
    struct vec3 w = y->x[0].edge.w;
    y->pixel = camera_move(&space->paths.scene->camera, &y->x[0].hit.at, y->film, &w,
                           &y->pdf_film);
    return w;
}

void mutation_new_lens(struct path_space *space, struct full_path *y, struct rng *rng)
{
    const struct camera *camera = &space->paths.scene->camera;
    double u[2] = {rng_double(rng), rng_double(rng)};
    struct full_vertex *v = &y->x[0];
    *v = (struct full_vertex){.kind = VERTEX_CAMERA, .light = -1};
    v->hit = (struct hit){.at = camera_sample_lens(camera, u),
                          .bsdf = &bsdf_nothing,
                          .light = -1,
                          .shape = -1};
    if (camera->orthographic)
        v->edge.w = camera_parallel(camera, &v->hit.at);
}

static void new_light(struct path_space *space, struct full_path *y, struct rng *rng)
{
    const struct scene *scene = space->paths.scene;
    double pick = rng_double(rng), u[2] = {rng_double(rng), rng_double(rng)};
    struct full_vertex *v = &y->x[y->edges];
    *v = (struct full_vertex){.kind = VERTEX_LIGHT};
    v->hit = (struct hit){.bsdf = &bsdf_nothing, .light = -1, .shape = -1};
    v->light = (int32_t)(light_sample(scene, pick, u, &v->hit) - scene->lights);
}

static bool leave_light(struct path_space *space, struct full_path *y, struct rng *rng,
                        struct ray_endpoint *start, struct vec3 *w)
{
    const struct full_vertex *v = &y->x[y->edges];
    const struct light *light = &space->paths.scene->lights[v->light];
    double u[2] = {rng_double(rng), rng_double(rng)}, pdf;
    struct rgb weight;
    *start = v->hit.at;
    return light->type->sample_direction(light, start, u, w, &pdf, &weight);
}

bool mutation_walk_camera(struct path_space *space, struct full_path *y, int l, int end,
                          struct rng *rng)
{
    if (l < 0 && end >= 0)
        mutation_new_lens(space, y, rng);
    for (int i = l < 0 ? 0 : l; i < end; i++) {
        struct vec3 w;
        if (i == 0) {
            y->film[0] = rng_double(rng);
            y->film[1] = rng_double(rng);
            w = mutation_leave_lens(space, y);
        } else if (!mutation_leave_surface(space, y, i, SIDE_CAMERA, i == l, rng, &w)) {
            return false;
        }
        if (!mutation_follow(space, &y->x[i].hit.at, w, NULL, i, SIDE_CAMERA, rng, y))
            return false;
    }
    return true;
}

bool mutation_walk_light(struct path_space *space, struct full_path *y, int m, int end,
                         struct rng *rng)
{
    int k = y->edges;
    if (m > k && end <= k)
        new_light(space, y, rng);
    for (int i = m > k ? k : m; i > end; i--) {
        struct ray_endpoint start = y->x[i].hit.at;
        struct vec3 w;
        if (i == k ? !leave_light(space, y, rng, &start, &w)
                   : !mutation_leave_surface(space, y, i, SIDE_LIGHT, i == m, rng, &w))
            return false;
        if (!mutation_follow(space, &start, w, NULL, i - 1, SIDE_LIGHT, rng, y))
            return false;
    }
    return true;
}

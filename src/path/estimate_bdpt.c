#include "path/estimate.h"
#include "path/estimate_join.h"
#include "path/estimate_roulette.h"

/* Collects weighted connections: a splat each, or summed for the camera's pixel. */
struct collector {
    struct contrib *out;
    struct rgb sum;
    bool techniques;
};

static void collect(struct collector *c, const struct connection *x, int s, int t)
{
    struct rgb value = rgb_scale(x->value, x->weight);
    if (c->techniques)
        contrib_add_technique(c->out, x->pixel, value, s, t, x->weight);
    else if (t == 1)
        contrib_add(c->out, x->pixel, value, s, t);
    else
        c->sum = rgb_add(c->sum, value);
}

/* The same of a connection from y whose visibility may not have been tested yet. */
static inline void collect_or_wait(const struct subpaths *paths, struct collector *c,
                                   const struct connection *x, int s, int t,
                                   const struct ray_endpoint *y)
{
    if (x->untested)
        roulette_add(paths->roulette, x, s, t, y);
    else
        collect(c, x, s, t);
}

/* s = 1 where the connection may have to wait, so that the light's point is kept. Apart,
 * so that nothing is kept where none waits. */
static __attribute__((noinline)) void connect_light_kept(const struct subpaths *paths,
                                                         const double u[3], int t,
                                                         struct collector *c)
{
    struct connection x;
    struct vertex point;
    if (connect_light(paths, u, &paths->camera[t - 1], MIS_BIDIRECTIONAL, &x, &point) ==
        FAILURE_NONE)
        collect_or_wait(paths, c, &x, 1, t, &point.hit.at);
}

/* All techniques whose camera side ends at z = camera[t-1]. */
static void connect_vertex(const struct subpaths *paths, struct ustream *direct, int t,
                           struct collector *c)
{
    const struct vertex *z = &paths->camera[t - 1];
    struct connection x;
    if (connect_hit(paths, z, t - 1, MIS_BIDIRECTIONAL, &x) == FAILURE_NONE)
        collect(c, &x, 0, t);
    if (!z->connectible || t > paths->max_depth)
        return;
    double u[3];
    dims_light(direct, DIMS_DIRECT + 3 * (t - 2), paths->many_lights, u);
    if (paths->blind)
        connect_light_kept(paths, u, t, c);
    else if (connect_light(paths, u, z, MIS_BIDIRECTIONAL, &x, NULL) == FAILURE_NONE)
        collect(c, &x, 1, t);
    int most = paths->max_depth + 1 - t;
    for (int s = 2; s <= most && s <= paths->light_count; s++) {
        const struct vertex *y = &paths->light[s - 1];
        if (!y->connectible)
            continue;
        c->out->connections++;
        if (connect_surfaces(paths, y, z, &x) == FAILURE_NONE)
            collect_or_wait(paths, c, &x, s, t, &y->hit.at);
    }
}

/* Visibility of a connection that waits. Where edges pass surfaces it is made again, as
 * what it passes changes its value and weight. */
static bool test_pending(const struct subpaths *paths, struct pending *p)
{
    if (!paths->passed)
        return accel_visible(paths->scene, &p->y, &paths->camera[p->t - 1].hit.at);
    const struct vertex *y = &paths->light[p->s - 1];
    enum failure failure = p->t == 1 ? connect_camera(paths, y, &p->x)
                                     : connect_surfaces(paths, y,
                                                        &paths->camera[p->t - 1], &p->x);
    return failure == FAILURE_NONE;
}

static void collect_pending(struct subpaths *paths, struct ustream *connect,
                            struct collector *c)
{
    struct roulette *roulette = paths->roulette;
    paths->blind = false;
    roulette_choose(roulette, c->out->target + rgb_luminance(c->sum), connect);
    for (int i = 0; i < roulette->count; i++) {
        struct pending *p = &roulette->pending[i];
        if (!test_pending(paths, p))
            continue;
        p->x.value = rgb_scale(p->x.value, 1.0 / p->chance);
        collect(c, &p->x, p->s, p->t);
    }
    roulette->count = 0;
}

static void estimate(struct subpaths *paths, const struct numbers *numbers,
                     struct contrib *out, bool techniques)
{
    struct collector c = {.out = out, .techniques = techniques};
    struct connection x;
    const struct needs *needs = &paths->scene->needs;
    contrib_clear(out);
    walk_camera(paths, numbers->camera, paths->max_depth + 1, HIT_ANY);
    walk_light(paths, numbers->light, needs->camera_connections ? paths->max_depth : 0,
               HIT_ANY);
    paths->blind = paths->roulette != NULL;
    for (int s = 2; s <= paths->light_count; s++) {
        const struct vertex *y = &paths->light[s - 1];
        if (!y->connectible)
            continue;
        out->connections++;
        if (connect_camera(paths, y, &x) == FAILURE_NONE)
            collect_or_wait(paths, &c, &x, s, 1, &y->hit.at);
    }
    for (int t = 2; t <= paths->camera_count; t++)
        connect_vertex(paths, numbers->connect, t, &c);
    if (paths->blind)
        collect_pending(paths, numbers->connect, &c);
    contrib_add(out, paths->pixel, c.sum, 0, 0);
    out->nonfinite += paths->nonfinite;
    paths->nonfinite = 0;
}

void estimate_bdpt(struct subpaths *paths, const struct numbers *numbers,
                   struct contrib *out)
{
    estimate(paths, numbers, out, false);
}

void estimate_bdpt_techniques(struct subpaths *paths, const struct numbers *numbers,
                              struct contrib *out)
{
    estimate(paths, numbers, out, true);
}

void estimate_bdpt_layers(struct subpaths *paths, const struct numbers *numbers,
                          struct contrib *out)
{
    estimate_bdpt_techniques(paths, numbers, out);
    estimate_join_techniques(out);
}

int estimate_splats(int max_depth)
{
    return max_depth + 2;
}

int estimate_splats_techniques(int max_depth)
{
    return (max_depth + 2) * (max_depth + 3) / 2 + 1;
}

#include "path/connect.h"
#include "path/estimate.h"
#include "path/estimate_join.h"

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
    if (connect_light(paths, u, z, MIS_BIDIRECTIONAL, &x, NULL) == FAILURE_NONE)
        collect(c, &x, 1, t);
    int most = paths->max_depth + 1 - t;
    for (int s = 2; s <= most && s <= paths->light_count; s++) {
        if (!paths->light[s - 1].connectible)
            continue;
        c->out->connections++;
        if (connect_surfaces(paths, &paths->light[s - 1], z, &x) == FAILURE_NONE)
            collect(c, &x, s, t);
    }
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
    for (int s = 2; s <= paths->light_count; s++)
        if (paths->light[s - 1].connectible &&
            connect_camera(paths, &paths->light[s - 1], &x) == FAILURE_NONE)
            collect(&c, &x, s, 1);
    for (int t = 2; t <= paths->camera_count; t++)
        connect_vertex(paths, numbers->connect, t, &c);
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

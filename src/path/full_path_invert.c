/* Numbers of paths that are lists of vertices, however they were made. */

#include "path/full_path.h"
#include "path/invert.h"

/* Of the techniques t = k + 1 to 1, over that of the camera's walk to the light (s = 0),
 * exist it or not; their sum. See full_path_weigh. */
static double find_weights(const struct path_space *space, const struct full_path *path,
                           double weight[DIMS_MAX_DEPTH + 2])
{
    int k = path->edges;
    double ratio = 1.0, sum = 0.0;
    for (int t = k + 1; t >= 1; t--) {
        if (t <= k)
            ratio *= full_path_pdf(path, t, SIDE_LIGHT) /
                     full_path_pdf(path, t, SIDE_CAMERA);
        weight[t] = ratio * full_path_connects(space, path, t);
        sum += weight[t];
    }
    return sum;
}

int full_path_technique(const struct path_space *space, const struct full_path *path,
                        double u)
{
    double weight[DIMS_MAX_DEPTH + 2], sum = find_weights(space, path, weight);
    int last = 0;
    if (!(sum < HUGE_VAL))
        return 0;
    u *= sum;
    for (int t = path->edges + 1; t >= 1; t--) {
        if (!(weight[t] > 0.0))
            continue;
        last = t;
        if (u < weight[t])
            break;
        u -= weight[t];
    }
    return last;
}

/* What inverse sampling reads of a vertex, of which i come before it from the lens. */
static void set_vertex(struct path_space *space, const struct full_vertex *from, int i,
                       struct vertex *v)
{
    struct subpaths *paths = &space->paths;
    v->kind = from->kind;
    v->hit = from->hit;
    v->light = from->light < 0 ? NULL : &paths->scene->lights[from->light];
    v->delta_event = from->delta;
    if (from->kind == VERTEX_SURFACE && paths->nodes)
        hit_evaluate_textures(&v->hit, &paths->nodes[i]);
}

static void set_whole_path(struct path_space *space, const struct full_path *path,
                           struct whole_path *whole)
{
    int k = path->edges;
    whole->scene = space->paths.scene;
    whole->edges = k;
    for (int i = 0; i <= k; i++) {
        struct vertex *v = &space->paths.camera[i];
        set_vertex(space, &path->x[i], i, v);
        whole->x[k - i] = v;
        if (i == k)
            break;
        whole->w[k - 1 - i] = vec3_neg(path->x[i].edge.w);
        whole->pass[k - 1 - i] = path->x[i].chance;
    }
}

#define UNDETERMINED (-1.0)

static struct found begin(struct path_space *space, int edges)
{
    int places[2] = {dims_camera_capacity(edges), dims_light_capacity(edges)};
    for (int side = 0; side < 2; side++)
        for (int i = 0; i < places[side]; i++)
            space->found[side][i] = UNDETERMINED;
    return (struct found){.camera = {0, space->found[SIDE_CAMERA]},
                          .light = {0, space->found[SIDE_LIGHT]}};
}

bool full_path_invert(struct path_space *space, const struct full_path *path, int t,
                      struct rng *rng, struct found *found)
{
    struct whole_path whole;
    set_whole_path(space, path, &whole);
    *found = begin(space, path->edges);
    return invert_all(&whole, path->edges + 1 - t, t, rng, found);
}

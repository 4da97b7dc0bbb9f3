#include "path/invert.h"

/* Where numbers are put: those of one stream at a place. */
static void put(struct found_numbers *to, int place, const double *u, int count)
{
    for (int i = 0; i < count; i++)
        to->value[place + i] = u[i];
}

static void draw(struct rng *rng, double *u, int count)
{
    for (int i = 0; i < count; i++)
        u[i] = rng_double(rng);
}

/* From x[i] to x[to], its neighbour, in the frame of x[i]. */
static struct vec3 direction(const struct whole_path *p, int i, int to)
{
    struct vec3 w = to > i ? p->w[i] : vec3_neg(p->w[i - 1]);
    return frame_to_local(&p->x[i]->hit.shading, w);
}

/* Q of the edge by which a walk comes from x[from] to x[i]. */
static double passed(const struct whole_path *p, int from, int i)
{
    return p->pass[from < i ? from : i];
}

/* The number with which a walk from x[from] passes what it crosses and ends at x[i]. */
static void invert_end(const struct whole_path *p, int from, int i, struct rng *rng,
                       struct found_numbers *out, int place)
{
    double chance = whole_path_end_chance(p, from, i), u = rng_double(rng);
    u = passed(p, from, i) * warp_within(1.0 - chance, 1.0, u);
    put(out, place, &u, 1);
}

/* The numbers of the event at x[i] that sends a walk from x[from] to x[to]. */
static bool invert_event(const struct whole_path *p, int from, int i, int to,
                         struct rng *rng, struct found_numbers *out, int place)
{
    const struct vertex *v = p->x[i];
    double u[3], choice = rng_double(rng);
    draw(rng, u, 3);
    if (!bsdf_invert(v->hit.bsdf, direction(p, i, from), direction(p, i, to),
                     v->delta_event, choice, u))
        return false;
    u[0] *= passed(p, from, i);
    put(out, place, u, 3);
    return true;
}

static bool invert_film(const struct whole_path *p, struct found_numbers *out)
{
    const struct camera *camera = &p->scene->camera;
    const struct vertex *v = p->x[p->edges - 1];
    struct ray_endpoint lens = p->x[p->edges]->hit.at;
    struct vec3 seen = vec3_neg(p->w[p->edges - 1]);
    double u[2];
    if (camera->orthographic && !camera_meet(camera, seen, v->hit.at.p, &lens))
        return false;
    if (!camera_invert_direction(camera, &lens, seen, u))
        return false;
    put(out, DIMS_FILM, u, 2);
    return true;
}

/* From t to more camera vertices. The lens point stays. */
static bool extend_camera(const struct whole_path *p, int t, int more, struct rng *rng,
                          struct found_numbers *out)
{
    if (t == 1 && more > 1 && !invert_film(p, out))
        return false;
    for (int j = t > 2 ? t - 1 : 1; j < more - 1; j++) {
        int i = p->edges - j;
        if (!invert_event(p, i + 1, i, i - 1, rng, out, DIMS_CAMERA_VERTEX + 3 * (j - 1)))
            return false;
    }
    if (more > 1)
        invert_end(p, p->edges - more + 2, p->edges - more + 1, rng, out,
                   DIMS_CAMERA_VERTEX + 3 * (more - 2));
    return true;
}

static bool invert_point(const struct whole_path *p, struct rng *rng,
                         struct found_numbers *out)
{
    const struct vertex *y = p->x[0];
    double u[3];
    draw(rng, u, 3);
    if (!light_invert(p->scene, y->light, &y->hit, &u[0], u + 1))
        return false;
    put(out, DIMS_LIGHT_PICK, u, 3);
    return true;
}

static bool invert_direction(const struct whole_path *p, struct rng *rng,
                             struct found_numbers *out)
{
    const struct vertex *y = p->x[0];
    double u[2];
    draw(rng, u, 2);
    if (!y->light->type->invert_direction(y->light, &y->hit.at, p->w[0],
                                          p->x[1]->hit.at.p, u))
        return false;
    put(out, DIMS_LIGHT_DIRECTION, u, 2);
    return true;
}

/* From s to more light vertices. */
static bool extend_light(const struct whole_path *p, int s, int more, struct rng *rng,
                         struct found_numbers *out)
{
    if ((s == 0 && more > 0 && !invert_point(p, rng, out)) ||
        (s <= 1 && more > 1 && !invert_direction(p, rng, out)))
        return false;
    for (int i = s > 2 ? s - 1 : 1; i < more - 1; i++)
        if (!invert_event(p, i - 1, i, i + 1, rng, out, DIMS_LIGHT_VERTEX + 3 * (i - 1)))
            return false;
    if (more > 1)
        invert_end(p, more - 2, more - 1, rng, out, DIMS_LIGHT_VERTEX + 3 * (more - 2));
    return true;
}

static bool invert_lens(const struct whole_path *p, struct rng *rng,
                        struct found_numbers *out)
{
    double u[2];
    draw(rng, u, 2);
    if (!camera_invert_lens(&p->scene->camera, &p->x[p->edges]->hit.at,
                            vec3_neg(p->w[p->edges - 1]), u))
        return false;
    put(out, DIMS_LENS, u, 2);
    return true;
}

bool invert_all(const struct whole_path *p, int s, int t, struct rng *rng,
                struct found *found)
{
    return invert_lens(p, rng, &found->camera) &&
           extend_camera(p, 1, t, rng, &found->camera) &&
           extend_light(p, 0, s, rng, &found->light);
}

static int least(int a, int b)
{
    return a < b ? a : b;
}

/* Places of the numbers that sub-paths of so many vertices have in common, the lens and
 * the light point included. */
static int camera_places(int t)
{
    return DIMS_CAMERA_VERTEX + (t > 2 ? 3 * (t - 2) : 0);
}

static int light_places(int s)
{
    if (s < 2)
        return s == 0 ? 0 : DIMS_LIGHT_DIRECTION;
    return DIMS_LIGHT_VERTEX + 3 * (s - 2);
}

static bool invert_whole(const struct whole_path *p, const struct techniques *techniques,
                         int index, struct rng *rng, struct found *found)
{
    int s = p->s, t = p->edges + 1 - s;
    int new_t = techniques->t[index], new_s = p->edges + 1 - new_t;
    found->camera.kept = camera_places(least(t, new_t));
    found->light.kept = light_places(least(s, new_s));
    found->connect.kept = 0;
    if (techniques->count > 1)
        found->connect.value[DIMS_TECHNIQUE] = warp_within(
            (double)index / techniques->count, (double)(index + 1) / techniques->count,
            rng_double(rng));
    return extend_camera(p, t, new_t, rng, &found->camera) &&
           extend_light(p, s, new_s, rng, &found->light);
}

/* --- events again, where the walk has come to ----------------------------------------
 */

static void remember(const struct subpaths *paths, const struct whole_path *p,
                     struct rng *rng, struct inverted *to)
{
    to->paths = paths;
    to->rng = rng;
    to->edges = p->edges;
    for (int i = 0; i <= p->edges; i++) {
        const struct vertex *v = p->x[i];
        to->x[i].p = v->hit.at.p;
        to->x[i].is_direction = vertex_is_direction(v, &p->scene->camera);
        to->x[i].delta = v->delta_event;
        if (i < p->edges)
            to->x[i].to_light = vec3_neg(p->w[i]);
    }
}

static bool same_place(struct vec3 a, struct vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* From v to where the vertex `to` was, which lies beyond the edge e. */
static struct vec3 onwards(const struct inverted *p, const struct vertex *v, int to,
                           int e)
{
    if (p->x[to].is_direction)
        return to == e ? p->x[e].to_light : vec3_neg(p->x[e].to_light);
    return vec3_normalize(vec3_sub(p->x[to].p, v->hit.at.p));
}

/* The events of a walk have three numbers each; where the path has a delta event, its
 * lobe is the same. */
static void correct(void *ctx, enum found_stream stream, int place, double *u, int count)
{
    const struct inverted *p = ctx;
    bool light = stream == FOUND_LIGHT;
    int first = light ? DIMS_LIGHT_VERTEX : DIMS_CAMERA_VERTEX;
    if (stream == FOUND_CONNECT || place < first)
        return;
    int vertex = (place - first) / 3 + 1, offset = (place - first) % 3;
    int i = light ? vertex : p->edges - vertex, to = light ? i + 1 : i - 1;
    const struct vertex *v = light ? &p->paths->light[vertex] : &p->paths->camera[vertex];
    /* A lobe's number that has decided whether to pass surfaces (path/passage.h) stays,
     * and so do those that belong to it. */
    bool decided = count == 1 || (offset > 0 && v->hit.bsdf->flags & BSDF_U_LOBE);
    if (p->x[i].delta || decided || same_place(v->hit.at.p, p->x[i].p))
        return;
    struct vec3 w = onwards(p, v, to, light ? i : to);
    double again[3], choice = rng_double(p->rng);
    draw(p->rng, again, 3);
    if (!bsdf_invert(v->hit.bsdf, v->wo_local, frame_to_local(&v->hit.shading, w), false,
                     choice, again))
        return;
    for (int j = 0; j < count; j++)
        u[j] = again[offset + j];
}

static bool invert_path(const struct subpaths *paths, const struct whole_path *p,
                        const struct techniques *techniques, int index, struct rng *rng,
                        struct inverted *inverted, struct found *found)
{
    if (!invert_whole(p, techniques, index, rng, found))
        return false;
    remember(paths, p, rng, inverted);
    found->correct = correct;
    found->ctx = inverted;
    return true;
}

bool invert_to(const struct subpaths *paths, const struct techniques *techniques, int s,
               int t, int index, struct rng *rng, struct inverted *inverted,
               struct found *found)
{
    struct whole_path path;
    return whole_path_collect(paths, s, t, &path) &&
           invert_path(paths, &path, techniques, index, rng, inverted, found);
}

/* The technique with the first sum of weights above u. */
static int draw_technique(const double *weight, int count, double u)
{
    int last = 0;
    for (int i = 0; i < count; i++) {
        if (weight[i] == 0.0)
            continue;
        last = i;
        if (u < weight[i])
            break;
        u -= weight[i];
    }
    return last;
}

enum inversion invert_mmlt(struct subpaths *paths, const struct techniques *techniques,
                           const struct numbers *current, struct rng *rng,
                           struct inverted *inverted, struct found *found,
                           struct contrib *again)
{
    struct whole_path path;
    double weight[DIMS_MAX_DEPTH + 1];
    int t = estimate_mmlt_again(paths, techniques, current, again);
    if (!(again->target > 0.0) ||
        !whole_path_collect(paths, techniques->length + 1 - t, t, &path) ||
        !whole_path_weights(&path, techniques, weight))
        return INVERSION_NONE;
    int index = draw_technique(weight, techniques->count, rng_double(rng));
    if (techniques->t[index] == t)
        return INVERSION_SAME;
    return invert_path(paths, &path, techniques, index, rng, inverted, found)
               ? INVERSION_OTHER
               : INVERSION_NONE;
}

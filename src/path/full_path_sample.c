/* Independent paths: sub-paths of bidirectional path tracing, joined, as lists of
 * vertices. */

#include "base/mem.h"
#include "math/warp.h"
#include "path/connect.h"
#include "path/full_path.h"

/* --- lengths ------------------------------------------------------------------------ */

static bool has_length(const struct path_space *space, int length)
{
    bool hidden = length == 1 && space->paths.scene->hide_emitters;
    return length >= space->first && length <= space->last && !hidden &&
           space->techniques[length].count > 0;
}

/* In proportion to 1/k: short paths carry most light in most scenes, and of long ones
 * none becomes rare, whatever the depth. */
static void length_law(struct path_space *space)
{
    double sum = 0.0;
    for (int k = 1; k <= space->last; k++)
        sum += has_length(space, k) ? 1.0 / k : 0.0;
    for (int k = 1; k <= space->last; k++)
        space->length_pdf[k] = has_length(space, k) ? 1.0 / k / sum : 0.0;
}

static void found_arrays(struct path_space *space, struct mem_plan *plan)
{
    size_t camera = (size_t)dims_camera_capacity(space->last);
    size_t light = (size_t)dims_light_capacity(space->last);
    space->found[SIDE_CAMERA] = mem_take(plan, 0, camera, sizeof(double));
    space->found[SIDE_LIGHT] = mem_take(plan, 0, light, sizeof(double));
}

void path_space_init(struct path_space *space, const struct scene *scene, int first,
                     int last)
{
    *space = (struct path_space){.first = first, .last = last};
    subpaths_init(&space->paths, scene, last);
    full_path_init(&space->sampled, last);
    found_arrays(space, &(struct mem_plan){.take = true});
    for (int k = 1; k <= last; k++)
        techniques_init(&space->techniques[k], &scene->needs, k);
    length_law(space);
}

void path_space_deinit(struct path_space *space)
{
    subpaths_deinit(&space->paths);
    full_path_deinit(&space->sampled);
    for (int i = 0; i < 2; i++)
        mem_free(space->found[i]);
}

double path_space_bytes(const struct scene *scene, int last)
{
    struct mem_plan plan = {.take = false};
    found_arrays(&(struct path_space){.last = last}, &plan);
    return subpaths_bytes(scene, last) + plan.bytes +
           (double)(last + 1) * (double)sizeof(struct full_vertex);
}

/* Uses up *u for the length; what is left of it is uniform again. 0: there is none. */
static int pick_length(const struct path_space *space, double *u)
{
    double below = 0.0;
    int length = 0;
    for (int k = space->first; k <= space->last; k++) {
        if (!(space->length_pdf[k] > 0.0))
            continue;
        if (length > 0)
            below += space->length_pdf[length];
        length = k;
        if (*u < below + space->length_pdf[k])
            break;
    }
    if (length > 0)
        *u = fmin((*u - below) / space->length_pdf[length], WARP_BELOW_ONE);
    return length;
}

/* --- the list ----------------------------------------------------------------------- */

static int32_t light_index(const struct path_space *space, const struct light *light)
{
    return light ? (int32_t)(light - space->paths.scene->lights) : -1;
}

/* Takes over a vertex of a sub-path, with its delta event if the path has it. side: the
 * sub-path's. */
static void take_vertex(const struct path_space *space, const struct vertex *v,
                        bool event, enum side side, struct full_vertex *x)
{
    const struct scene *scene = space->paths.scene;
    *x = (struct full_vertex){
        .kind = v->kind,
        .delta = event && v->delta_event,
        .light = light_index(space, v->light),
        .transmittance = {1.0, 1.0, 1.0},
        .chance = 1.0,
        .hit = {.at = v->hit.at,
                .triangle = v->kind == VERTEX_LIGHT ? v->hit.triangle : 0,
                .light = -1,
                .shape = -1,
                .bsdf = &bsdf_nothing},
    };
    if (v->kind == VERTEX_SURFACE) {
        x->hit = v->hit;
        x->hit.bsdf = scene->shapes[v->hit.shape].bsdf;
    }
    if (!x->delta)
        return;
    /* In units of the walk's own delta: path/full_path.h. */
    x->value = rgb_scale(v->event_weight, v->event_pdf);
    x->pdf_to_light = side == SIDE_CAMERA ? v->event_pdf : v->event_pdf_rev;
    x->pdf_to_camera = side == SIDE_CAMERA ? v->event_pdf_rev : v->event_pdf;
}

/* Edge i as a walk made it, whose later vertex is v. */
static void take_edge(struct full_path *path, int i, struct vec3 w, bool infinite)
{
    struct full_vertex *x = &path->x[i];
    x->edge.w = w;
    x->edge.inverse_square = infinite
                                 ? 1.0
                                 : inverse_square_between(&x[0].hit.at, &x[1].hit.at);
}

static void take_camera_walk(struct path_space *space, struct full_path *path, int t)
{
    const struct subpaths *p = &space->paths;
    for (int i = 0; i < t; i++)
        take_vertex(space, &p->camera[i], i + 1 < t, SIDE_CAMERA, &path->x[i]);
    path->x[0].edge.w = p->camera[0].wo; /* an orthographic camera's direction */
    for (int i = 0; i + 1 < t; i++) {
        const struct vertex *to = &p->camera[i + 1];
        bool infinite = to->kind == VERTEX_LIGHT ||
                        (i == 0 && p->scene->camera.orthographic);
        take_edge(path, i, vec3_neg(to->wo), infinite);
    }
}

static void take_light_walk(struct path_space *space, struct full_path *path, int s)
{
    const struct subpaths *p = &space->paths;
    int k = path->edges;
    for (int j = 0; j < s; j++)
        take_vertex(space, &p->light[j], j + 1 < s, SIDE_LIGHT, &path->x[k - j]);
    for (int j = 0; j + 1 < s; j++)
        take_edge(path, k - j - 1, p->light[j + 1].wo,
                  j == 0 && p->light[0].light->infinite);
}

/* f |ns . w_l| of a light walk's delta events, from f* |ng . w_c|: [Veach97 Eq. 5.19]. */
static void turn_light_deltas(struct full_path *path, int t)
{
    for (int i = t; i < path->edges; i++) {
        struct full_vertex *v = &path->x[i];
        if (!v->delta)
            continue;
        double to_camera = (double)vec3_dot(v->hit.shading.n, v[-1].edge.w);
        double to_light = (double)vec3_dot(v->hit.shading.n, v->edge.w);
        v->value = rgb_scale(v->value, fabs(to_light / to_camera));
    }
}

static void note_deltas(struct full_path *path)
{
    for (int i = 1; i < path->edges; i++) {
        struct full_vertex *v = &path->x[i];
        v->transmits = vec3_dot(v->hit.shading.n, v[-1].edge.w) *
                           vec3_dot(v->hit.shading.n, v->edge.w) >
                       0.0f;
    }
}

/* The film's figures of a path whose first edge is the walk's. */
static void take_film(struct path_space *space, struct full_path *path)
{
    const struct subpaths *p = &space->paths;
    path->pixel = p->pixel;
    path->pdf_film = p->camera[0].event_pdf;
    camera_invert_direction(&p->scene->camera, &path->x[0].hit.at, path->x[0].edge.w,
                            path->film);
    for (int i = 0; i < 2; i++) /* rounded beyond the film */
        path->film[i] = warp_unit(path->film[i]);
}

/* All that follows from vertices and edges. */
static enum failure complete(struct path_space *space, struct full_path *path)
{
    enum failure failure = full_path_emit(space, path);
    for (int i = 1; failure == FAILURE_NONE && i < path->edges; i++)
        failure = full_path_scatter(space, path, i);
    /* What edges pass; they are known to be unobstructed. */
    for (int i = 0; failure == FAILURE_NONE && space->paths.passed && i < path->edges;
         i++)
        failure = full_path_unobstructed(space, path, i);
    return failure;
}

static enum failure list(struct path_space *space, struct full_path *path, int s, int t,
                         const struct vertex *point)
{
    enum failure failure = FAILURE_NONE;
    path->edges = s + t - 1;
    take_camera_walk(space, path, t);
    if (s == 1)
        take_vertex(space, point, false, SIDE_LIGHT, &path->x[path->edges]);
    else
        take_light_walk(space, path, s);
    if (s > 0)
        failure = full_path_edge(space, path, t - 1);
    if (failure != FAILURE_NONE)
        return failure;
    if (t > 1)
        take_film(space, path);
    turn_light_deltas(path, t);
    note_deltas(path);
    return complete(space, path);
}

/* --- sampling ----------------------------------------------------------------------- */

static enum failure sample(struct path_space *space, const struct numbers *numbers, int k,
                           int t)
{
    struct connection x;
    struct vertex point;
    enum failure failure = estimate_technique(&space->paths, numbers, k + 1 - t, t, &x,
                                              &point);
    space->rays += k + 1;
    if (failure == FAILURE_NONE)
        failure = list(space, &space->sampled, k + 1 - t, t, &point);
    return failure;
}

void full_path_remake(struct path_space *space, const struct numbers *numbers, int k,
                      int t, struct contrib *out)
{
    contrib_clear(out);
    out->failure = sample(space, numbers, k, t);
    if (out->failure == FAILURE_NONE) {
        out->failure = FAILURE_ZERO;
        full_path_weigh(space, &space->sampled);
        full_path_contribute(&space->sampled, out);
    }
    out->nonfinite += space->paths.nonfinite;
    space->paths.nonfinite = 0;
}

void full_path_sample(struct path_space *space, const struct numbers *numbers,
                      struct contrib *out)
{
    double u = *ustream_take(numbers->connect, DIMS_TECHNIQUE, 1);
    int k = pick_length(space, &u);
    contrib_clear(out);
    if (k == 0)
        return;
    const struct techniques *techniques = &space->techniques[k];
    full_path_remake(space, numbers, k, techniques->t[(int)(u * techniques->count)], out);
}

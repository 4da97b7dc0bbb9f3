#include "path/whole_path.h"

#include "path/edge.h"
#include "path/walk_step.h"

static bool is_direction(const struct whole_path *p, int i)
{
    return vertex_is_direction(p->x[i], &p->scene->camera);
}

/* The edge that connects the sub-paths, as the functions of path/connect.c have it. */
static struct vec3 connecting_direction(const struct whole_path *p, int i)
{
    struct edge e = {.w = {0.0f, 0.0f, 0.0f}};
    if (is_direction(p, i))
        return p->x[i]->hit.at.ng;
    if (is_direction(p, i + 1))
        return vec3_neg(p->x[i + 1]->wo);
    edge_between(&p->x[i]->hit.at, &p->x[i + 1]->hit.at, &e);
    return e.w;
}

/* The ends of an edge as passage_between wants them: an end at infinity is a place on the
 * line of the edge, which ends at v. */
static struct vertex end_of_edge(const struct whole_path *p, int i,
                                 const struct vertex *v, struct vec3 away)
{
    const struct camera *camera = &p->scene->camera;
    struct vertex end = *p->x[i];
    struct edge unused;
    end.end_chance = 1.0;
    if (is_direction(p, i) && end.kind == VERTEX_LIGHT)
        edge_from_light(end.light, &end.hit.at, &v->hit.at, &unused);
    else if (is_direction(p, i))
        camera_meet(camera, vec3_neg(away), v->hit.at.p, &end.hit.at);
    return end;
}

/* Finds Q of all edges. */
static bool find_passages(const struct subpaths *paths, struct whole_path *p)
{
    for (int i = 0; i < p->edges; i++) {
        struct passage passage;
        struct vertex y = end_of_edge(p, i, p->x[i + 1], vec3_neg(p->w[i]));
        struct vertex z = end_of_edge(p, i + 1, p->x[i], p->w[i]);
        if (passage_between(paths, &y, &z, p->w[i], &passage) != FAILURE_NONE)
            return false;
        p->pass[i] = passage.density;
    }
    return true;
}

static void find_edges(struct whole_path *p)
{
    for (int i = 0; i < p->edges; i++) {
        if (i + 1 < p->s)
            p->w[i] = vec3_neg(p->x[i + 1]->wo);
        else
            p->w[i] = i >= p->s ? p->x[i]->wo : connecting_direction(p, i);
        p->inverse_square[i] = is_direction(p, i) || is_direction(p, i + 1)
                                   ? 1.0
                                   : inverse_square_between(&p->x[i]->hit.at,
                                                            &p->x[i + 1]->hit.at);
        p->pass[i] = 1.0;
    }
}

/* Densities per solid angle at x[i] of the directions to x[i+1] and to x[i-1]. Walks have
 * kept those of their events; the ends of the sub-paths had none. */
static void scatter_densities(const struct whole_path *p, int i, double *to_camera,
                              double *to_light)
{
    const struct vertex *v = p->x[i];
    struct bsdf_value f;
    if (i < p->s - 1) {
        *to_camera = v->event_pdf;
        *to_light = v->event_pdf_rev;
    } else if (i > p->s) {
        *to_camera = v->event_pdf_rev;
        *to_light = v->event_pdf;
    } else {
        struct vec3 wo = frame_to_local(&v->hit.shading, vec3_neg(p->w[i - 1]));
        struct vec3 wi = frame_to_local(&v->hit.shading, p->w[i]);
        bsdf_eval(v->hit.bsdf, wo, wi, TRANSPORT_RADIANCE, &f);
        *to_camera = f.pdf;
        *to_light = f.pdf_rev;
    }
}

/* Of the direction in which the camera sees x[edges-1], where it was not sampled. */
static double camera_density(const struct whole_path *p)
{
    const struct camera *camera = &p->scene->camera;
    const struct vertex *v = p->x[p->edges - 1];
    struct ray_endpoint lens = p->x[p->edges]->hit.at;
    struct vec3 seen = vec3_neg(p->w[p->edges - 1]);
    double pdf, cos;
    if (camera->orthographic && !camera_meet(camera, seen, v->hit.at.p, &lens))
        return 0.0;
    return camera_project(camera, &lens, seen, &pdf, &cos) < 0 ? 0.0 : pdf;
}

/* Density per solid angle at one end of edge e to density per area at x[i], the other end
 * [Veach97, section 8.2.2]. */
static double to_area(const struct whole_path *p, int i, int e)
{
    if (is_direction(p, i))
        return 1.0;
    double cos = fabs((double)vec3_dot(p->x[i]->hit.at.ng, p->w[e]));
    return cos * p->inverse_square[e];
}

static void find_densities(struct whole_path *p)
{
    const struct vertex *y = p->x[0];
    int last = p->edges;
    double to_camera[DIMS_MAX_DEPTH + 1], to_light[DIMS_MAX_DEPTH + 1];
    to_camera[0] = y->light->type->pdf_direction(y->light, &y->hit.at, p->w[0]);
    for (int i = 1; i < last; i++)
        scatter_densities(p, i, &to_camera[i], &to_light[i]);
    to_light[last] = p->s == last ? camera_density(p) : 0.0;
    for (int i = 0; i < last; i++) {
        bool by_light = i < p->s;
        double own = p->x[i]->pdf_fwd, other;
        if (by_light)
            other = to_light[i + 1] * to_area(p, i, i) * p->pass[i];
        else
            other = i == 0 ? light_pdf_point(y->light, &y->hit.at)
                           : to_camera[i - 1] * to_area(p, i, i - 1) * p->pass[i - 1];
        p->from_light[i] = by_light ? own : other;
        p->from_camera[i] = by_light ? other : own;
    }
}

bool whole_path_collect(const struct subpaths *paths, int s, int t,
                        struct whole_path *path)
{
    path->scene = paths->scene;
    path->edges = s + t - 1;
    path->s = s;
    for (int i = 0; i < s; i++)
        path->x[i] = &paths->light[i];
    for (int i = 0; i < t; i++)
        path->x[path->edges - i] = &paths->camera[i];
    find_edges(path);
    if (paths->passed && !find_passages(paths, path))
        return false;
    find_densities(path);
    return true;
}

double whole_path_end_chance(const struct whole_path *path, int from, int i)
{
    return passage_end_chance(path->x[i], path->w[from < i ? from : i]);
}

static bool may_connect(const struct whole_path *p, int i)
{
    const struct vertex *v = p->x[i];
    return v->kind != VERTEX_SURFACE || i == 0 || (v->connectible && !v->delta_event);
}

/* Chance that walks which make the vertices on both sides of the technique's connection
 * end there; 0: it cannot make the path. */
static double ends(const struct whole_path *p, int s)
{
    if (s == 0)
        return p->x[0]->light->delta_position ? 0.0 : 1.0;
    if (!may_connect(p, s - 1) || !may_connect(p, s))
        return 0.0;
    double of_light = s > 1 ? whole_path_end_chance(p, s - 2, s - 1) : 1.0;
    return of_light * (s < p->edges ? whole_path_end_chance(p, s + 1, s) : 1.0);
}

bool whole_path_weights(const struct whole_path *p, const struct techniques *techniques,
                        double *weight)
{
    double density[DIMS_MAX_DEPTH + 2], sum = 0.0;
    density[p->s] = 1.0; /* relative to the technique at hand [Veach97 Eq. 10.9] */
    for (int s = p->s; s > 0; s--)
        density[s - 1] = density[s] * p->from_camera[s - 1] / p->from_light[s - 1];
    for (int s = p->s; s < p->edges; s++)
        density[s + 1] = density[s] * p->from_light[s] / p->from_camera[s];
    for (int i = 0; i < techniques->count; i++) {
        int s = p->edges + 1 - techniques->t[i];
        double chance = ends(p, s);
        weight[i] = chance > 0.0 ? chance * density[s] : 0.0;
        sum += weight[i];
    }
    for (int i = 0; i < techniques->count; i++)
        weight[i] /= sum;
    return sum > 0.0 && sum < HUGE_VAL;
}

#include "path/connect.h"
#include "path/estimate.h"
#include "path/estimate_join.h"
#include "path/walk_step.h"

/* Draws the film's numbers first, then the lens's; the sequence of a seed depends on this
 * order. */
static struct scatter_step camera_ray(struct subpaths *paths, struct ustream *numbers)
{
    double film[2], lens[2];
    dims_film(numbers, film);
    dims_lens(numbers, paths->scene->needs.lens, lens);
    sample_lens(paths, lens);
    return sample_film(paths, film);
}

/* Adds a connection to the sum, or with techniques kept apart as a splat of its own. */
static inline void add(struct contrib *out, struct rgb *sum, const struct connection *x,
                       int s, int t, bool techniques)
{
    struct rgb value = rgb_scale(x->value, x->weight);
    if (techniques)
        contrib_add_technique(out, x->pixel, value, s, t, x->weight);
    else
        *sum = rgb_add(*sum, value);
}

static inline __attribute__((always_inline)) void estimate(struct subpaths *paths,
                                                           const struct numbers *numbers,
                                                           struct contrib *out,
                                                           bool techniques)
{
    const struct needs *needs = &paths->scene->needs;
    struct rgb sum = {0.0, 0.0, 0.0};
    struct connection x;
    double u[3];
    contrib_clear(out);
    bool passes = paths->passed != NULL;
    struct scatter_step d = camera_ray(paths, numbers->camera);
    for (int edges = 1; edges <= paths->max_depth; edges++) {
        struct vertex *v = &paths->camera[edges];
        bool last = edges == paths->max_depth;
        if (!trace_step(paths, v - 1, &d, numbers->camera,
                        DIMS_CAMERA_VERTEX + 3 * (edges - 1), TRANSPORT_RADIANCE,
                        MIS_UNIDIRECTIONAL, passes, last ? HIT_LIGHT : HIT_ANY, v))
            break;
        if (connect_hit(paths, v, edges, MIS_UNIDIRECTIONAL, &x) == FAILURE_NONE)
            add(out, &sum, &x, 0, edges + 1, techniques);
        if (last || v->hit.bsdf->flags & BSDF_BLACK)
            break;
        if (v->connectible) {
            dims_light(numbers->connect, DIMS_DIRECT + 3 * (edges - 1),
                       paths->many_lights, u);
            if (connect_light(paths, u, v, MIS_UNIDIRECTIONAL, &x, NULL) == FAILURE_NONE)
                add(out, &sum, &x, 1, edges + 1, techniques);
        }
        if (edges + 1 == paths->max_depth && !needs->light_hits)
            break;
        scatter_numbers(paths, numbers->camera, DIMS_CAMERA_VERTEX, edges, v, passes, u);
        if (!sample_step(paths, v, u, TRANSPORT_RADIANCE, MIS_UNIDIRECTIONAL, passes, &d))
            break;
    }
    contrib_add(out, paths->pixel, sum, 0, 0);
    out->nonfinite += paths->nonfinite;
    paths->nonfinite = 0;
}

void estimate_pt(struct subpaths *paths, const struct numbers *numbers,
                 struct contrib *out)
{
    estimate(paths, numbers, out, false);
}

void estimate_pt_layers(struct subpaths *paths, const struct numbers *numbers,
                        struct contrib *out)
{
    estimate(paths, numbers, out, true);
    estimate_join_techniques(out);
}

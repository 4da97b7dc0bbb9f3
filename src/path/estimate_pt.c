#include "path/connect.h"
#include "path/estimate.h"
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

static void add(struct rgb *sum, const struct connection *x)
{
    *sum = rgb_add(*sum, rgb_scale(x->value, x->weight));
}

void estimate_pt(struct subpaths *paths, const struct numbers *numbers,
                 struct contrib *out)
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
            add(&sum, &x);
        if (last || v->hit.bsdf->flags & BSDF_BLACK)
            break;
        if (v->connectible) {
            dims_light(numbers->connect, DIMS_DIRECT + 3 * (edges - 1),
                       paths->many_lights, u);
            if (connect_light(paths, u, v, MIS_UNIDIRECTIONAL, &x, NULL) == FAILURE_NONE)
                add(&sum, &x);
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

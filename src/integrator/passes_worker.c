/* The sample of a pixel: the numbers, the estimator, and the layers that it adds to. */

#include "chain/state.h"
#include "integrator/passes_state.h"

static const double *pixel_take(struct ustream *stream, int place, int count)
{
    struct pixel_stream *s = (struct pixel_stream *)stream;
    const double *u = ustream_take(&s->inner.stream, place, count);
    if (place != DIMS_FILM)
        return u;
    s->film[0] = (s->x + u[0]) * s->inverse_width;
    s->film[1] = (s->y + u[1]) * s->inverse_height;
    return s->film;
}

static const double *counted_take(struct ustream *stream, int place, int count)
{
    struct pixel_stream *s =
        (struct pixel_stream *)((char *)stream - offsetof(struct pixel_stream, inner));
    s->events++;
    return s->free(stream, place, count);
}

static int splats_of(const struct passes_plan *plan, const struct settings *settings)
{
    return pass_layers_of_classes(settings) || (plan->split && plan->split->by_technique)
               ? estimate_splats_techniques(plan->depth)
               : estimate_splats(plan->depth);
}

/* Shadow rays of a sample by Russian roulette, where the estimator and the plan let the
 * run choose; 0: a ray for every connection. */
static double shadow_rays(const struct settings *settings, const struct passes_plan *plan)
{
    bool bdpt = plan->estimate == estimate_bdpt && !plan->split;
    return bdpt ? settings->shadow_rays : 0.0;
}

void passes_worker_init(struct worker *w, const struct passes *p,
                        const struct passes_plan *plan)
{
    subpaths_init(&w->paths, p->scene, plan->depth);
    if (shadow_rays(p->settings, plan) > 0.0)
        estimate_bdpt_roulette(&w->paths, p->settings->shadow_rays);
    contrib_init(&w->contrib, splats_of(plan, p->settings));
    if (p->layers.classes.unweighted)
        contrib_keep_weights(&w->contrib);
    w->numbers.stream.take = pixel_take;
    ustream_random_init(&w->numbers.inner, &w->rng);
    w->numbers.inverse_width = 1.0 / p->width;
    w->numbers.inverse_height = 1.0 / p->height;
    w->numbers.free = w->numbers.inner.stream.take;
    passes_worker_count(w, p->layers.samples != NULL);
}

void passes_worker_count(struct worker *w, bool count)
{
    w->numbers.inner.stream.take = count ? counted_take : w->numbers.free;
    w->numbers.events = 0;
}

double passes_worker_bytes(const struct scene *scene, const struct settings *settings,
                           const struct passes_plan *plan)
{
    double bytes = subpaths_bytes(scene, plan->depth) +
                   contrib_bytes(splats_of(plan, settings));
    if (shadow_rays(settings, plan) > 0.0)
        bytes += estimate_roulette_bytes(plan->depth);
    return bytes;
}

void passes_sample(const struct passes *p, struct worker *w, int x, int y,
                   enum rng_purpose purpose, long number)
{
    uint64_t pixel = (uint64_t)y * (uint64_t)p->width + (uint64_t)x;
    uint64_t pixels = (uint64_t)p->width * (uint64_t)p->height;
    struct ustream *camera = &w->numbers.stream, *free = &w->numbers.inner.stream;
    rng_init(&w->rng, (uint64_t)p->settings->seed, purpose,
             (uint64_t)number * pixels + pixel);
    w->numbers.x = x;
    w->numbers.y = y;
    p->estimate(&w->paths, &(struct numbers){camera, free, free}, &w->contrib);
    w->whole = w->contrib.target;
    if (p->split)
        split_for_passes(p->split, &w->contrib);
}

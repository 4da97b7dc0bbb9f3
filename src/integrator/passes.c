/* Independent samples: allocation, parts of a run, and the methods. */

#include "base/clock.h"
#include "integrator/passes_state.h"

#include <string.h>

#define ROUND_MOST 0.05 /* s, length of a round under a time budget */

/* A stride through the rows that visits each once and puts successive rows far apart:
 * when time ends during a pass, the rows done are spread evenly over the film. */
static long row_stride(long height)
{
    long stride = (long)(0.6180339887498949 * (double)height) | 1;
    for (long a = height, b = stride; b != 0;) {
        long rest = a % b;
        a = b;
        b = rest;
        if (b == 0 && a > 1) { /* a common divisor: try the next */
            a = height;
            b = ++stride;
        }
    }
    return stride;
}

/* Both plans may be one. */
static void pass_arrays(struct passes *p, struct mem_plan *films, struct mem_plan *states)
{
    size_t height = (size_t)p->height, pixels = (size_t)p->width * height;
    p->sums = mem_take(films, MEM_APART, 3 * pixels, sizeof *p->sums);
    p->counts = mem_take(films, 0, pixels, sizeof *p->counts);
    p->workers = mem_take(states, MEM_APART, (size_t)p->threads, sizeof *p->workers);
    p->rows = mem_take(states, MEM_APART, height, sizeof *p->rows);
    p->under_way = mem_take(states, 0, height, sizeof *p->under_way);
}

struct passes *passes_create(const struct scene *scene, const struct settings *settings,
                             const struct passes_plan *plan)
{
    struct passes *p = mem_alloc(1, sizeof *p);
    p->scene = scene;
    p->settings = settings;
    p->estimate = plan->estimate;
    p->split = plan->split;
    p->threads = settings_threads(settings);
    p->width = scene->camera.width;
    p->height = scene->camera.height;
    pass_layers_create(&p->layers, scene, settings, plan->depth, &p->estimate);
    struct mem_plan take = {.take = true};
    pass_arrays(p, &take, &take);
    for (int i = 0; i < p->threads; i++)
        passes_worker_init(&p->workers[i], p, plan);
    p->stride = row_stride(p->height);
    if (plan->light_image) {
        p->light = film_create(p->width, p->height);
        film_add_lanes(p->light, p->threads, FILM_LANES_BYTES);
    }
    int replicas = replicas_that_fit(p->width, p->height, (int)settings->replicas);
    if (replicas >= VERDICT_REPLICAS_LEAST) {
        p->replicas = replicas_create(p->width, p->height, replicas, 1, false);
        p->pending = replicas_create(p->width, p->height, 1, p->threads, false);
        p->replica_rows = mem_alloc((size_t)replicas * (size_t)p->height,
                                    sizeof *p->replica_rows);
        time_spans_init(&p->spans, p->replicas, replicas);
    }
    if (settings->seconds <= 0.0)
        p->budget = (long)ceil(settings->mutations_per_pixel);
    passes_adaptive_init(p, plan);
    return p;
}

void passes_memory(const struct scene *scene, const struct settings *settings,
                   const struct passes_plan *plan, struct run_memory *out)
{
    int width = scene->camera.width, height = scene->camera.height;
    int threads = settings_threads(settings);
    int replicas = replicas_that_fit(width, height, (int)settings->replicas);
    double lanes = film_lanes_bytes(width, height, threads);
    struct passes passes = {.width = width, .height = height, .threads = threads};
    struct mem_plan films = {.take = false}, states = films;
    pass_arrays(&passes, &films, &states);
    out->films += films.bytes;
    out->states += states.bytes;
    if (plan->light_image) {
        out->rare += film_rare_bytes(width, height);
        out->films += film_bytes(width, height) +
                      (lanes <= FILM_LANES_BYTES ? lanes : 0.0);
    }
    pass_layers_memory(scene, settings, plan->depth, out);
    passes_adaptive_memory(scene, settings, plan, out);
    if (replicas >= VERDICT_REPLICAS_LEAST) {
        out->films += replicas_bytes(width, height, replicas, 1, false) +
                      replicas_bytes(width, height, 1, threads, false);
        out->states += time_spans_bytes(width, height, replicas) +
                       (double)replicas * height * sizeof(uint32_t);
    }
    out->states += threads * passes_worker_bytes(scene, settings, plan);
}

void passes_destroy(void *self)
{
    struct passes *p = self;
    for (int i = 0; i < p->threads; i++) {
        subpaths_deinit(&p->workers[i].paths);
        contrib_deinit(&p->workers[i].contrib);
    }
    pass_layers_destroy(&p->layers);
    passes_adaptive_deinit(p);
    film_destroy(p->light);
    time_spans_deinit(&p->spans);
    replicas_destroy(p->replicas);
    replicas_destroy(p->pending);
    mem_free(p->workers);
    mem_free(p->sums);
    mem_free(p->counts);
    mem_free(p->replica_rows);
    mem_free(p->rows);
    mem_free(p->under_way);
    mem_free(p);
}

/* Rows under way are with the first part; they count as complete for the others. */
static void forget(struct passes *p)
{
    size_t height = (size_t)p->height, pixels = height * (size_t)p->width;
    *p->scene->edges_cut = 0;
    memset(p->sums, 0, 3 * pixels * sizeof *p->sums);
    memset(p->counts, 0, pixels * sizeof *p->counts);
    memset(p->rows, 0, height * sizeof *p->rows);
    p->clamped = 0;
    for (int i = 0; i < p->threads; i++)
        p->workers[i].contrib.nonfinite = 0;
    for (size_t y = 0; y < height; y++)
        p->under_way[y] = (struct pass_row){
            p->under_way[y].done > 0 ? (uint32_t)p->width : 0, 0.0};
    if (p->light)
        film_clear(p->light);
    pass_layers_clear(&p->layers);
    if (!p->replicas)
        return;
    replicas_clear(p->replicas);
    replicas_clear(p->pending);
    time_spans_clear(&p->spans);
    memset(p->replica_rows, 0,
           (size_t)p->replicas->count * height * sizeof *p->replica_rows);
}

void passes_set_part(struct passes *p, struct run_part part)
{
    p->part = part;
    if (part.index > 0)
        forget(p);
}

/* --- the methods ------------------------------------------------------------------ */

static struct passes_plan plan_of(const struct integrator_type *type,
                                  const struct scene *scene,
                                  const struct settings *settings)
{
    const struct passes_integrator *which = (const struct passes_integrator *)type;
    return (struct passes_plan){settings_depth(settings, scene), which->estimate,
                                which->light_image, true, NULL};
}

static void *create(const struct integrator_type *type, const struct scene *scene,
                    const struct settings *settings)
{
    struct passes_plan plan = plan_of(type, scene, settings);
    return passes_create(scene, settings, &plan);
}

static void memory(const struct integrator_type *type, const struct scene *scene,
                   const struct settings *settings, struct run_memory *out)
{
    struct passes_plan plan = plan_of(type, scene, settings);
    passes_memory(scene, settings, &plan, out);
}

static bool advance(void *self, const struct round_limits *limits)
{
    struct passes *p = self;
    double until = limits->until > 0.0 ? fmin(limits->until, clock_wall() + ROUND_MOST)
                                       : (double)INFINITY;
    p->adaptive.time_began = limits->begin - limits->seconds_used;
    passes_trace(p, (double)INFINITY, until, limits->stop);
    return p->budget == 0 || p->pass < p->budget;
}

static bool started(const void *self)
{
    const struct passes *p = self;
    return !p->adaptive.measuring;
}

static void set_part(void *self, struct run_part part)
{
    struct passes *p = self;
    p->adaptive.part = part;
    if (started(p))
        passes_set_part(p, part);
}

/* Samples are counted by pixel: those of missing parts are no loss but of number. */
static void complete(void *self, const bool *present, int count)
{
    (void)self, (void)present, (void)count;
}

static double progress(const void *self)
{
    const struct passes *p = self;
    double planned = ceil(p->settings->mutations_per_pixel);
    if (p->budget > 0 && p->pass >= p->budget)
        return 1.0;
    return p->budget > 0 ? passes_paths(p) / (passes_pixels(p) * planned) : 0.0;
}

const struct integrator_methods passes_methods = {
    .memory = memory,
    .create = create,
    .set_part = set_part,
    .advance = advance,
    .started = started,
    .picture = passes_picture,
    .fixed_picture = passes_fixed_picture,
    .layers = passes_layers,
    .statistics = passes_statistics,
    .counts = passes_counts,
    .progress = progress,
    .pack = passes_pack,
    .complete = complete,
    .evidence = passes_evidence,
    .destroy = passes_destroy,
};

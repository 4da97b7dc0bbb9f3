/* Independent samples: allocation and tracing. */

#include "base/clock.h"
#include "base/par.h"
#include "chain/state.h"
#include "integrator/passes_state.h"
#include "math/accum.h"

#include <assert.h>
#include <string.h>

#define PILOT_PATHS 4096
#define PILOT_LIMIT (256L * PILOT_PATHS)
#define PILOT_SHARE 0.05 /* of a time budget, at most */
#define ROUND_MOST  0.05 /* s, length of a round under a time budget */
#define LOOK_EVERY  8    /* samples of a thread between two readings of the clock */

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

/* The estimator that keeps techniques apart. */
static estimate_function by_technique(estimate_function estimate)
{
    return estimate == estimate_pt     ? estimate_pt_layers
           : estimate == estimate_bdpt ? estimate_bdpt_layers
                                       : estimate;
}

static bool keeps_classes(const struct settings *settings)
{
    return (settings->layers & (LAYER_LENGTHS | LAYER_TECHNIQUES | LAYER_UNWEIGHTED)) !=
           0;
}

static int splats_of(const struct passes_plan *plan, const struct settings *settings)
{
    return keeps_classes(settings) || (plan->split && plan->split->by_technique)
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

static void worker_init(struct worker *w, const struct passes *p,
                        const struct passes_plan *plan)
{
    subpaths_init(&w->paths, p->scene, plan->depth);
    if (shadow_rays(p->settings, plan) > 0.0)
        estimate_bdpt_roulette(&w->paths, p->settings->shadow_rays);
    contrib_init(&w->contrib, splats_of(plan, p->settings));
    if (p->unweighted)
        contrib_keep_weights(&w->contrib);
    w->numbers.stream.take = pixel_take;
    ustream_random_init(&w->numbers.inner, &w->rng);
    w->numbers.inverse_width = 1.0 / p->width;
    w->numbers.inverse_height = 1.0 / p->height;
    if (!p->samples)
        return;
    w->numbers.free = w->numbers.inner.stream.take;
    w->numbers.inner.stream.take = counted_take;
}

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

static struct film **class_films(const struct passes *p)
{
    struct film **films = mem_alloc((size_t)p->classes.count, sizeof(struct film *));
    for (int i = 0; i < p->classes.count; i++)
        films[i] = film_create(p->width, p->height);
    return films;
}

/* Beside chains, the maps are of these. */
static bool maps_samples(const struct settings *settings)
{
    return (settings->layers & (LAYER_FAILURES | LAYER_WORK)) != 0 &&
           !settings_uses(settings, "chains");
}

static void create_layers(struct passes *p, int depth)
{
    light_classes_init(&p->classes, p->settings, depth);
    if (p->classes.count > 0) {
        p->estimate = by_technique(p->estimate);
        p->class_films = class_films(p);
    }
    if (p->classes.unweighted)
        p->unweighted = class_films(p);
    if (maps_samples(p->settings))
        p->samples = film_create(p->width, p->height);
}

/* Of the layers. */
static void add_layers_memory(const struct scene *scene, const struct settings *settings,
                              int depth, struct run_memory *out)
{
    int width = scene->camera.width, height = scene->camera.height;
    struct light_classes classes;
    light_classes_init(&classes, settings, depth);
    int films = (1 + classes.unweighted) * classes.count + maps_samples(settings);
    out->films += films * film_bytes(width, height);
    out->rare += films * film_rare_bytes(width, height);
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
    create_layers(p, plan->depth);
    struct mem_plan take = {.take = true};
    pass_arrays(p, &take, &take);
    for (int i = 0; i < p->threads; i++)
        worker_init(&p->workers[i], p, plan);
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
    add_layers_memory(scene, settings, plan->depth, out);
    if (replicas >= VERDICT_REPLICAS_LEAST) {
        out->films += replicas_bytes(width, height, replicas, 1, false) +
                      replicas_bytes(width, height, 1, threads, false);
        out->states += time_spans_bytes(width, height, replicas) +
                       (double)replicas * height * sizeof(uint32_t);
    }
    out->states += threads * (subpaths_bytes(scene, plan->depth) +
                              contrib_bytes(splats_of(plan, settings)));
    if (shadow_rays(settings, plan) > 0.0)
        out->states += threads * estimate_roulette_bytes(plan->depth);
}

void passes_destroy(void *self)
{
    struct passes *p = self;
    for (int i = 0; i < p->threads; i++) {
        subpaths_deinit(&p->workers[i].paths);
        contrib_deinit(&p->workers[i].contrib);
    }
    for (int i = 0; i < p->classes.count; i++) {
        film_destroy(p->class_films[i]);
        film_destroy(p->unweighted ? p->unweighted[i] : NULL);
    }
    mem_free(p->class_films);
    mem_free(p->unweighted);
    film_destroy(p->samples);
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

static void trace_pixel(struct passes *p, struct worker *w, int x, int y,
                        enum rng_purpose purpose, long pass)
{
    uint64_t pixel = (uint64_t)y * (uint64_t)p->width + (uint64_t)x;
    uint64_t pixels = (uint64_t)p->width * (uint64_t)p->height;
    struct ustream *camera = &w->numbers.stream, *free = &w->numbers.inner.stream;
    rng_init(&w->rng, (uint64_t)p->settings->seed, purpose,
             (uint64_t)pass * pixels + pixel);
    w->numbers.x = x;
    w->numbers.y = y;
    p->estimate(&w->paths, &(struct numbers){camera, free, free}, &w->contrib);
    w->whole = w->contrib.target;
    if (p->split)
        split_for_passes(p->split, &w->contrib);
}

static bool round_is_over(const struct passes *p)
{
    return (p->until < (double)INFINITY && clock_wall() >= p->until) ||
           (p->stop && *p->stop);
}

/* Finds the unit of light splats and replicas, about the mean of the picture, and the
 * scale of camera samples, the next power of two. Where light is rare it goes on until
 * some is found, as in a far too large unit all splats would round to 0. Under a time
 * budget it takes a small share of the time at most, unless other parts of the run have
 * to find the same unit. */
static void pilot(struct passes *p)
{
    struct welford mean = {0};
    struct worker *w = &p->workers[0];
    long pixels = (long)p->width * p->height;
    long limit = p->light ? PILOT_LIMIT : PILOT_PATHS, cut = *p->scene->edges_cut;
    double end = p->budget > 0 || !part_is_whole(p->part)
                     ? (double)INFINITY
                     : clock_wall() + PILOT_SHARE * p->settings->seconds;
    for (long i = 0; i < PILOT_PATHS || (mean.mean == 0.0 && i < limit); i++) {
        if (i % LOOK_EVERY == 0 && clock_wall() >= end)
            break;
        long pixel = i % PILOT_PATHS * pixels / PILOT_PATHS;
        trace_pixel(p, w, (int)(pixel % p->width), (int)(pixel / p->width), RNG_PILOT, i);
        welford_add(&mean, w->whole);
    }
    /* Each part of a run makes these paths anew, and no picture has them. */
    w->contrib.nonfinite = 0;
    *p->scene->edges_cut = cut;
    w->numbers.events = 0;
    p->unit = mean.mean > 0.0 ? mean.mean : 1.0;
    passes_set_scale(p);
}

void passes_set_scale(struct passes *p)
{
    int exponent;
    frexp(p->unit, &exponent);
    p->scale = ldexp(1.0, exponent);
}

static void splat_replica(const struct passes *p, const struct contrib *c, int thread)
{
    struct replica_lane *lane = &p->pending->lanes[thread];
    double factor = REPLICAS_ONE / p->unit;
    for (int i = 0; i < c->count; i++)
        replica_add(lane, lane->base + c->splats[i].pixel,
                    rgb_luminance(c->splats[i].value) * factor,
                    p->workers[thread].rng.s[0]);
    if (c->target > 0.0)
        replica_count_brightness(lane, c->target * factor);
}

static void add_exact(struct passes *p, exact_sum *sum, double value)
{
    if (!(fabs(value) <= EXACT_LIMIT))
        __atomic_fetch_add(&p->clamped, 1, __ATOMIC_RELAXED);
    *sum = exact_add(*sum, exact_of(value));
}

static void splat_sample(struct passes *p, const struct contrib *c, int thread,
                         exact_sum *sum)
{
    double rgb[3] = {0.0, 0.0, 0.0}, factor = 1.0 / p->scale;
    if (p->replicas)
        splat_replica(p, c, thread);
    struct film *light = p->light ? film_lane(p->light, thread) : NULL;
    for (int i = 0; i < c->count; i++) {
        const struct splat *splat = &c->splats[i];
        if (splat->t == 1) {
            assert(light); /* pt has no light splats */
            film_splat(light, splat->pixel, splat->value, 1.0 / p->unit);
        } else {
            rgb[0] += splat->value.r;
            rgb[1] += splat->value.g;
            rgb[2] += splat->value.b;
        }
    }
    for (int i = 0; i < 3; i++)
        add_exact(p, &sum[i], rgb[i] * factor);
}

/* Adds to the layers. Work is that of struct state_type: random events and connections.
 */
static void map_sample(const struct passes *p, struct worker *w, int pixel)
{
    const struct contrib *c = &w->contrib;
    double work = state_work(w->numbers.events, c->connections);
    w->numbers.events = 0;
    if (p->samples)
        film_splat(p->samples, pixel, rgb(c->count == 0, 1.0, work), 1.0);
    for (int i = 0; p->class_films && i < c->count; i++) {
        const struct splat *s = &c->splats[i];
        int class = light_class(&p->classes, s->s, s->t);
        if (class < 0)
            continue;
        film_splat(p->class_films[class], s->pixel, s->value, 1.0 / p->unit);
        if (p->unweighted && c->weights[i] > 0.0)
            film_splat(p->unweighted[class], s->pixel, s->value,
                       1.0 / (p->unit * c->weights[i]));
    }
}

static long row_of_turn(const struct passes *p, long turn)
{
    return turn * p->stride % p->height;
}

static void add_row(struct passes *p, struct row_sums *row, double targets)
{
    double mean = targets / (p->scale * p->width);
    add_exact(p, &row->targets, mean);
    add_exact(p, &row->squares, mean * mean * ROW_SQUARES);
    row->passes++;
}

/* Continues a row where it was left, to its end or to the end of the round. */
static void trace_row(void *ctx, long index, int thread)
{
    struct passes *p = ctx;
    struct worker *w = &p->workers[thread];
    long y = row_of_turn(p, p->turn + index);
    struct pass_row row = p->under_way[y];
    uint32_t begin = row.done, width = (uint32_t)p->width;
    if (!part_owns_row(p->part, p->pass, p->height, y)) {
        p->under_way[y].done = width;
        return;
    }
    exact_sum *sum = p->sums + 3 * (y * p->width + begin);
    for (; row.done < width; row.done++, sum += 3) {
        if ((row.done - begin) % LOOK_EVERY == 0 && round_is_over(p))
            break;
        trace_pixel(p, w, (int)row.done, (int)y, RNG_PIXEL, p->pass);
        splat_sample(p, &w->contrib, thread, sum);
        p->counts[y * p->width + row.done]++;
        if (p->samples || p->class_films)
            map_sample(p, w, (int)(y * p->width + row.done));
        row.targets += w->whole;
    }
    if (p->replicas)
        replica_flush(&p->pending->lanes[thread]);
    if (begin < width && row.done == width)
        add_row(p, &p->rows[y], row.targets);
    p->under_way[y] = row;
}

void passes_assign_replica(struct passes *p)
{
    for (int i = 0; p->replicas && i < p->threads; i++)
        p->pending->lanes[i].base = p->pass % p->replicas->count * p->width * p->height;
}

/* Ends a pass and adds it to a replica. A replica gets whole passes only: light splats go
 * to any row, so those of a part of the rows could not be normalised. */
static void end_pass(struct passes *p)
{
    if (p->replicas) {
        long replica = p->pass % p->replicas->count;
        replicas_move(p->replicas, (int)replica, p->pending);
        for (long y = 0; y < p->height; y++)
            p->replica_rows[replica * p->height + y] += part_owns_row(p->part, p->pass,
                                                                      p->height, y);
    }
    p->pass++;
    if (p->replicas && p->pass % p->replicas->count == 0)
        time_spans_take(&p->spans, p->replicas, (double)p->pass, false, p->threads);
    p->turn = 0;
    memset(p->under_way, 0, (size_t)p->height * sizeof *p->under_way);
    passes_assign_replica(p);
}

void passes_trace(struct passes *p, double paths, double until,
                  const volatile sig_atomic_t *stop)
{
    long rows = p->height - p->turn;
    if (paths < (double)rows * p->width)
        rows = (long)ceil(paths / p->width);
    p->until = until;
    p->stop = stop;
    if (p->unit == 0.0)
        pilot(p);
    par_for(rows, p->threads, trace_row, p);
    while (p->turn < p->height &&
           p->under_way[row_of_turn(p, p->turn)].done == (uint32_t)p->width)
        p->turn++;
    if (p->turn == p->height)
        end_pass(p);
}

static void clear_layers(struct passes *p)
{
    for (int i = 0; i < p->classes.count; i++) {
        film_clear(p->class_films[i]);
        if (p->unweighted)
            film_clear(p->unweighted[i]);
    }
    if (p->samples)
        film_clear(p->samples);
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
    clear_layers(p);
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
                                which->light_image, NULL};
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
    passes_trace(p, (double)INFINITY, until, limits->stop);
    return p->budget == 0 || p->pass < p->budget;
}

/* Whether the measured start is over: there is none. */
static bool started(const void *self)
{
    (void)self;
    return true;
}

static void set_part(void *self, struct run_part part)
{
    passes_set_part(self, part);
}

/* Samples are counted by pixel: those of missing parts are no loss but of number. */
static void complete(void *self, const bool *present, int count)
{
    (void)self, (void)present, (void)count;
}

static double progress(const void *self)
{
    const struct passes *p = self;
    return p->budget > 0 ? (double)p->pass / (double)p->budget : 0.0;
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
    .progress = progress,
    .pack = passes_pack,
    .complete = complete,
    .evidence = passes_evidence,
    .destroy = passes_destroy,
};

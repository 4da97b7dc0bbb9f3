/* Independent samples: allocation and tracing. */

#include "base/clock.h"
#include "base/par.h"
#include "integrator/passes_state.h"

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

static void worker_init(struct worker *w, const struct passes *p, int depth)
{
    subpaths_init(&w->paths, p->scene, depth);
    contrib_init(&w->contrib, estimate_splats(depth));
    w->numbers.stream.take = pixel_take;
    ustream_random_init(&w->numbers.inner, &w->rng);
    w->numbers.inverse_width = 1.0 / p->width;
    w->numbers.inverse_height = 1.0 / p->height;
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
    p->sums = mem_take(films, 0, 3 * pixels, sizeof *p->sums);
    p->workers = mem_take(states, MEM_APART, (size_t)p->threads, sizeof *p->workers);
    p->rows = mem_take(states, 0, height, sizeof *p->rows);
    p->under_way = mem_take(states, 0, height, sizeof *p->under_way);
}

struct passes *passes_create(const struct scene *scene, const struct settings *settings,
                             int depth, estimate_function estimate, bool light_image)
{
    struct passes *p = mem_alloc(1, sizeof *p);
    p->scene = scene;
    p->settings = settings;
    p->estimate = estimate;
    p->threads = settings_threads(settings);
    p->width = scene->camera.width;
    p->height = scene->camera.height;
    struct mem_plan take = {.take = true};
    pass_arrays(p, &take, &take);
    for (int i = 0; i < p->threads; i++)
        worker_init(&p->workers[i], p, depth);
    p->stride = row_stride(p->height);
    if (light_image) {
        p->light = film_create(p->width, p->height);
        film_add_lanes(p->light, p->threads, FILM_LANES_BYTES);
    }
    int replicas = replicas_that_fit(p->width, p->height, (int)settings->replicas);
    if (replicas >= VERDICT_REPLICAS_LEAST) {
        p->replicas = replicas_create(p->width, p->height, replicas, 1, false);
        p->pending = replicas_create(p->width, p->height, 1, p->threads, false);
        time_spans_init(&p->spans, p->replicas, replicas);
    }
    if (settings->seconds <= 0.0)
        p->budget = (long)ceil(settings->mutations_per_pixel);
    return p;
}

void passes_memory(const struct scene *scene, const struct settings *settings, int depth,
                   bool light_image, struct run_memory *out)
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
    if (light_image) {
        out->rare += film_rare_bytes(width, height);
        out->films += film_bytes(width, height) +
                      (lanes <= FILM_LANES_BYTES ? lanes : 0.0);
    }
    if (replicas >= VERDICT_REPLICAS_LEAST) {
        out->films += replicas_bytes(width, height, replicas, 1, false) +
                      replicas_bytes(width, height, 1, threads, false);
        out->states += time_spans_bytes(width, height, replicas);
    }
    out->states += threads *
                   (subpaths_bytes(scene, depth) + contrib_bytes(estimate_splats(depth)));
}

void passes_destroy(void *self)
{
    struct passes *p = self;
    for (int i = 0; i < p->threads; i++) {
        subpaths_deinit(&p->workers[i].paths);
        contrib_deinit(&p->workers[i].contrib);
    }
    film_destroy(p->light);
    time_spans_deinit(&p->spans);
    replicas_destroy(p->replicas);
    replicas_destroy(p->pending);
    mem_free(p->workers);
    mem_free(p->sums);
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
}

static bool round_is_over(const struct passes *p)
{
    return (p->until < (double)INFINITY && clock_wall() >= p->until) ||
           (p->stop && *p->stop);
}

/* Finds the unit of light splats and replicas, about the mean of the picture. Where light
 * is rare it goes on until some is found, as in a far too large unit all splats would
 * round to 0. Under a time budget it takes a small share of the time at most. */
static void pilot(struct passes *p)
{
    struct welford mean = {0};
    struct worker *w = &p->workers[0];
    long pixels = (long)p->width * p->height;
    long limit = p->light ? PILOT_LIMIT : PILOT_PATHS;
    double end = p->budget > 0 ? (double)INFINITY
                               : clock_wall() + PILOT_SHARE * p->settings->seconds;
    for (long i = 0; i < PILOT_PATHS || (mean.mean == 0.0 && i < limit); i++) {
        if (i % LOOK_EVERY == 0 && clock_wall() >= end)
            break;
        long pixel = i % PILOT_PATHS * pixels / PILOT_PATHS;
        trace_pixel(p, w, (int)(pixel % p->width), (int)(pixel / p->width), RNG_PILOT, i);
        welford_add(&mean, w->contrib.target);
    }
    w->contrib.nonfinite = 0;
    p->unit = mean.mean > 0.0 ? mean.mean : 1.0;
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

static void splat_sample(struct passes *p, const struct contrib *c, int thread,
                         double *sum)
{
    if (p->replicas)
        splat_replica(p, c, thread);
    struct film *light = p->light ? film_lane(p->light, thread) : NULL;
    for (int i = 0; i < c->count; i++) {
        const struct splat *splat = &c->splats[i];
        if (splat->t == 1) {
            assert(light); /* pt has no light splats */
            film_splat(light, splat->pixel, splat->value, 1.0 / p->unit);
        } else {
            sum[0] += splat->value.r;
            sum[1] += splat->value.g;
            sum[2] += splat->value.b;
        }
    }
}

static long row_of_turn(const struct passes *p, long turn)
{
    return turn * p->stride % p->height;
}

/* Continues a row where it was left, to its end or to the end of the round. */
static void trace_row(void *ctx, long index, int thread)
{
    struct passes *p = ctx;
    struct worker *w = &p->workers[thread];
    long y = row_of_turn(p, p->turn + index);
    struct pass_row row = p->under_way[y];
    uint32_t begin = row.done, width = (uint32_t)p->width;
    double *sum = p->sums + 3 * (y * p->width + begin);
    for (; row.done < width; row.done++, sum += 3) {
        if ((row.done - begin) % LOOK_EVERY == 0 && round_is_over(p))
            break;
        trace_pixel(p, w, (int)row.done, (int)y, RNG_PIXEL, p->pass);
        splat_sample(p, &w->contrib, thread, sum);
        row.targets += w->contrib.target;
    }
    if (p->replicas)
        replica_flush(&p->pending->lanes[thread]);
    if (begin < width && row.done == width)
        welford_add(&p->rows[y], row.targets);
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
    if (p->replicas)
        replicas_move(p->replicas, (int)(p->pass % p->replicas->count), p->pending);
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
    if ((p->light || p->replicas) && p->unit == 0.0)
        pilot(p);
    par_for(rows, p->threads, trace_row, p);
    while (p->turn < p->height &&
           p->under_way[row_of_turn(p, p->turn)].done == (uint32_t)p->width)
        p->turn++;
    if (p->turn == p->height)
        end_pass(p);
}

/* --- the methods ------------------------------------------------------------------ */

static void *create(const struct integrator_type *type, const struct scene *scene,
                    const struct settings *settings)
{
    const struct passes_integrator *which = (const struct passes_integrator *)type;
    return passes_create(scene, settings, settings_depth(settings, scene),
                         which->estimate, which->light_image);
}

static void memory(const struct integrator_type *type, const struct scene *scene,
                   const struct settings *settings, struct run_memory *out)
{
    const struct passes_integrator *which = (const struct passes_integrator *)type;
    passes_memory(scene, settings, settings_depth(settings, scene), which->light_image,
                  out);
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

static double progress(const void *self)
{
    const struct passes *p = self;
    return p->budget > 0 ? (double)p->pass / (double)p->budget : 0.0;
}

const struct integrator_methods passes_methods = {
    .memory = memory,
    .create = create,
    .advance = advance,
    .started = started,
    .picture = passes_picture,
    .statistics = passes_statistics,
    .progress = progress,
    .pack = passes_pack,
    .evidence = passes_evidence,
    .destroy = passes_destroy,
};

#include "integrator/passes.h"

#include "base/mem.h"
#include "base/par.h"
#include "image/film.h"
#include "integrator/batches.h"
#include "math/accum.h"

#include <assert.h>
#include <limits.h>

#define PILOT_PATHS 4096
#define PILOT_LIMIT (256L * PILOT_PATHS)

/* Numbers of one pixel's sample: the film position is drawn within the pixel. */
struct pixel_stream {
    struct ustream stream; /* must be first */
    struct ustream_random inner;
    double x, y, inverse_width, inverse_height;
    double film[2];
};

struct worker {
    _Alignas(MEM_APART) struct subpaths paths;
    struct contrib contrib;
    struct pixel_stream numbers;
    struct rng rng;
};

struct passes {
    const struct scene *scene;
    const struct settings *settings;
    estimate_function estimate;
    int threads, width, height;
    struct worker *workers; /* [threads] */
    double *sums;           /* [height][width][3] */
    struct film *light;     /* NULL without a light image; in units of `unit` */
    double unit;
    struct welford *rows;      /* [height]: sum of the row's targets, over passes */
    struct replicas *replicas; /* passes in turn; NULL: none, nor batches. In `unit` */
    struct batches batches;
    long pass, budget; /* passes done and wanted; 0 if the clock decides */
};

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
    p->workers = mem_aligned(MEM_APART, (size_t)p->threads, sizeof *p->workers);
    for (int i = 0; i < p->threads; i++)
        worker_init(&p->workers[i], p, depth);
    p->sums = mem_alloc((size_t)p->width * (size_t)p->height * 3, sizeof *p->sums);
    p->rows = mem_alloc((size_t)p->height, sizeof *p->rows);
    if (light_image) {
        p->light = film_create(p->width, p->height);
        film_add_lanes(p->light, p->threads, FILM_LANES_BYTES);
    }
    int replicas = replicas_that_fit(p->width, p->height, (int)settings->replicas);
    if (replicas >= VERDICT_REPLICAS_LEAST) {
        p->replicas = replicas_create(p->width, p->height, replicas, p->threads, false);
        batches_init(&p->batches, p->replicas, replicas);
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
    out->films += 3.0 * sizeof(double) * width * height;
    if (light_image)
        out->rare += film_fine_bytes(width, height);
    if (light_image)
        out->films += film_bytes(width, height) +
                      (lanes <= FILM_LANES_BYTES ? lanes : 0.0);
    if (replicas >= VERDICT_REPLICAS_LEAST) {
        out->films += replicas_bytes(width, height, replicas, threads, false);
        out->states += batches_bytes(width, height, replicas);
    }
    out->states += threads * (sizeof(struct worker) + subpaths_bytes(scene, depth) +
                              contrib_bytes(estimate_splats(depth)));
    out->states += (double)height * sizeof(struct welford);
}

void passes_destroy(void *self)
{
    struct passes *p = self;
    for (int i = 0; i < p->threads; i++) {
        subpaths_deinit(&p->workers[i].paths);
        contrib_deinit(&p->workers[i].contrib);
    }
    film_destroy(p->light);
    batches_deinit(&p->batches);
    replicas_destroy(p->replicas);
    mem_free(p->workers);
    mem_free(p->sums);
    mem_free(p->rows);
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

/* What light splats and replicas are counted in: about the mean of the picture. Where
 * light is seldom found it goes on until it finds some: in a unit far too large all
 * splats round to 0. */
static void pilot(struct passes *p)
{
    struct welford mean = {0};
    struct worker *w = &p->workers[0];
    long pixels = (long)p->width * p->height;
    long limit = p->light ? PILOT_LIMIT : PILOT_PATHS;
    for (long i = 0; i < PILOT_PATHS || (mean.mean == 0.0 && i < limit); i++) {
        long pixel = i % PILOT_PATHS * pixels / PILOT_PATHS;
        trace_pixel(p, w, (int)(pixel % p->width), (int)(pixel / p->width), RNG_PILOT, i);
        welford_add(&mean, w->contrib.target);
    }
    w->contrib.nonfinite = 0;
    p->unit = mean.mean > 0.0 ? mean.mean : 1.0;
}

static void splat_replica(const struct passes *p, const struct contrib *c, int thread)
{
    struct replica_lane *lane = &p->replicas->lanes[thread];
    long first = p->pass % p->replicas->count * p->width * p->height;
    double factor = REPLICAS_ONE / p->unit;
    for (int i = 0; i < c->count; i++)
        replica_add(lane, first + c->splats[i].pixel,
                    rgb_luminance(c->splats[i].value) * factor,
                    p->workers[thread].rng.s[0]);
    if (c->target > 0.0)
        replica_count(lane, c->target * factor);
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
            assert(light); /* else pt, which makes none */
            film_splat(light, splat->pixel, splat->value, 1.0 / p->unit);
        } else {
            sum[0] += splat->value.r;
            sum[1] += splat->value.g;
            sum[2] += splat->value.b;
        }
    }
}

static void trace_row(void *ctx, long y, int thread)
{
    struct passes *p = ctx;
    struct worker *w = &p->workers[thread];
    double *sum = p->sums + 3 * y * p->width, targets = 0.0;
    for (int x = 0; x < p->width; x++, sum += 3) {
        trace_pixel(p, w, x, (int)y, RNG_PIXEL, p->pass);
        splat_sample(p, &w->contrib, thread, sum);
        targets += w->contrib.target;
    }
    if (p->replicas)
        replica_flush(&p->replicas->lanes[thread]);
    welford_add(&p->rows[y], targets);
}

bool passes_advance(void *self, const struct round_limits *limits)
{
    struct passes *p = self;
    (void)limits;
    if ((p->light || p->replicas) && p->pass == 0)
        pilot(p);
    par_for(p->height, p->threads, trace_row, p);
    p->pass++;
    if (p->replicas && p->pass % p->replicas->count == 0)
        batches_take(&p->batches, p->replicas, (double)p->pass, false, p->threads);
    return p->budget == 0 || p->pass < p->budget;
}

bool passes_started(const void *self)
{
    const struct passes *p = self;
    return p->pass > 0;
}

double passes_progress(const void *self)
{
    const struct passes *p = self;
    return p->budget > 0 ? (double)p->pass / (double)p->budget : 0.0;
}

void passes_picture(void *self, struct image *out)
{
    const struct passes *p = self;
    if (p->light)
        film_fold(p->light, p->threads);
    double scale = p->pass > 0 ? p->scene->emission_scale / (double)p->pass : 0.0;
    for (long i = 0; i < (long)p->width * p->height; i++) {
        struct rgb v = rgb(p->sums[3 * i], p->sums[3 * i + 1], p->sums[3 * i + 2]);
        if (p->light)
            v = rgb_add(v, rgb_scale(film_value(p->light, (int)i), p->unit));
        v = rgb_scale(v, scale);
        out->pixels[3 * i] = (float)v.r;
        out->pixels[3 * i + 1] = (float)v.g;
        out->pixels[3 * i + 2] = (float)v.b;
    }
}

/* Mean over the film in emission units. Each pixel has one sample a pass, so differences
 * between pixels are no error: what counts is how a row's sum varies between passes. */
static void brightness(const struct passes *p, double *b, double *b_se)
{
    double sum = 0.0, variance = 0.0, pixels = (double)p->width * p->height;
    for (int y = 0; y < p->height; y++) {
        sum += p->rows[y].mean;
        variance += welford_variance(&p->rows[y]);
    }
    *b = sum / pixels;
    *b_se = p->pass < 2 ? (double)INFINITY : sqrt(variance / (double)p->pass) / pixels;
}

void passes_statistics(const void *self, struct run_statistics *out)
{
    const struct passes *p = self;
    const double none = (double)NAN;
    double b, b_se;
    brightness(p, &b, &b_se);
    *out = (struct run_statistics){
        .paths = (double)p->pass * p->width * p->height,
        .b = b * p->scene->emission_scale,
        .b_se = b_se * p->scene->emission_scale,
        .plarge = {.p_l = none, .p_l_lo = none, .p_l_hi = none},
        .acceptance = none,
        .failure_rate = none,
        .longest_stay = none,
        .chains_never_moved = none,
        .saturated = p->light ? (double)film_saturated(p->light) : 0.0,
    };
    for (int i = 0; i < p->threads; i++)
        out->nonfinite += (double)p->workers[i].contrib.nonfinite;
}

/* Which worker met a value that was not finite does not matter: the first gets them all.
 */
static void pack_nonfinite(struct passes *p, struct pack *pack)
{
    long nonfinite = 0;
    for (int i = 0; i < p->threads; i++)
        nonfinite += p->workers[i].contrib.nonfinite;
    pack_long(pack, "nonfinite", &nonfinite, 0, LONG_MAX);
    if (pack_reads(pack))
        p->workers[0].contrib.nonfinite = nonfinite;
}

void passes_pack(void *self, struct pack *pack)
{
    struct passes *p = self;
    size_t pixels = (size_t)p->width * (size_t)p->height;
    pack_long(pack, "pass", &p->pass, 0, LONG_MAX);
    pack_doubles(pack, "sums", p->sums, 3 * pixels);
    welford_pack(pack, "rows", p->rows, (size_t)p->height);
    pack_nonfinite(p, pack);
    pack_double(pack, "unit", &p->unit);
    if (p->light) {
        film_fold(p->light, p->threads);
        film_pack(pack, p->light);
    }
    if (p->replicas) {
        replicas_pack(pack, p->replicas);
        batches_pack(pack, &p->batches);
    }
}

/* --- evidence --------------------------------------------------------------------- */

int passes_units(const struct passes *p, int replicas)
{
    return p->pass < replicas ? (int)p->pass : replicas;
}

/* Replicas without a pass stay at the mean, and the others count for as much more. */
void passes_add_deviations(const struct passes *p, long pixel, int replicas, double *out)
{
    double values[REPLICAS_MOST], mean = 0.0;
    int used = p->pass < replicas ? (int)p->pass : replicas;
    assert(p->replicas->count == replicas);
    for (int r = 0; r < used; r++) {
        long passes = (p->pass - r + replicas - 1) / replicas;
        values[r] = replicas_value(p->replicas, r, pixel) / (double)passes;
        mean += values[r] / used;
    }
    if (used < 2)
        return;
    double scale = p->unit * p->scene->emission_scale *
                   sqrt(replicas * (replicas - 1.0) / (used * (used - 1.0)));
    for (int r = 0; r < used; r++)
        out[r] += scale * (values[r] - mean);
}

static double deviations(const void *self, long pixel, double *out)
{
    const struct passes *p = self;
    for (int r = 0; r < p->replicas->count; r++)
        out[r] = 0.0;
    passes_add_deviations(p, pixel, p->replicas->count, out);
    return 0.0;
}

void passes_evidence(void *self, struct evidence *out)
{
    struct passes *p = self;
    double b, b_se;
    *out = (struct evidence){.energy_top = (double)NAN};
    brightness(p, &b, &b_se);
    out->dark = !(b > 0.0);
    if (p->settings->replicas < VERDICT_REPLICAS_LEAST)
        out->missing = "replicas=1";
    else if (!p->replicas)
        out->missing = "the replicas of so large a film take too much memory";
    if (out->missing || out->dark)
        return;
    out->replicas = p->replicas->count;
    out->replicas_wanted = (int)p->settings->replicas;
    out->batches = &p->batches;
    out->deviations = deviations;
    out->self = p;
    out->energy_top = replicas_top(p->replicas, 1e-3);
    out->units = out->fewest = passes_units(p, out->replicas);
    out->b_error = b_se / b;
}

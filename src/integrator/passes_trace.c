/* Independent samples: passes over the rows of the film. */

#include "base/clock.h"
#include "base/par.h"
#include "integrator/passes_state.h"
#include "math/accum.h"

#include <assert.h>
#include <string.h>

#define PILOT_PATHS 4096
#define PILOT_LIMIT (256L * PILOT_PATHS)
#define PILOT_SHARE 0.05 /* of a time budget, at most */
#define LOOK_EVERY  8    /* samples of a thread between two readings of the clock */

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
        passes_sample(p, w, (int)(pixel % p->width), (int)(pixel / p->width), RNG_PILOT,
                      i);
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

/* each: samples of the pixel in a pass; a replica has the means of passes. */
static void splat_replica(const struct passes *p, const struct contrib *c, int thread,
                          double each)
{
    struct replica_lane *lane = &p->pending->lanes[thread];
    double camera = REPLICAS_ONE / p->unit / each;
    double light = REPLICAS_ONE / p->unit * p->adaptive.light_weight;
    for (int i = 0; i < c->count; i++)
        replica_add(lane, lane->base + c->splats[i].pixel,
                    rgb_luminance(c->splats[i].value) *
                        (c->splats[i].t == 1 ? light : camera),
                    p->workers[thread].rng.s[0]);
    if (c->target > 0.0)
        replica_count_brightness(lane, c->target * camera);
}

static void add_exact(struct passes *p, exact_sum *sum, double value)
{
    if (!(fabs(value) <= EXACT_LIMIT))
        __atomic_fetch_add(&p->clamped, 1, __ATOMIC_RELAXED);
    *sum = exact_add(*sum, exact_of(value));
}

static void splat_sample(struct passes *p, const struct contrib *c, int thread,
                         double each, exact_sum *sum)
{
    double rgb[3] = {0.0, 0.0, 0.0}, factor = 1.0 / p->scale;
    if (p->replicas)
        splat_replica(p, c, thread, each);
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

/* The samples of a pixel in a pass. Returns the sum of their targets over their number.
 */
static double trace_pixel(struct passes *p, int x, int y, int thread)
{
    struct worker *w = &p->workers[thread];
    long pixel = (long)y * p->width + x, each = passes_each(p, pixel);
    long number = p->adaptive.start + passes_alike(p) * each;
    double targets = 0.0;
    for (long end = number + each; number < end; number++) {
        passes_sample(p, w, x, y, RNG_PIXEL, number);
        splat_sample(p, &w->contrib, thread, (double)each, p->sums + 3 * pixel);
        if (p->adaptive.measuring)
            passes_measure(p, x, y, thread);
        if (p->layers.count > 0)
            pass_layers_add(&p->layers, w, (int)pixel, p->unit);
        targets += w->whole;
    }
    p->counts[pixel] += (uint32_t)each;
    return targets / (double)each;
}

/* Continues a row where it was left, to its end or to the end of the round. */
static void trace_row(void *ctx, long index, int thread)
{
    struct passes *p = ctx;
    long y = row_of_turn(p, p->turn + index);
    struct pass_row row = p->under_way[y];
    uint32_t begin = row.done, width = (uint32_t)p->width;
    long traced = 0, look = 0;
    if (!part_owns_row(p->part, p->pass, p->height, y)) {
        p->under_way[y].done = width;
        return;
    }
    for (; row.done < width; row.done++) {
        if (traced >= look) {
            if (round_is_over(p))
                break;
            look = traced + LOOK_EVERY;
        }
        row.targets += trace_pixel(p, (int)row.done, (int)y, thread);
        traced += passes_each(p, y * p->width + row.done);
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
        p->pending->lanes[i].base = passes_alike(p) % p->replicas->count * p->width *
                                    p->height;
}

/* Ends a pass and adds it to a replica. A replica gets whole passes only: light splats go
 * to any row, so those of a part of the rows could not be normalised. */
static void end_pass(struct passes *p)
{
    if (p->replicas) {
        long replica = passes_alike(p) % p->replicas->count;
        replicas_move(p->replicas, (int)replica, p->pending);
        for (long y = 0; y < p->height; y++)
            p->replica_rows[replica * p->height + y] += part_owns_row(p->part, p->pass,
                                                                      p->height, y);
    }
    p->pass++;
    if (p->replicas && passes_alike(p) % p->replicas->count == 0)
        time_spans_take(&p->spans, p->replicas, (double)passes_alike(p), false,
                        p->threads);
    p->turn = 0;
    memset(p->under_way, 0, (size_t)p->height * sizeof *p->under_way);
    passes_adaptive_end_pass(p);
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

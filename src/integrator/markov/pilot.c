#include "integrator/markov/pilot.h"

#include "base/mem.h"
#include "base/par.h"
#include "chain/state.h"
#include "integrator/guess.h"
#include "math/rng.h"

#include <math.h>

#define BLOCK 64 /* samples of an index of the parallel loop */

/* --- tracing ---------------------------------------------------------------------- */

/* Samples of one block, in their order. */
struct block {
    struct pilot_splat *splats;
    size_t capacity, count;
    long ends[BLOCK], events, connections;
};

struct trace {
    const struct pilot_job *job;
    struct contrib *contribs; /* [threads] */
    struct block *blocks;
    long count;
};

static void add_splats(struct block *b, const struct contrib *c)
{
    b->splats = mem_grow(b->splats, &b->capacity, b->count + (size_t)c->count,
                         sizeof *b->splats);
    for (int i = 0; i < c->count; i++) {
        const struct splat *s = &c->splats[i];
        int length = s->s + s->t > 0 ? s->s + s->t - 1 : 0;
        double luminance = rgb_luminance(s->value);
        b->splats[b->count++] = (struct pilot_splat){
            s->pixel, (float)fmin(luminance, 1e30), (uint8_t)length, s->t != 1};
    }
}

static void trace_block(void *ctx, long index, int thread)
{
    const struct trace *t = ctx;
    const struct pilot_job *job = t->job;
    const struct target *target = &job->targets[thread];
    struct block *b = &t->blocks[index];
    struct contrib *c = &t->contribs[thread];
    long end = (index + 1) * BLOCK < t->count ? (index + 1) * BLOCK : t->count;
    for (long i = index * BLOCK; i < end; i++) {
        struct rng rng;
        struct ustream_counted camera, light, connect;
        rng_init(&rng, job->seed, RNG_GUESS, (uint64_t)(job->first + i));
        ustream_counted_init(&camera, &rng, &b->events);
        ustream_counted_init(&light, &rng, &b->events);
        ustream_counted_init(&connect, &rng, &b->events);
        struct numbers numbers = {&camera.stream, &light.stream, &connect.stream};
        target->eval(target->ctx, &numbers, c);
        add_splats(b, c);
        b->connections += c->connections;
        b->ends[i - index * BLOCK] = (long)b->count;
    }
}

static void keep(struct pilot *p, const struct block *b, long samples)
{
    long base = p->kept > 0 ? p->ends[p->kept - 1] : 0;
    long room = p->most - p->kept, count = samples < room ? samples : room;
    if (count <= 0)
        return;
    size_t splats = (size_t)b->ends[count - 1];
    p->splats = mem_grow(p->splats, &p->splat_capacity, (size_t)base + splats,
                         sizeof *p->splats);
    for (size_t i = 0; i < splats; i++)
        p->splats[(size_t)base + i] = b->splats[i];
    for (long i = 0; i < count; i++)
        p->ends[p->kept++] = base + b->ends[i];
}

void pilot_trace(struct pilot *p, const struct pilot_job *job, long count)
{
    long blocks = (count + BLOCK - 1) / BLOCK;
    struct trace t = {.job = job, .count = count};
    t.blocks = mem_alloc((size_t)blocks, sizeof *t.blocks);
    t.contribs = mem_alloc((size_t)job->threads, sizeof *t.contribs);
    for (int i = 0; i < job->threads; i++)
        contrib_init(&t.contribs[i], job->max_splats);
    par_for(blocks, job->threads, trace_block, &t);
    for (long i = 0; i < blocks; i++) {
        struct block *b = &t.blocks[i];
        for (size_t k = 0; k < b->count; k++)
            p->luminance[b->splats[k].pixel] += job->factor *
                                                (double)b->splats[k].luminance;
        if (job->keep)
            keep(p, b, count - i * BLOCK < BLOCK ? count - i * BLOCK : BLOCK);
        p->work += state_work(b->events, b->connections);
        mem_free(b->splats);
    }
    for (int i = 0; i < job->threads; i++)
        contrib_deinit(&t.contribs[i]);
    mem_free(t.contribs);
    mem_free(t.blocks);
    p->count += count;
}

/* --- use -------------------------------------------------------------------------- */

void pilot_init(struct pilot *p, int width, int height, long most)
{
    *p = (struct pilot){.width = width, .height = height, .most = most};
    p->luminance = mem_alloc((size_t)width * (size_t)height, sizeof *p->luminance);
    p->ends = mem_alloc((size_t)most, sizeof *p->ends);
}

void pilot_deinit(struct pilot *p)
{
    mem_free(p->luminance);
    mem_free(p->ends);
    mem_free(p->splats);
    *p = (struct pilot){.width = 0};
}

bool pilot_guess(struct pilot *p, bool guess, double floor, struct split *split)
{
    long pixels = (long)p->width * p->height;
    double sum = 0.0;
    for (long j = 0; j < pixels; j++)
        sum += p->luminance[j];
    split->unit = sum / (double)p->count;
    if (!(split->unit > 0.0))
        return false;
    if (!guess) {
        for (long j = 0; j < pixels; j++)
            split->inverse[j] = (float)(1.0 / split->unit);
        return true;
    }
    for (long j = 0; j < pixels; j++)
        p->luminance[j] *= (double)pixels / (double)p->count;
    double dark = fmin(floor, split->unit * split->unit);
    guess_weigh(p->luminance, p->width, p->height, (double)p->count, dark,
                split->inverse);
    for (long j = 0; j < pixels; j++) /* from sqrt(N / (I^2 + e^2)) */
        split->inverse[j] = (float)((double)split->inverse[j] / sqrt((double)pixels));
    return true;
}

/* Relative luminance that the split leaves of one splat; rho: of the whole sample. */
static double left_of(const struct split *split, const struct pilot_splat *s, double rho)
{
    double r = (double)s->luminance * (double)split->inverse[s->pixel];
    if (split->by_technique)
        rho = r * split->techniques[s->length];
    return rho > 0.0 ? (1.0 - split_share(split, rho)) * r : r;
}

static void add_sample(const struct split *split, const struct pilot_splat *splats,
                       long count, struct pilot_rest *out)
{
    double rho = 0.0, camera = 0.0, by_length[DIMS_MAX_DEPTH + 1] = {0.0};
    for (long i = 0; i < count && !split->by_technique; i++)
        rho += (double)splats[i].luminance * (double)split->inverse[splats[i].pixel];
    for (long i = 0; i < count; i++) {
        double left = left_of(split, &splats[i], rho);
        if (splats[i].camera) {
            camera += left;
            out->mean += left;
            by_length[splats[i].length] += left;
        } else {
            out->square += left * left;
            out->by_length[splats[i].length] += left * left;
        }
    }
    out->square += camera * camera;
    for (int k = 0; k <= DIMS_MAX_DEPTH; k++)
        out->by_length[k] += by_length[k] * by_length[k];
}

struct pilot_rest pilot_rest(const struct pilot *p, const struct split *split)
{
    struct pilot_rest sum = {0};
    double n = fmax((double)p->kept, 1.0);
    for (long i = 0, begin = 0; i < p->kept; begin = p->ends[i++])
        add_sample(split, p->splats + begin, p->ends[i] - begin, &sum);
    sum.square /= n;
    sum.mean /= n;
    for (int k = 0; k <= DIMS_MAX_DEPTH; k++)
        sum.by_length[k] /= n;
    return sum;
}

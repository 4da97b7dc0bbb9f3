#include "chain/pss.h"

#include "base/mem.h"
#include "base/pack.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>

static_assert(USTREAM_MAX_COUNT <= KERNEL_BATCH, "one event must fit a batch");

/* An inconsistency of the tables of dims.h: going on would overwrite memory or bias the
 * chain. */
static _Noreturn void stop(const struct pss_stream *s, int place, int count)
{
    fprintf(stderr,
            "etalon: internal error: a path asked for numbers [%d, %d+%d) of a stream of "
            "%d places after %d events\n",
            place, place, count, s->capacity, s->touched_count);
    abort();
}

#ifndef NDEBUG
/* True if a place of the block was already asked for. Linear search, for assert only. */
static bool touched_before(const struct pss_stream *s, int place, int count)
{
    for (int i = 0; i < s->touched_count; i++) {
        const struct pss_block *b = &s->touched[i];
        if (place < b->place + b->count && b->place < place + count)
            return true;
    }
    return false;
}
#endif

/* Rare cases are not inlined, so that taking numbers is a short leaf function. */
#define SELDOM __attribute__((noinline, cold))

static SELDOM void refill_displacements(struct pss *pss)
{
    pss->kernel.type->draw(&pss->kernel, pss->state.rng, pss->displacements);
    pss->displacements_left = KERNEL_BATCH;
}

static SELDOM void refill_uniforms(struct pss *pss)
{
    struct rng rng = *pss->state.rng; /* in registers for the whole batch */
    for (int i = 0; i < KERNEL_BATCH; i++)
        pss->uniforms[i] = rng_double(&rng);
    *pss->state.rng = rng;
    pss->uniforms_left = KERNEL_BATCH;
}

/* Takes `count` displacements; drops the rest of the batch if it is too short. */
static inline const double *take_displacements(struct pss *pss, int count)
{
    if (pss->displacements_left < count)
        refill_displacements(pss);
    pss->displacements_left -= count;
    return pss->displacements + pss->displacements_left;
}

/* Uniforms are used in the generator's order without gaps, so that a replayed seed gets
 * the same numbers as in the bootstrap. */
static inline double take_uniform(struct pss *pss)
{
    if (pss->uniforms_left == 0)
        refill_uniforms(pss);
    return pss->uniforms[KERNEL_BATCH - pss->uniforms_left--];
}

double pss_uniform(struct pss *pss)
{
    return take_uniform(pss);
}

/* Applies the accepted small and second-stage steps that the number has missed. */
static double catch_up(struct pss *pss, double x, int64_t variance)
{
    const struct kernel *k = &pss->kernel;
    if (k->type->stable) {
        double width = sqrt((double)variance) / k->second_stage;
        return kernel_wrap(x + width * *take_displacements(pss, 1));
    }
    for (; variance > 0; variance--) /* k->second_stage is 1: a step each */
        x = kernel_wrap(x + *take_displacements(pss, 1));
    return x;
}

/* Brings current[place ...] up to the last accepted step. Small steps keep a uniform
 * distribution, so a number that was redrawn needs none of them. */
static SELDOM void refresh(struct pss *pss, struct pss_stream *s, int place, int count)
{
    for (int i = place; i < place + count; i++) {
        if (s->stamp[i] < pss->last_large)
            s->current[i] = take_uniform(pss);
        else
            s->current[i] = catch_up(pss, s->current[i], pss->clock - s->stamp[i]);
        s->stamp[i] = pss->clock;
    }
}

static inline bool is_fresh(const struct pss *pss, const struct pss_stream *s, int place,
                            int count)
{
    int64_t missed = 0;
    for (int i = place; i < place + count; i++)
        missed |= s->stamp[i] ^ pss->clock;
    return missed == 0;
}

static inline double *touch(struct pss_stream *s, int place, int count)
{
    assert(!touched_before(s, place, count));
    if (place < 0 || count < 1 || count > USTREAM_MAX_COUNT ||
        place > s->capacity - count || s->touched_count == s->capacity)
        stop(s, place, count);
    s->touched[s->touched_count++] = (struct pss_block){(uint16_t)place, (uint16_t)count};
    return s->proposed + place;
}

double *pss_touch(struct pss_stream *s, int place, int count)
{
    return touch(s, place, count);
}

static const double *take(struct ustream *self, int place, int count)
{
    struct pss_stream *s = (struct pss_stream *)self;
    struct pss *pss = s->owner;
    double *out = touch(s, place, count);
    if (pss->large) {
        for (int i = 0; i < count; i++)
            out[i] = take_uniform(pss);
        return out;
    }
    if (!is_fresh(pss, s, place, count))
        refresh(pss, s, place, count);
    const double *d = take_displacements(pss, count);
    for (int i = 0; i < count; i++)
        out[i] = kernel_wrap(s->current[place + i] + pss->width * d[i]);
    return out;
}

static void stream_arrays(struct pss_stream *s, struct mem_plan *plan)
{
    size_t n = (size_t)s->capacity;
    s->current = mem_take(plan, MEM_APART, n, sizeof *s->current);
    s->proposed = mem_take(plan, MEM_APART, n, sizeof *s->proposed);
    s->stamp = mem_take(plan, MEM_APART, n, sizeof *s->stamp);
    s->touched = mem_take(plan, MEM_APART, n, sizeof *s->touched);
    s->first_stage = mem_take(plan, MEM_APART, n, sizeof *s->first_stage);
    s->first_stage_touched = mem_take(plan, MEM_APART, n, sizeof *s->first_stage_touched);
}

void pss_init(struct pss *pss, const int capacity[PSS_STREAMS],
              const struct kernel *kernel, struct rng *rng)
{
    assert(kernel->second_stage == 1 ||
           (kernel->second_stage > 1 && kernel->type->stable));
    *pss = (struct pss){.state = {.type = &state_pss, .rng = rng}, .kernel = *kernel};
    for (int i = 0; i < PSS_STREAMS; i++) {
        struct pss_stream *s = &pss->streams[i];
        assert(capacity[i] >= 0 && capacity[i] <= UINT16_MAX);
        s->stream.take = take;
        s->owner = pss;
        s->capacity = capacity[i];
        stream_arrays(s, &(struct mem_plan){.take = true});
    }
    pss_reset(pss);
}

double pss_bytes(const int capacity[PSS_STREAMS])
{
    struct mem_plan plan = {.take = false};
    for (int i = 0; i < PSS_STREAMS; i++)
        stream_arrays(&(struct pss_stream){.capacity = capacity[i]}, &plan);
    return plan.bytes;
}

void pss_deinit(struct pss *pss)
{
    for (int i = 0; i < PSS_STREAMS; i++) {
        mem_free(pss->streams[i].current);
        mem_free(pss->streams[i].proposed);
        mem_free(pss->streams[i].stamp);
        mem_free(pss->streams[i].touched);
        mem_free(pss->streams[i].first_stage);
        mem_free(pss->streams[i].first_stage_touched);
    }
}

void pss_reset(struct pss *pss)
{
    for (int i = 0; i < PSS_STREAMS; i++) {
        struct pss_stream *s = &pss->streams[i];
        s->touched_count = 0;
        for (int j = 0; j < s->capacity; j++)
            s->stamp[j] = -1;
    }
    pss->clock = 0;
    pss->last_large = 0;
    pss_drop_batches(pss);
}

void pss_drop_batches(struct pss *pss)
{
    pss->displacements_left = 0;
    pss->uniforms_left = 0;
}

struct numbers pss_numbers(struct pss *pss)
{
    return (struct numbers){
        .camera = &pss->streams[PSS_CAMERA].stream,
        .light = &pss->streams[PSS_LIGHT].stream,
        .connect = &pss->streams[PSS_CONNECT].stream,
    };
}

void pss_begin(struct pss *pss, bool large)
{
    pss->large = large;
    pss->variance = (int64_t)pss->kernel.second_stage * pss->kernel.second_stage;
    pss->width = 1.0;
    pss_reject(pss);
}

#define UNDRAWN (-1.0)

/* Keeps a failed small step while the second proposal is made. */
static void set_aside(struct pss_stream *s)
{
    double *numbers = s->proposed;
    struct pss_block *blocks = s->touched;
    s->proposed = s->first_stage;
    s->touched = s->first_stage_touched;
    s->first_stage = numbers;
    s->first_stage_touched = blocks;
    s->first_stage_count = s->touched_count;
    for (int j = 0; j < s->first_stage_count; j++) {
        for (int k = 0; k < blocks[j].count; k++)
            s->proposed[blocks[j].place + k] = UNDRAWN;
    }
}

void pss_begin_second_stage(struct pss *pss)
{
    assert(pss->kernel.type->log_density);
    for (int i = 0; i < PSS_STREAMS; i++) {
        struct pss_stream *s = &pss->streams[i];
        if (pss->large)
            s->first_stage_count = 0;
        else
            set_aside(s);
        s->touched_count = 0;
    }
    pss->large = false;
    pss->variance = 1;
    pss->width = 1.0 / pss->kernel.second_stage;
}

static double block_log_ratio(struct pss *pss, struct pss_stream *s, struct pss_block b)
{
    double from_proposed[USTREAM_MAX_COUNT], from_current[USTREAM_MAX_COUNT];
    for (int j = 0; j < b.count; j++) {
        int i = b.place + j;
        if (s->proposed[i] == UNDRAWN)
            take(&s->stream, i, 1);
        from_proposed[j] = s->first_stage[i] - s->proposed[i];
        from_current[j] = s->first_stage[i] - s->current[i];
    }
    const struct kernel *k = &pss->kernel;
    /* log q1(y1|y2) - log q1(y1|x) of the second stage [GreenMira01]. */
    return k->type->log_density(k, from_proposed, b.count) -
           k->type->log_density(k, from_current, b.count);
}

double pss_second_stage_log_ratio(struct pss *pss)
{
    double sum = 0.0;
    for (int i = 0; i < PSS_STREAMS; i++) {
        struct pss_stream *s = &pss->streams[i];
        for (int j = 0; j < s->first_stage_count; j++)
            sum += block_log_ratio(pss, s, s->first_stage_touched[j]);
    }
    return sum;
}

void pss_accept(struct pss *pss)
{
    pss->clock += pss->variance;
    if (pss->large)
        pss->last_large = pss->clock;
    for (int i = 0; i < PSS_STREAMS; i++) {
        struct pss_stream *s = &pss->streams[i];
        for (int j = 0; j < s->touched_count; j++) {
            struct pss_block b = s->touched[j];
            for (int k = b.place; k < b.place + b.count; k++) {
                s->current[k] = s->proposed[k];
                s->stamp[k] = pss->clock;
            }
        }
    }
    pss_reject(pss);
}

void pss_reject(struct pss *pss)
{
    for (int i = 0; i < PSS_STREAMS; i++)
        pss->streams[i].touched_count = 0;
}

/* Writes 0 in `current` for numbers that were never drawn. */
void pss_pack(struct pack *pack, struct pss *pss)
{
    pack_int64s(pack, "clock", &pss->clock, 1);
    pack_int64s(pack, "last_large", &pss->last_large, 1);
    for (int i = 0; i < PSS_STREAMS; i++) {
        struct pss_stream *s = &pss->streams[i];
        pack_doubles(pack, "current", s->current, (size_t)s->capacity);
        pack_int64s(pack, "stamp", s->stamp, (size_t)s->capacity);
    }
    pack_int(pack, "displacements_left", &pss->displacements_left, 0, KERNEL_BATCH);
    pack_doubles(pack, "displacements", pss->displacements, KERNEL_BATCH);
    pack_int(pack, "uniforms_left", &pss->uniforms_left, 0, KERNEL_BATCH);
    pack_doubles(pack, "uniforms", pss->uniforms, KERNEL_BATCH);
}

/* ---- as a type of state ---- */

static struct pss *pss_of(struct state *state)
{
    return (struct pss *)state;
}

static void init(struct state *state, const void *options)
{
    const struct pss_options *o = options;
    pss_init(pss_of(state), o->capacity, &o->kernel, state->rng);
}

static void deinit(struct state *state)
{
    pss_deinit(pss_of(state));
}

static double bytes(const void *options)
{
    const struct pss_options *o = options;
    return pss_bytes(o->capacity);
}

static void rng_changed(struct state *state)
{
    pss_drop_batches(pss_of(state));
}

/* Small and large steps have symmetric transition densities, and so has the second
 * stage's own step. */
static struct proposal propose(struct state *state, const struct target *target,
                               enum move move, struct contrib *out)
{
    struct pss *pss = pss_of(state);
    double log_ratio = 0.0;
    if (move == MOVE_SECOND_STAGE)
        pss_begin_second_stage(pss);
    else
        pss_begin(pss, move == MOVE_LARGE);
    struct numbers numbers = pss_numbers(pss);
    target->eval(target->ctx, &numbers, out);
    if (move == MOVE_SECOND_STAGE && out->target > 0.0 && out->target < HUGE_VAL)
        log_ratio = pss_second_stage_log_ratio(pss);
    return (struct proposal){(int)move, log_ratio};
}

/* The random events that the proposal asked for, and the connections of sub-paths. */
static double work(const struct state *state, const struct contrib *proposed)
{
    const struct pss *pss = (const struct pss *)state;
    long events = 0;
    for (int i = 0; i < PSS_STREAMS; i++)
        events += pss->streams[i].touched_count;
    return state_work(events, proposed->connections);
}

static void accept(struct state *state)
{
    pss_accept(pss_of(state));
}

static void reject(struct state *state)
{
    pss_reject(pss_of(state));
}

static void pack_state(struct pack *pack, struct state *state)
{
    pss_pack(pack, pss_of(state));
}

const struct state_type state_pss = {
    .moves = {[MOVE_LARGE] = "large",
              [MOVE_SECOND_STAGE] = "second_stage",
              [MOVE_SMALL] = "small"},
    .size = sizeof(struct pss),
    .init = init,
    .deinit = deinit,
    .bytes = bytes,
    .rng_changed = rng_changed,
    .propose = propose,
    .accept = accept,
    .reject = reject,
    .work = work,
    .pack = pack_state,
};

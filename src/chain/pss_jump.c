#include "chain/pss_jump.h"

#include "base/mem.h"
#include "base/pack.h"

#include <assert.h>

#define UNDRAWN (-1.0)

struct pss_jump {
    struct pss pss; /* must be first */
    double share;   /* of jumps among local moves */
    pss_invert invert;
    bool (*invertible)(void *ctx);
    struct found_numbers found[PSS_STREAMS];
    struct found correction; /* of these numbers */
    const double *(*take)(struct ustream *self, int place, int count); /* that of pss */
    int replayed;                   /* events of the current sample, evaluated again */
    bool carries, proposed_carries; /* light: the current sample, and the proposed one */
};

static struct pss_jump *jump_of(struct state *state)
{
    return (struct pss_jump *)state;
}

/* What the current sample has there: numbers up to date, as it has asked for them. */
static const double *take_again(struct ustream *self, int place, int count)
{
    struct pss_stream *s = (struct pss_stream *)self;
    ((struct pss_jump *)s->owner)->replayed++;
    for (int i = place; i < place + count; i++)
        assert(s->stamp[i] == s->owner->clock);
    return s->current + place;
}

static const enum found_stream streams[PSS_STREAMS] = {
    [PSS_CAMERA] = FOUND_CAMERA,
    [PSS_LIGHT] = FOUND_LIGHT,
    [PSS_CONNECT] = FOUND_CONNECT,
};

/* The number found; else that of the current sample; else a new one. */
static const double *take_found(struct ustream *self, int place, int count)
{
    struct pss_stream *s = (struct pss_stream *)self;
    struct pss *pss = s->owner;
    struct pss_jump *jump = (struct pss_jump *)pss;
    enum pss_stream_id stream = (enum pss_stream_id)(s - pss->streams);
    const struct found_numbers *f = &jump->found[stream];
    double *out = pss_touch(s, place, count);
    for (int i = 0; i < count; i++) {
        int at = place + i;
        if (f->value[at] >= 0.0)
            out[i] = f->value[at];
        else if (at < f->kept && s->stamp[at] == pss->clock)
            out[i] = s->current[at];
        else
            out[i] = pss_uniform(pss);
    }
    if (f->value[place] >= 0.0 && jump->correction.correct)
        jump->correction.correct(jump->correction.ctx, streams[stream], place, out,
                                 count);
    return out;
}

static struct numbers numbers_by(struct pss *pss,
                                 const double *(*take)(struct ustream *self, int place,
                                                       int count))
{
    for (int i = 0; i < PSS_STREAMS; i++)
        pss->streams[i].stream.take = take;
    return pss_numbers(pss);
}

static struct found begin_found(struct pss_jump *jump)
{
    for (int i = 0; i < PSS_STREAMS; i++) {
        jump->found[i].kept = 0;
        for (int j = 0; j < jump->pss.streams[i].capacity; j++)
            jump->found[i].value[j] = UNDRAWN;
    }
    return (struct found){jump->found[PSS_CAMERA], jump->found[PSS_LIGHT],
                          jump->found[PSS_CONNECT], NULL, NULL};
}

static void end_found(struct pss_jump *jump, const struct found *found)
{
    jump->found[PSS_CAMERA].kept = found->camera.kept;
    jump->found[PSS_LIGHT].kept = found->light.kept;
    jump->found[PSS_CONNECT].kept = found->connect.kept;
    jump->correction = *found;
}

static void fail(struct contrib *out)
{
    contrib_clear(out);
    out->failure = FAILURE_INVERSE;
}

/* Evaluates the numbers found; `before` is the target of the current sample. Where
 * rounding has led to another sample, nothing leads back: the jump is no symmetric move.
 */
static void evaluate(struct pss_jump *jump, const struct target *target, double before,
                     struct contrib *out)
{
    pss_begin(&jump->pss, true);
    struct numbers numbers = numbers_by(&jump->pss, take_found);
    target->eval(target->ctx, &numbers, out);
    double most = PSS_JUMP_TOLERANCE * fmin(before, out->target); /* of both ways */
    if (!(fabs(out->target - before) <= most))
        fail(out);
}

static struct proposal jump(struct pss_jump *jump, const struct target *target,
                            struct contrib *out)
{
    struct pss *pss = &jump->pss;
    pss_begin(pss, false);
    pss->variance = 0; /* if nothing changes */
    struct found found = begin_found(jump);
    struct numbers current = numbers_by(pss, take_again);
    enum inversion result = jump->invert(target->ctx, &current, pss->state.rng, &found,
                                         out);
    end_found(jump, &found);
    if (result == INVERSION_NONE)
        fail(out);
    else if (result == INVERSION_OTHER)
        evaluate(jump, target, out->target, out);
    numbers_by(pss, jump->take);
    return (struct proposal){result == INVERSION_SAME ? MOVE_STAY : MOVE_JUMP, 0.0};
}

/* A sample without light has no other numbers worth a look, and where all samples are
 * made in one way there are none. */
static bool may_jump(const struct pss_jump *jump, const struct target *target)
{
    return jump->carries && (!jump->invertible || jump->invertible(target->ctx));
}

static struct proposal propose(struct state *state, const struct target *target,
                               enum move move, struct contrib *out)
{
    struct pss_jump *self = jump_of(state);
    struct proposal proposal;
    self->replayed = 0;
    if (move == MOVE_LOCAL && may_jump(self, target) &&
        rng_double(state->rng) < self->share)
        proposal = jump(self, target, out);
    else
        proposal = state_pss.propose(state, target, move, out);
    self->proposed_carries = out->target > 0.0;
    return proposal;
}

static void found_arrays(struct pss_jump *jump, const int capacity[PSS_STREAMS],
                         struct mem_plan *plan)
{
    for (int i = 0; i < PSS_STREAMS; i++)
        jump->found[i].value = mem_take(plan, 0, (size_t)capacity[i],
                                        sizeof *jump->found[i].value);
}

static void init(struct state *state, const void *options)
{
    const struct pss_options *o = options;
    struct pss_jump *self = jump_of(state);
    const struct state_type *type = state->type;
    state_pss.init(state, options);
    state->type = type;
    self->take = self->pss.streams[0].stream.take;
    self->share = o->jump;
    self->invert = o->invert;
    self->invertible = o->invertible;
    found_arrays(self, o->capacity, &(struct mem_plan){.take = true});
}

static void deinit(struct state *state)
{
    for (int i = 0; i < PSS_STREAMS; i++)
        mem_free(jump_of(state)->found[i].value);
    state_pss.deinit(state);
}

static double bytes(const void *options)
{
    const struct pss_options *o = options;
    struct mem_plan plan = {.take = false};
    found_arrays(&(struct pss_jump){.share = 0.0}, o->capacity, &plan);
    return state_pss.bytes(options) + plan.bytes;
}

static void rng_changed(struct state *state)
{
    state_pss.rng_changed(state);
}

static void accept(struct state *state)
{
    state_pss.accept(state);
    jump_of(state)->carries = jump_of(state)->proposed_carries;
}

static void reject(struct state *state)
{
    state_pss.reject(state);
}

/* The events of both evaluations. */
static double work(const struct state *state, const struct contrib *proposed)
{
    const struct pss_jump *self = (const struct pss_jump *)state;
    return WORK_EVENT * self->replayed + state_pss.work(state, proposed);
}

static void pack_state(struct pack *pack, struct state *state)
{
    state_pss.pack(pack, state);
    pack_flag(pack, "carries", &jump_of(state)->carries);
}

const struct state_type state_pss_jump = {
    .moves = {[MOVE_LARGE] = "large",
              [MOVE_SECOND_STAGE] = "second_stage",
              [MOVE_SMALL] = "small",
              [MOVE_JUMP] = "jump",
              [MOVE_STAY] = "same_technique"},
    .size = sizeof(struct pss_jump),
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

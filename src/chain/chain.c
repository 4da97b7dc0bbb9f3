#include "chain/chain.h"

#include "base/pack.h"
#include "chain/step.h"

#include <limits.h>

void chain_init(struct chain *chain, const struct state_type *type, const void *options,
                int max_splats)
{
    *chain = (struct chain){0};
    chain->state = mem_aligned(MEM_APART, 1, type->size);
    *chain->state = (struct state){.type = type, .rng = &chain->rng};
    if (type->init)
        type->init(chain->state, options);
    for (int i = 0; i < 2; i++)
        contrib_init(&chain->contribs[i], max_splats);
    chain->current = &chain->contribs[0];
    chain->proposed = &chain->contribs[1];
}

double chain_bytes(const struct state_type *type, const void *options, int max_splats)
{
    double state = (double)type->size + (type->bytes ? type->bytes(options) : 0.0);
    return state + 2.0 * contrib_bytes(max_splats);
}

void chain_deinit(struct chain *chain)
{
    if (chain->state->type->deinit)
        chain->state->type->deinit(chain->state);
    mem_free(chain->state);
    for (int i = 0; i < 2; i++)
        contrib_deinit(&chain->contribs[i]);
}

static void set_rng(struct chain *chain, uint64_t seed, enum rng_purpose purpose,
                    uint64_t index)
{
    rng_init(&chain->rng, seed, purpose, index);
    if (chain->state->type->rng_changed)
        chain->state->type->rng_changed(chain->state);
}

void chain_seed(struct chain *chain, const struct target *target, uint64_t seed,
                uint64_t bootstrap_index, uint64_t id)
{
    chain->state->seed = seed;
    chain->state->chain = id;
    set_rng(chain, seed, RNG_BOOTSTRAP, bootstrap_index);
    step_evaluate(chain, target, MOVE_LARGE, chain->current);
    chain->state->type->accept(chain->state);
    set_rng(chain, seed, RNG_CHAIN, id);
    chain->tally = (struct tally){0};
    chain->current->nonfinite = 0; /* already counted by the bootstrap */
    chain->pending_weight = 0.0;
    chain->rejections_in_row = chain->most_rejections_in_row = 0;
}

void chain_flush(struct chain *chain, const struct chain_params *params,
                 const struct chain_sinks *sinks)
{
    if (chain->pending_weight > 0.0) {
        double weight = splat_weight(params, chain->current->target);
        splat_sinks_add(&sinks->states, chain->current, chain->pending_weight * weight,
                        chain->rng.s[0]);
    }
    chain->pending_weight = 0.0;
}

/* Of the last proposal only the count of non-finite values is state. */
void chain_pack(struct pack *pack, struct chain *chain, long pixels)
{
    const struct state_type *type = chain->state->type;
    rng_pack(pack, &chain->rng);
    type->pack(pack, chain->state);
    contrib_pack(pack, chain->current, pixels);
    pack_long(pack, "proposed_nonfinite", &chain->proposed->nonfinite, 0, LONG_MAX);
    pack_double(pack, "pending_weight", &chain->pending_weight);
    tally_pack(pack, &chain->tally, type->moves);
    pack_int64s(pack, "rejections_in_row", &chain->rejections_in_row, 1);
    pack_int64s(pack, "most_rejections_in_row", &chain->most_rejections_in_row, 1);
}

#include "chain/chain.h"

#include "base/pack.h"

#include <limits.h>
#include <math.h>

/* Below this the weight of one splat would leave the range of double: 1/I has to survive
 * the film's scale and a bright splat. Such a state is dimmer than the brightest by 270
 * orders of magnitude. */
#define TARGET_FLOOR 0x1p-900

double chain_splat_weight(const struct chain_params *params, double target)
{
    double shift = params->estimator == ESTIMATOR_KELEMEN ? params->p_large * params->b0
                                                          : 0.0;
    return 1.0 / fmax(target + shift, TARGET_FLOOR);
}

void chain_init(struct chain *chain, const int capacity[PSS_STREAMS], int max_splats,
                const struct kernel *kernel)
{
    *chain = (struct chain){0};
    pss_init(&chain->pss, capacity, kernel, &chain->rng);
    for (int i = 0; i < 2; i++)
        contrib_init(&chain->states[i], max_splats);
    chain->current = &chain->states[0];
    chain->proposed = &chain->states[1];
}

double chain_bytes(const int capacity[PSS_STREAMS], int max_splats)
{
    return sizeof(struct chain) + pss_bytes(capacity) + 2.0 * contrib_bytes(max_splats);
}

void chain_deinit(struct chain *chain)
{
    pss_deinit(&chain->pss);
    for (int i = 0; i < 2; i++)
        contrib_deinit(&chain->states[i]);
}

void chain_seed(struct chain *chain, const struct target *target, uint64_t seed,
                uint64_t bootstrap_index, uint64_t id)
{
    rng_init(&chain->rng, seed, RNG_BOOTSTRAP, bootstrap_index);
    pss_reset(&chain->pss);
    pss_begin(&chain->pss, true);
    chain_evaluate(chain, target, chain->current);
    pss_accept(&chain->pss);
    rng_init(&chain->rng, seed, RNG_CHAIN, id);
    pss_drop_batches(&chain->pss);
    chain->tally = (struct tally){0};
    chain->current->nonfinite = 0; /* the bootstrap has counted them */
    chain->held = 0.0;
    chain->stay = chain->longest_stay = 0;
}

void chain_evaluate(struct chain *chain, const struct target *target, struct contrib *out)
{
    struct numbers numbers = pss_numbers(&chain->pss);
    target->eval(target->ctx, &numbers, out);
    if (!(out->target >= 0.0 && out->target < HUGE_VAL)) {
        out->nonfinite++;
        contrib_clear(out);
    }
}

void chain_splat(const struct contrib *contrib, struct film *film, double weight)
{
    for (int i = 0; i < contrib->count; i++)
        film_splat(film, contrib->splats[i].pixel, contrib->splats[i].value, weight);
}

void chain_splat_replicas(const struct chain *chain, const struct contrib *contrib,
                          double weight, bool large)
{
    const struct chain_aim *aim = &chain->aim;
    for (int j = 0; j < aim->count; j++) {
        const struct chain_share *share = &aim->shares[j];
        double factor = weight * (large ? share->large : share->chain) * REPLICAS_ONE;
        for (int i = 0; i < contrib->count; i++)
            replica_add(aim->lane, share->first + contrib->splats[i].pixel,
                        rgb_luminance(contrib->splats[i].value) * factor,
                        chain->rng.s[0]);
    }
    if (aim->count > 0)
        replica_count(aim->lane, contrib->target * weight * aim->scale);
}

void chain_add_large(const struct chain *chain, const struct contrib *proposed)
{
    const struct chain_aim *aim = &chain->aim;
    for (int i = 0; aim->large && i < proposed->count; i++)
        aim->large[aim->tile_of[proposed->splats[i].pixel]] += rgb_luminance(
            proposed->splats[i].value);
}

static bool pixel_seen(const struct contrib *contrib, int count, int pixel)
{
    for (int i = 0; i < count; i++) {
        if (contrib->splats[i].pixel == pixel)
            return true;
    }
    return false;
}

void chain_splat_failure(const struct chain *chain, struct film *film)
{
    const struct contrib *x = chain->current;
    struct rgb value = rgb(chain->proposed->target > 0.0 ? 0.0 : 1.0, 1.0, 0.0);
    for (int i = 0; i < x->count; i++) {
        if (!pixel_seen(x, i, x->splats[i].pixel))
            film_splat(film, x->splats[i].pixel, value, 1.0);
    }
}

void chain_flush(struct chain *chain, const struct chain_params *params,
                 const struct chain_films *films)
{
    if (chain->held > 0.0) {
        double weight = chain_splat_weight(params, chain->current->target);
        chain_splat(chain->current, films->chain,
                    chain->held * weight * params->chain_scale);
        chain_splat_replicas(chain, chain->current, chain->held * weight, false);
    }
    chain->held = 0.0;
}

void chain_accept(struct chain *chain)
{
    struct contrib *replaced = chain->current;
    chain->current = chain->proposed;
    chain->proposed = replaced;
    pss_accept(&chain->pss);
    chain->stay = 0;
}

void chain_reject(struct chain *chain)
{
    pss_reject(&chain->pss);
    if (++chain->stay > chain->longest_stay)
        chain->longest_stay = chain->stay;
}

/* Of the proposal, which was settled, only the count that is for all the run. */
void chain_pack(struct pack *pack, struct chain *chain, long pixels)
{
    rng_pack(pack, &chain->rng);
    pss_pack(pack, &chain->pss);
    contrib_pack(pack, chain->current, pixels);
    pack_long(pack, "proposed_nonfinite", &chain->proposed->nonfinite, 0, LONG_MAX);
    pack_double(pack, "held", &chain->held);
    tally_pack(pack, &chain->tally);
    pack_int64s(pack, "stay", &chain->stay, 1);
    pack_int64s(pack, "longest_stay", &chain->longest_stay, 1);
}

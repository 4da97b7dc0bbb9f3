#ifndef ETALON_TESTS_SUPPORT_STIFF_VERDICT_H
#define ETALON_TESTS_SUPPORT_STIFF_VERDICT_H

/* What the verdict says of chains on a stiff target. */

#include "convergence/verdict.h"
#include "support/stiff_target.h"

#include <stdio.h>

enum { STIFF_PARTS = 8, STIFF_SPANS = 16, STIFF_TILES = 8, STIFF_SIDE = TILE_LEAST };

/* Parts that are equal: nothing here to doubt. */
static inline double stiff_deviations(const void *self, long pixel, double *out)
{
    (void)self;
    (void)pixel;
    for (int r = 0; r < STIFF_PARTS; r++)
        out[r] = r % 2 ? -0.01 : 0.01;
    return 0.0;
}

/* One span of one chain, each cell into a tile of its own. */
static inline void stiff_add_span(struct chain *chain, const struct stiff *stiff,
                                  double p_large, const struct stiff_setup *setup,
                                  long mutations, struct replica_lane *lane, int part,
                                  const struct film_sinks *films)
{
    double b = stiff_integral(stiff);
    struct chain_params params = {p_large, b, setup->estimator};
    struct target target = {stiff_eval, (void *)(uintptr_t)stiff};
    film_clear(films->chain);
    film_clear(films->large);
    setup->step->advance(chain, &params, &target, &films->sinks, mutations);
    chain_flush(chain, &params, &films->sinks);
    for (int j = 0; j < stiff->cells; j++) {
        double sum = film_value(films->chain, j).g + film_value(films->large, j).g;
        replica_add(lane, (int64_t)(part * STIFF_SIDE * STIFF_TILES + j) * STIFF_SIDE,
                    sum * REPLICAS_ONE, chain->rng.s[0]);
    }
}

/* STIFF_CHAINS chains in STIFF_PARTS parts, all from exact samples. */
static inline enum verdict_call stiff_judge(const struct stiff *stiff,
                                            const struct stiff_setup *setup,
                                            double p_large, long mutations, char *words,
                                            size_t size)
{
    static struct chain chains[STIFF_CHAINS];
    struct replicas *r = replicas_create(STIFF_TILES * STIFF_SIDE, STIFF_SIDE,
                                         STIFF_PARTS, 1, true);
    struct image *picture = image_create(STIFF_TILES * STIFF_SIDE, STIFF_SIDE);
    struct time_spans spans;
    struct film_sinks films;
    film_sinks_create(&films, stiff->cells, setup->estimator, false);
    for (int i = 0; i < 3 * STIFF_TILES * STIFF_SIDE * STIFF_SIDE; i++)
        picture->pixels[i] = 1.0f;
    time_spans_init(&spans, r, 1.0);
    for (int i = 0; i < STIFF_CHAINS; i++) {
        stiff_chain_init(&chains[i], stiff, setup);
        stiff_start(&chains[i], stiff, 77, (uint64_t)i);
    }
    for (int span = 0; span < STIFF_SPANS - 1; span++) {
        for (int i = 0; i < STIFF_CHAINS; i++)
            stiff_add_span(&chains[i], stiff, p_large, setup, mutations, &r->lanes[0],
                           i % STIFF_PARTS, &films);
        replica_flush(&r->lanes[0]);
        time_spans_take(&spans, r, span + 1.0, false, 1);
    }
    struct evidence evidence = {.replicas = STIFF_PARTS,
                                .spans = &spans,
                                .deviations = stiff_deviations,
                                .replicas_with_pass = STIFF_PARTS,
                                .fewest_replicas = STIFF_PARTS};
    struct verdict v;
    verdict_find(&evidence, picture, &v);
    enum verdict_call call = v.call;
    snprintf(words, size, "%s: %.120s, R-hat %.3f, effective %.0f", verdict_name(call),
             v.words, v.rhat_max, v.ess_min);
    verdict_deinit(&v);
    for (int i = 0; i < STIFF_CHAINS; i++)
        chain_deinit(&chains[i]);
    film_sinks_destroy(&films);
    time_spans_deinit(&spans);
    image_destroy(picture);
    replicas_destroy(r);
    return call;
}

#endif

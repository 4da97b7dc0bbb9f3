/* Chains that cannot mix in their budget, by the rule: every part of the run is right on
 * average and none is by itself, so the verdict has to doubt them. Where large steps make
 * up for it, it must not. */
#include "integrator/verdict.h"
#include "support/stiff_target.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include <stdio.h>

enum { PARTS = 8, SPANS = 16, CELLS = 8, SIDE = TILE_LEAST };

/* Parts that are equal: nothing here to doubt. */
static double deviations(const void *self, long pixel, double *out)
{
    (void)self;
    (void)pixel;
    for (int r = 0; r < PARTS; r++)
        out[r] = r % 2 ? -0.01 : 0.01;
    return 0.0;
}

/* One span of one chain, each cell into a tile of its own. */
static void add_span(struct chain *chain, const struct stiff *stiff, double p_large,
                     enum estimator estimator, long mutations, struct replica_lane *lane,
                     int part, const struct chain_films *films)
{
    double b = stiff_integral(stiff);
    struct chain_params params = {p_large, b, estimator, 1.0, 1.0};
    struct target target = {stiff_eval, (void *)(uintptr_t)stiff};
    film_clear(films->chain);
    film_clear(films->large);
    step_mh.advance(chain, &params, &target, films, mutations);
    chain_flush(chain, &params, films);
    film_fold(films->chain, 1);
    film_fold(films->large, 1);
    for (int j = 0; j < stiff->cells; j++) {
        double sum = film_value(films->chain, j).g + film_value(films->large, j).g;
        replica_add(lane, (int64_t)(part * SIDE * CELLS + j) * SIDE, sum * REPLICAS_ONE);
    }
}

/* STIFF_CHAINS chains in PARTS parts, all from exact samples. */
static enum verdict_call judge(const struct stiff *stiff, enum estimator estimator,
                               double p_large, long mutations)
{
    static struct chain chains[STIFF_CHAINS];
    struct replicas *r = replicas_create(CELLS * SIDE, SIDE, PARTS, 1, true);
    struct image *picture = image_create(CELLS * SIDE, SIDE);
    struct batches batches;
    struct chain_films films = {film_create(stiff->cells, 1),
                                film_create(stiff->cells, 1), NULL};
    for (int i = 0; i < 3 * CELLS * SIDE * SIDE; i++)
        picture->pixels[i] = 1.0f;
    batches_init(&batches, r, 1.0);
    for (int i = 0; i < STIFF_CHAINS; i++) {
        stiff_chain_init(&chains[i], stiff);
        stiff_start(&chains[i], stiff, 77, (uint64_t)i);
    }
    for (int span = 0; span < SPANS - 1; span++) {
        for (int i = 0; i < STIFF_CHAINS; i++)
            add_span(&chains[i], stiff, p_large, estimator, mutations, &r->lanes[0],
                     i % PARTS, &films);
        batches_take(&batches, r, span + 1.0, span + 1.0, 1);
    }
    struct evidence evidence = {.replicas = PARTS,
                                .batches = &batches,
                                .deviations = deviations,
                                .units = PARTS,
                                .fewest = PARTS};
    struct verdict v;
    verdict_find(&evidence, picture, &v);
    enum verdict_call call = v.call;
    printf("%s: %s, R-hat %.3f, effective %.0f\n", verdict_name(call), v.words,
           v.rhat_max, v.ess_min);
    verdict_deinit(&v);
    for (int i = 0; i < STIFF_CHAINS; i++)
        chain_deinit(&chains[i]);
    film_destroy(films.chain);
    film_destroy(films.large);
    batches_deinit(&batches);
    image_destroy(picture);
    replicas_destroy(r);
    return call;
}

/* Small steps do not leave the half that they began in, large ones do not hit. */
static void an_island_is_doubted(void **state)
{
    (void)state;
    assert_int_equal(judge(&stiff_island, ESTIMATOR_KELEMEN, 0.5, 200), VERDICT_NOT);
    assert_int_equal(judge(&stiff_island, ESTIMATOR_PLAIN, 0.05, 200), VERDICT_NOT);
}

/* No large step crosses over, as there is hardly one: chains stay on their plateau. */
static void plateaus_are_doubted(void **state)
{
    (void)state;
    assert_int_equal(judge(&stiff_plateaus, ESTIMATOR_PLAIN, 1e-5, 200), VERDICT_NOT);
    assert_int_equal(judge(&stiff_plateaus, ESTIMATOR_KELEMEN, 1e-5, 200), VERDICT_NOT);
}

/* The same, with large steps. */
static void mixed_chains_are_not(void **state)
{
    (void)state;
    assert_int_equal(judge(&stiff_plateaus, ESTIMATOR_KELEMEN, 0.3, 200),
                     VERDICT_CONVERGED);
    assert_int_equal(judge(&stiff_two_islands, ESTIMATOR_KELEMEN, 0.3, 200),
                     VERDICT_CONVERGED);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_island_is_doubted),
        cmocka_unit_test(plateaus_are_doubted),
        cmocka_unit_test(mixed_chains_are_not),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

#ifndef ETALON_TESTS_SUPPORT_FILM_SINKS_H
#define ETALON_TESTS_SUPPORT_FILM_SINKS_H

/* Films of one row for the splats of a chain. Not to be moved: the sinks point within. */

#include "chain/chain.h"
#include "chain/pss.h"
#include "integrator/markov/sink_set.h"

struct film_sinks {
    struct film *chain, *large, *failures;
    struct film_sink chain_sink, large_sink;
    struct map_sink map_sink;
    struct chain_sinks sinks;
};

/* Large steps have a film of the kelemen estimator; failures: whether they have one. */
static inline void film_sinks_create(struct film_sinks *f, int pixels,
                                     enum estimator estimator, bool failures)
{
    *f = (struct film_sinks){.chain = film_create(pixels, 1),
                             .large = film_create(pixels, 1)};
    f->chain_sink = film_sink_of(f->chain, 1.0);
    f->large_sink = film_sink_of(f->large, 1.0);
    splat_sinks_append(&f->sinks.states, &f->chain_sink.sink);
    if (estimator == ESTIMATOR_KELEMEN)
        splat_sinks_append(&f->sinks.large, &f->large_sink.sink);
    if (!failures)
        return;
    f->failures = film_create(pixels, 1);
    f->map_sink = map_sink_of(f->failures, NULL, NULL, false);
    f->sinks.steps = &f->map_sink.sink;
}

static inline void film_sinks_destroy(struct film_sinks *f)
{
    film_destroy(f->chain);
    film_destroy(f->large);
    film_destroy(f->failures);
}

/* A chain in primary sample space, and its numbers. */
static inline void pss_chain_init(struct chain *chain, const int capacity[PSS_STREAMS],
                                  int max_splats, const struct kernel *kernel)
{
    struct pss_options options = {.capacity = {capacity[0], capacity[1], capacity[2]},
                                  .kernel = *kernel};
    chain_init(chain, &state_pss, &options, max_splats);
}

static inline struct pss *pss_of(const struct chain *chain)
{
    return (struct pss *)chain->state;
}

#endif

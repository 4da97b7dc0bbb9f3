#ifndef ETALON_CHAIN_SPLAT_SINK_H
#define ETALON_CHAIN_SPLAT_SINK_H

/* Where the splats of a chain go: films, and all other uses. The integrator supplies the
 * sinks (integrator/markov/sink_set.h); a chain knows this interface only. */

#include "image/contrib.h"

struct splat_sink {
    /* Adds a list of splats, each times `weight`. random_bits: different for every list,
     * but independent of the thread. */
    void (*add)(const struct splat_sink *self, const struct contrib *splats,
                double weight, uint64_t random_bits);
    /* NULL, or called when the list will probably be added soon. One sink of a list may
     * have it. */
    void (*prefetch)(const struct splat_sink *self, const struct contrib *splats);
};

#define SPLAT_SINKS_MOST 6

struct splat_sinks {
    const struct splat_sink *sinks[SPLAT_SINKS_MOST];
    int count;
    const struct splat_sink *prefetch; /* the sink that has it, or NULL */
};

/* A proposal from a state of a chain, for maps of what the chain does. */
struct step_event {
    int move;
    bool first;        /* the first proposal of its mutation */
    bool failed;       /* it carries nothing */
    double acceptance; /* probability of accepting it */
    double work;       /* state_type.work, if the sink counts it, else 0 */
};

/* Receives every proposal together with the state from which it was made. */
struct step_sink {
    void (*add)(const struct step_sink *self, const struct contrib *current,
                const struct step_event *event);
    bool counts_work;
};

struct tape;

/* The sinks of a chain; all weights are without unit.
 *   states    states by their expected value, weight: factor of F (splat_weight)
 *             times the probability of being the next state. Factors apart, the weights
 *             sum to the number of mutations, less those that are no states;
 *   large     large proposals that carry something, weight: kelemen: the factor of F,
 *             plain: 1. They are independent samples. */
struct chain_sinks {
    struct splat_sinks states, large;
    const struct step_sink *steps; /* NULL, or a receiver of all proposals */
    struct tape *tape;             /* NULL, or a record of all proposals (chain/tape.h) */
};

static inline void splat_sinks_append(struct splat_sinks *list,
                                      const struct splat_sink *sink)
{
    assert(list->count < SPLAT_SINKS_MOST && !(sink->prefetch && list->prefetch));
    list->sinks[list->count++] = sink;
    if (sink->prefetch)
        list->prefetch = sink;
}

static inline void splat_sinks_add(const struct splat_sinks *list,
                                   const struct contrib *splats, double weight,
                                   uint64_t random_bits)
{
    for (int i = 0; i < list->count; i++)
        list->sinks[i]->add(list->sinks[i], splats, weight, random_bits);
}

static inline void splat_sinks_prefetch(const struct splat_sinks *list,
                                        const struct contrib *splats)
{
    if (list->prefetch)
        list->prefetch->prefetch(list->prefetch, splats);
}

#endif

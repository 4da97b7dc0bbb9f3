/* Multiplexed MLT [Hachisuka14]: a chain has one path length, and one of its numbers
 * picks the technique. */

#include "integrator/multiplex.h"

static void *create(const struct scene *scene, const struct settings *settings)
{
    return multiplex_create(scene, settings, &step_mh, false);
}

const struct integrator_type integrator_mmlt = {
    .name = "mmlt",
    .summary = "multiplexed MLT: chains of one path length, one technique at a time",
    .chains = true,
    .create = create,
    .advance = markov_advance,
    .started = markov_started,
    .picture = markov_picture,
    .statistics = markov_statistics,
    .progress = markov_progress,
    .film_bytes = markov_film_bytes,
    .pack = markov_pack,
    .evidence = markov_evidence,
    .destroy = markov_destroy,
};

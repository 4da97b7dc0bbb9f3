/* Multiplexed MLT [Hachisuka14]: a chain has one path length, and one of its numbers
 * picks the technique. */

#include "integrator/multiplex.h"

static void *create(const struct scene *scene, const struct settings *settings)
{
    struct markov_design design = multiplex_design(scene, settings, &step_mh, false);
    return markov_create(scene, settings, &design);
}

static void memory(const struct scene *scene, const struct settings *settings,
                   struct run_memory *out)
{
    struct markov_design design = multiplex_design(scene, settings, &step_mh, false);
    markov_memory(scene, settings, &design, out);
}

/* Lengths 1 and 2 may be left to pt, whose blind paths of these are bdpt's. */
static unsigned techniques(const struct settings *settings)
{
    (void)settings;
    return TECHNIQUES_BDPT;
}

const struct integrator_type integrator_mmlt = {
    .name = "mmlt",
    .summary = "multiplexed MLT: chains of one path length, one technique at a time",
    .techniques = techniques,
    .chains = true,
    .memory = memory,
    .create = create,
    .advance = markov_advance,
    .started = markov_started,
    .picture = markov_picture,
    .statistics = markov_statistics,
    .progress = markov_progress,
    .pack = markov_pack,
    .evidence = markov_evidence,
    .destroy = markov_destroy,
};

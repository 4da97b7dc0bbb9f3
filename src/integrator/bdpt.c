#include "integrator/passes.h"

static void *create(const struct scene *scene, const struct settings *settings)
{
    return passes_create(scene, settings, settings_depth(settings, scene), estimate_bdpt,
                         true);
}

static void memory(const struct scene *scene, const struct settings *settings,
                   struct run_memory *out)
{
    passes_memory(scene, settings, settings_depth(settings, scene), true, out);
}

static unsigned techniques(const struct settings *settings)
{
    (void)settings;
    return TECHNIQUES_BDPT;
}

const struct integrator_type integrator_bdpt = {
    .name = "bdpt",
    .summary = "bidirectional path tracing, all (s,t)",
    .techniques = techniques,
    .memory = memory,
    .create = create,
    .advance = passes_advance,
    .started = passes_started,
    .picture = passes_picture,
    .statistics = passes_statistics,
    .progress = passes_progress,
    .pack = passes_pack,
    .evidence = passes_evidence,
    .destroy = passes_destroy,
};

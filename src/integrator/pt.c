#include "integrator/passes.h"

static void *create(const struct scene *scene, const struct settings *settings)
{
    return passes_create(scene, settings, settings_depth(settings, scene), estimate_pt,
                         false);
}

static void memory(const struct scene *scene, const struct settings *settings,
                   struct run_memory *out)
{
    passes_memory(scene, settings, settings_depth(settings, scene), false, out);
}

static unsigned techniques(const struct settings *settings)
{
    (void)settings;
    return TECHNIQUES_PT;
}

const struct integrator_type integrator_pt = {
    .name = "pt",
    .summary = "path tracing with next-event estimation",
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

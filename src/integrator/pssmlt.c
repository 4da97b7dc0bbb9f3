/* PSSMLT [Kelemen02]: one chain state is the whole sample of bdpt (all its connections)
 * or of pt. */

#include "base/mem.h"
#include "integrator/markov.h"
#include "path/estimate.h"

#include <string.h>

static void eval_bdpt(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    estimate_bdpt(ctx, numbers, out);
}

static void eval_pt(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    estimate_pt(ctx, numbers, out);
}

static struct target target_create(const struct scene *scene,
                                   const struct settings *settings, int length)
{
    (void)length;
    struct subpaths *paths = mem_aligned(MEM_APART, 1, sizeof *paths);
    subpaths_init(paths, scene, settings_depth(settings, scene));
    bool pt = strcmp(settings->builder, "pt") == 0;
    return (struct target){pt ? eval_pt : eval_bdpt, paths};
}

static void target_destroy(struct target *target)
{
    subpaths_deinit(target->ctx);
    mem_free(target->ctx);
}

static struct markov_design design_of(const struct scene *scene,
                                      const struct settings *settings)
{
    int depth = settings_depth(settings, scene);
    return (struct markov_design){
        .step = &step_mh,
        .state = &state_pss,
        .pss.capacity = {dims_camera_capacity(depth), dims_light_capacity(depth),
                         dims_connect_capacity(depth)},
        .max_splats = estimate_splats(depth),
        .depth = depth,
        .target_create = target_create,
        .target_destroy = target_destroy,
    };
}

static void *create(const struct scene *scene, const struct settings *settings)
{
    struct markov_design design = design_of(scene, settings);
    return markov_create(scene, settings, &design);
}

static void memory(const struct scene *scene, const struct settings *settings,
                   struct run_memory *out)
{
    struct markov_design design = design_of(scene, settings);
    markov_memory(scene, settings, &design, out);
}

static unsigned techniques(const struct settings *settings)
{
    return strcmp(settings->builder, "pt") == 0 ? TECHNIQUES_PT : TECHNIQUES_BDPT;
}

const struct integrator_type integrator_pssmlt = {
    .name = "pssmlt",
    .summary = "primary sample space MLT over bdpt or pt",
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

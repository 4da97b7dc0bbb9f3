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

/* With techniques kept apart, for layers; chains move as without. */
static void eval_bdpt_layers(void *ctx, const struct numbers *numbers,
                             struct contrib *out)
{
    estimate_bdpt_layers(ctx, numbers, out);
}

static void eval_pt_layers(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    estimate_pt_layers(ctx, numbers, out);
}

static bool keeps_techniques(const struct settings *settings)
{
    return (settings->layers & (LAYER_LENGTHS | LAYER_TECHNIQUES)) != 0;
}

static bool has_roulette(const struct settings *settings)
{
    return settings->shadow_rays > 0.0 && strcmp(settings->builder, "pt") != 0;
}

static struct target target_create(const struct scene *scene,
                                   const struct settings *settings, int length)
{
    (void)length;
    struct subpaths *paths = mem_aligned(MEM_APART, 1, sizeof *paths);
    subpaths_init(paths, scene, settings_depth(settings, scene));
    bool pt = strcmp(settings->builder, "pt") == 0;
    if (has_roulette(settings))
        estimate_bdpt_roulette(paths, settings->shadow_rays);
    if (keeps_techniques(settings))
        return (struct target){pt ? eval_pt_layers : eval_bdpt_layers, paths};
    return (struct target){pt ? eval_pt : eval_bdpt, paths};
}

static void target_destroy(struct target *target)
{
    subpaths_deinit(target->ctx);
    mem_free(target->ctx);
}

struct markov_design pssmlt_design(const struct scene *scene,
                                   const struct settings *settings)
{
    int depth = settings_depth(settings, scene);
    return (struct markov_design){
        .step = &step_mh,
        .state = &state_pss,
        .pss.capacity = {dims_camera_capacity(depth), dims_light_capacity(depth),
                         dims_connect_capacity(depth)},
        .max_splats = keeps_techniques(settings) ? estimate_splats_techniques(depth)
                                                 : estimate_splats(depth),
        .depth = depth,
        .target_bytes = has_roulette(settings) ? estimate_roulette_bytes(depth) : 0.0,
        .split = settings_splits(settings),
        .guess = settings->two_stage,
        .target_create = target_create,
        .target_destroy = target_destroy,
    };
}

static unsigned techniques(const struct settings *settings)
{
    return strcmp(settings->builder, "pt") == 0 ? TECHNIQUES_PT : TECHNIQUES_BDPT;
}

const struct markov_integrator integrator_pssmlt = {
    .type = {.name = "pssmlt",
             .summary = "primary sample space MLT over bdpt or pt",
             .methods = &markov_methods,
             .techniques = techniques},
    .design = pssmlt_design,
};

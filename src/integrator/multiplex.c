#include "integrator/multiplex.h"

#include "base/mem.h"
#include "path/estimate.h"

/* Scratch of one thread and one length. */
struct multiplex {
    struct subpaths paths;
    struct techniques techniques;
};

static void eval(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    struct multiplex *multiplex = ctx;
    estimate_mmlt(&multiplex->paths, &multiplex->techniques, numbers, out);
}

static bool has_length(const struct scene *scene, int length)
{
    struct techniques techniques;
    if (length == 1 && scene->hide_emitters)
        return false;
    techniques_init(&techniques, &scene->needs, length);
    return techniques.count > 0;
}

static struct target target_create(const struct scene *scene,
                                   const struct settings *settings, int length)
{
    struct techniques techniques;
    (void)settings;
    techniques_init(&techniques, &scene->needs, length);
    struct multiplex *multiplex = mem_aligned(MEM_APART, 1, sizeof *multiplex);
    multiplex->techniques = techniques;
    subpaths_init(&multiplex->paths, scene, length);
    return (struct target){eval, multiplex};
}

static void target_destroy(struct target *target)
{
    struct multiplex *multiplex = target->ctx;
    subpaths_deinit(&multiplex->paths);
    mem_free(multiplex);
}

struct markov_design multiplex_design(const struct scene *scene,
                                      const struct settings *settings,
                                      const struct step_type *step, bool failure_map)
{
    int depth = settings_depth(settings, scene);
    /* Of smlt, passes take their share of all lengths. */
    bool direct = settings_uses(settings, "direct");
    int plain = direct ? settings_plain_lengths(settings, depth) : 0;
    return (struct markov_design){
        .step = step,
        .state = &state_pss,
        .pss.capacity = {dims_camera_capacity(depth), dims_light_capacity(depth),
                         dims_connect_capacity(depth)},
        .max_splats = 1,
        .first_length = plain + 1,
        .plain_lengths = plain,
        .last_length = depth,
        .depth = depth,
        .split = settings_splits(settings),
        .guess = settings->two_stage,
        .failure_map = failure_map,
        .has_length = has_length,
        .target_create = target_create,
        .target_destroy = target_destroy,
    };
}

#include "integrator/multiplex.h"

#include "base/mem.h"
#include "base/text.h"
#include "path/invert.h"

/* Scratch of one thread and one length. */
struct multiplex {
    struct subpaths paths;
    struct techniques techniques;
    struct inverted inverted;
};

static void eval(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    struct multiplex *multiplex = ctx;
    estimate_mmlt(&multiplex->paths, &multiplex->techniques, numbers, out);
}

static enum inversion invert(void *ctx, const struct numbers *current, struct rng *rng,
                             struct found *found, struct contrib *again)
{
    struct multiplex *multiplex = ctx;
    return invert_mmlt(&multiplex->paths, &multiplex->techniques, current, rng,
                       &multiplex->inverted, found, again);
}

static bool invertible(void *ctx)
{
    return ((const struct multiplex *)ctx)->techniques.count > 1;
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
        .pss.invert = invert,
        .pss.invertible = invertible,
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

static const struct {
    const char *mode;
    const struct step_type *step;
} modes[] = {
    {"exact", &step_pf_exact},
    {"counted", &step_mh},
    {"paper", &step_pf_paper},
};

const struct step_type *multiplex_step(const struct settings *settings)
{
    size_t i = 0;
    while (!text_equal(modes[i].mode, settings_mode(settings)))
        i++;
    return modes[i].step;
}

/* Metropolis light transport on paths [Veach97, chapter 11; CMU17]: one chain state is a
 * path. The rule for p_l and the kelemen estimator are those of primary sample space: the
 * independent mutation draws a whole path with density p, the target is f / p, so it is
 * accepted as a large step there; eta_s is the mean acceptance of all other mutations,
 * whatever they are. [Zsolnai13] assumes of small steps only that they are local. */

#include "base/mem.h"
#include "integrator/markov.h"
#include "math/warp.h"

static void eval(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    full_path_sample(ctx, numbers, out);
}

static struct target target_create(const struct scene *scene,
                                   const struct settings *settings, int length)
{
    int depth = settings_depth(settings, scene);
    struct path_space *space = mem_aligned(MEM_APART, 1, sizeof *space);
    (void)length;
    path_space_init(space, scene, settings_plain_lengths(settings, depth) + 1, depth);
    return (struct target){eval, space};
}

static void target_destroy(struct target *target)
{
    path_space_deinit(target->ctx);
    mem_free(target->ctx);
}

#define DEGREE (MATH_PI / 180.0)

static struct mlt_options options_of(const struct scene *scene, const struct settings *s,
                                     int depth)
{
    double pixels = (double)scene->camera.width * (double)scene->camera.height;
    /* r2: a disk of that share of the film [Veach97, section 11.4.3]. */
    double r2 = sqrt(s->lens_area * pixels / MATH_PI);
    return (struct mlt_options){
        .scene = scene,
        .depth = depth,
        .mutation = {.film = {fmin(s->lens_radius, r2), r2},
                     .angle = {fmin(s->angle_least, s->angle_most) * DEGREE,
                               s->angle_most * DEGREE},
                     .weighted = s->deletion == DELETION_WEIGHTED},
        .weights = {s->weight_lens, s->weight_caustic, s->weight_multichain,
                    s->weight_bidirectional},
    };
}

static struct markov_design design_of(const struct scene *scene,
                                      const struct settings *settings)
{
    int depth = settings_depth(settings, scene);
    return (struct markov_design){
        .step = &step_mh,
        .state = &state_mlt,
        .mlt = options_of(scene, settings, depth),
        .max_splats = 1,
        .plain_lengths = settings_plain_lengths(settings, depth),
        .depth = depth,
        .target_create = target_create,
        .target_destroy = target_destroy,
    };
}

/* Lengths 1 and 2 may be rendered by pt; pt cannot sample the same paths of these lengths
 * as bdpt. */
static unsigned techniques(const struct settings *settings)
{
    (void)settings;
    return TECHNIQUES_BDPT;
}

const struct markov_integrator integrator_mlt = {
    .type = {.name = "mlt",
             .summary = "Metropolis light transport on paths: perturbations of vertices, "
                        "not of random numbers",
             .methods = &markov_methods,
             .techniques = techniques},
    .design = design_of,
};

/* Metropolis light transport on paths [Veach97, chapter 11; CMU17]: one chain state is a
 * path. The rule for p_l and the kelemen estimator are those of primary sample space: the
 * independent mutation draws a whole path with density p, the target is f / p, so it is
 * accepted as a large step there; eta_s is the mean acceptance of all other mutations,
 * whatever they are. [Zsolnai13] assumes of small steps only that they are local. */

#include "base/mem.h"
#include "integrator/markov.h"
#include "math/warp.h"

#include <string.h>

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

static void given_weights(const struct settings *s, double weights[MLT_MOVES])
{
    const double given[MLT_MOVES] = {s->weight_lens,         s->weight_caustic,
                                     s->weight_multichain,   s->weight_bidirectional,
                                     s->weight_lens_subpath, s->weight_numbers};
    memcpy(weights, given, sizeof given);
}

static struct mlt_options options_of(const struct scene *scene, const struct settings *s,
                                     int depth)
{
    double pixels = (double)scene->camera.width * (double)scene->camera.height;
    /* r2: a disk of that share of the film [Veach97, section 11.4.3]. */
    double r2 = sqrt(s->lens_area * pixels / MATH_PI);
    struct mlt_options options = {
        .scene = scene,
        .depth = depth,
        .mutation = {.film = {fmin(s->lens_radius, r2), r2},
                     .angle = {fmin(s->angle_least, s->angle_most) * DEGREE,
                               s->angle_most * DEGREE},
                     .weighted = s->deletion == DELETION_WEIGHTED},
    };
    given_weights(s, options.weights);
    kernel_init(&options.kernel, &kernel_exponential, 0.0, s->s1, settings_s2(s, pixels));
    return options;
}

/* Of mutations that are measured to be worth nothing so much is left, so that no path is
 * stuck that only they suit. */
#define LEAST_WORTH 0.05

/* The given weights, times acceptance per cost over that of all mutations. The means
 * include one mutation more of the mean kind, for those that were never proposed. As all
 * mutations keep f, with whatever weights, this asks of the start only that it ends
 * before the weights change. eta_s, which the rule for p_l knows, is that of the given
 * ones. */
static void measure_weights(struct mlt_options *o, const struct tally *start)
{
    double accepted = 0.0, work = 0.0, proposed = 0.0;
    for (int i = MOVE_LOCAL; i < MOVE_LOCAL + MLT_MOVES; i++) {
        accepted += start->acceptance[i];
        work += start->work[i];
        proposed += (double)start->proposed[i];
    }
    if (!(accepted > 0.0))
        return;
    for (int i = 0; i < MLT_MOVES; i++) {
        double a = start->acceptance[MOVE_LOCAL + i] + accepted / proposed;
        double w = start->work[MOVE_LOCAL + i] + work / proposed;
        o->weights[i] *= fmax(a / w * (work / accepted), LEAST_WORTH);
    }
}

static void adapt(struct markov_design *design, const struct settings *settings,
                  const struct tally *start)
{
    if (settings->mutation_weights == WEIGHTS_GIVEN)
        return;
    given_weights(settings, design->mlt.weights);
    measure_weights(&design->mlt, start);
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
        .adapt = adapt,
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

#include "integrator/path_work.h"

#include "chain/state.h"
#include "integrator/markov.h"
#include "integrator/pass_target.h"

#define EACH  64                  /* of a length, at least */
#define FIRST ((uint64_t)1 << 40) /* number of the first, for its stream */

struct sample_work path_work_of_samples(const struct target *target, int max_splats,
                                        uint64_t seed, long count)
{
    struct contrib c;
    double sum = 0.0, weighted = 0.0, weights = 0.0;
    contrib_init(&c, max_splats);
    for (long i = 0; i < count; i++) {
        struct rng rng;
        struct ustream_counted camera, light, connect;
        long events = 0;
        rng_init(&rng, seed, RNG_GUESS, FIRST + (uint64_t)i);
        ustream_counted_init(&camera, &rng, &events);
        ustream_counted_init(&light, &rng, &events);
        ustream_counted_init(&connect, &rng, &events);
        struct numbers numbers = {&camera.stream, &light.stream, &connect.stream};
        target->eval(target->ctx, &numbers, &c);
        double work = (double)(WORK_EVENT * events + WORK_CONNECTION * c.connections);
        sum += work;
        weighted += c.target * work;
        weights += c.target;
    }
    contrib_deinit(&c);
    double all = sum / (double)count;
    return (struct sample_work){all, weights > 0.0 ? weighted / weights : all};
}

static double pass_work(const struct scene *scene, const struct settings *settings,
                        int depth, estimate_function estimate)
{
    struct target target = pass_target_create(scene, depth, estimate);
    struct sample_work work = path_work_of_samples(
        &target, estimate_splats(depth), (uint64_t)settings->seed, PATH_WORK_SAMPLES);
    pass_target_destroy(&target);
    return work.all;
}

/* Work of a mutation of the chains of one length. Small steps stay near a state. */
static double mutation_work(const struct markov_design *design, const struct scene *scene,
                            const struct settings *settings, int length, long samples)
{
    struct target target = design->target_create(scene, settings, length);
    struct sample_work work = path_work_of_samples(&target, design->max_splats,
                                                   (uint64_t)settings->seed, samples);
    design->target_destroy(&target);
    return settings->p_large * work.all + (1.0 - settings->p_large) * work.states;
}

/* Chains of a length; without statistics all lengths have the same number. */
static double chains_of(const struct run_statistics *s, int length)
{
    for (int i = 0; s && i < s->length_count; i++)
        if (s->lengths[i].length == length)
            return s->lengths[i].chains;
    return s && s->length_count > 0 ? 0.0 : 1.0;
}

static double chains_work(const struct markov_design *design, const struct scene *scene,
                          const struct settings *settings, const struct run_statistics *s)
{
    double sum = 0.0, all = 0.0;
    int lengths = design->last_length - design->first_length + 1;
    long each = PATH_WORK_SAMPLES / lengths > EACH ? PATH_WORK_SAMPLES / lengths : EACH;
    for (int k = design->first_length; k <= design->last_length; k++) {
        double chains = chains_of(s, k);
        if (!(chains > 0.0) || (design->has_length && !design->has_length(scene, k)))
            continue;
        sum += chains * mutation_work(design, scene, settings, k, each);
        all += chains;
    }
    return all > 0.0 ? sum / all : 0.0;
}

double path_work(const struct integrator_type *type, const struct scene *scene,
                 const struct settings *settings, const struct run_statistics *s)
{
    int depth = settings_depth(settings, scene);
    if (!type->methods->chains)
        return pass_work(scene, settings, depth,
                         ((const struct passes_integrator *)type)->estimate);
    struct markov_design design =
        ((const struct markov_integrator *)type)->design(scene, settings);
    double work = chains_work(&design, scene, settings, s);
    if (!(s && s->plain_samples > 0.0))
        return work;
    double plain = s->plain_samples / s->paths;
    return (1.0 - plain) * work +
           plain * pass_work(scene, settings, s->plain_lengths, estimate_pt);
}

#include "integrator/race_moments.h"

#include "integrator/pass_target.h"
#include "path/estimate.h"

#define FIRST       ((uint64_t)1 << 41) /* number of the first sample, for its stream */
#define WEIGHT_MOST (1.0 - 1e-9)

struct moments {
    double bdpt, pt;
};

static void sample(const struct target *target, uint64_t seed, uint64_t number,
                   struct contrib *out)
{
    struct rng rng;
    struct ustream_random camera, light, connect;
    rng_init(&rng, seed, RNG_GUESS, number);
    ustream_random_init(&camera, &rng);
    ustream_random_init(&light, &rng);
    ustream_random_init(&connect, &rng);
    target->eval(target->ctx,
                 &(struct numbers){&camera.stream, &light.stream, &connect.stream}, out);
}

static void add(const struct contrib *c, const float *scale, struct moments *sum)
{
    for (int i = 0; i < c->count; i++) {
        const struct splat *splat = &c->splats[i];
        double v = rgb_luminance(splat->value) * (double)scale[splat->pixel];
        double most = splat->s >= 2 ? 1.0 - fmin(c->weights[i], WEIGHT_MOST) : 1.0;
        sum->bdpt += v * v;
        sum->pt += v * v / most;
    }
}

double race_moments(const struct scene *scene, int depth, uint64_t seed, long count,
                    const float *scale)
{
    struct target target = pass_target_create(scene, depth, estimate_bdpt_techniques);
    struct moments sum = {0.0, 0.0};
    struct contrib c;
    contrib_init(&c, estimate_splats_techniques(depth));
    contrib_keep_weights(&c);
    for (long i = 0; i < count; i++) {
        sample(&target, seed, FIRST + (uint64_t)i, &c);
        add(&c, scale, &sum);
    }
    contrib_deinit(&c);
    pass_target_destroy(&target);
    return sum.bdpt > 0.0 ? sum.pt / sum.bdpt : 1.0;
}

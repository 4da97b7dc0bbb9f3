#include "chain/bootstrap.h"

#include "base/mem.h"
#include "base/pack.h"
#include "base/par.h"
#include "math/accum.h"
#include "math/rng.h"

#include <limits.h>
#include <math.h>

/* Paths that a thread evaluates per index of the parallel loop; any size gives the same
 * bits. */
#define BLOCK 16

struct bootstrap_job {
    struct bootstrap *bootstrap;
    long begin, first; /* place and number of the first path */
    uint64_t seed;
    const struct target *targets_by_thread;
    struct contrib *contribs; /* [threads] */
};

static double evaluate_path(const struct target *target, uint64_t seed, long index,
                            struct contrib *out)
{
    struct rng rng;
    struct ustream_random camera, light, connect;
    rng_init(&rng, seed, RNG_BOOTSTRAP, (uint64_t)index);
    ustream_random_init(&camera, &rng);
    ustream_random_init(&light, &rng);
    ustream_random_init(&connect, &rng);
    struct numbers numbers = {&camera.stream, &light.stream, &connect.stream};
    target->eval(target->ctx, &numbers, out);
    if (out->target >= 0.0 && out->target < HUGE_VAL)
        return out->target;
    out->nonfinite++;
    return 0.0;
}

static void evaluate_block(void *ctx, long block, int thread)
{
    const struct bootstrap_job *job = ctx;
    long begin = job->begin + block * BLOCK, end = begin + BLOCK;
    if (end > job->bootstrap->count)
        end = job->bootstrap->count;
    struct contrib *contrib = &job->contribs[thread];
    for (long i = begin; i < end; i++) {
        job->bootstrap->targets[i] = evaluate_path(&job->targets_by_thread[thread],
                                                   job->seed, job->first + i - job->begin,
                                                   contrib);
        job->bootstrap->pixels[i] = contrib->count > 0 ? contrib->splats[0].pixel : -1;
    }
}

void bootstrap_summarize(struct bootstrap *bootstrap, long planned)
{
    struct welford value = {0}, nonzero = {0};
    double sum = 0.0, squares = 0.0;
    for (long i = 0; i < bootstrap->count; i++) {
        double f = bootstrap->targets[i];
        if (i < planned) {
            welford_add(&value, f);
            welford_add(&nonzero, f > 0.0 ? 1.0 : 0.0);
        }
        sum += f;
        squares += f * f;
    }
    bootstrap->b = value.mean;
    bootstrap->b_se = welford_se(&value);
    bootstrap->eta_0 = nonzero.mean;
    bootstrap->eta_0_se = welford_se(&nonzero);
    /* [Kong92] */
    bootstrap->effective = squares > 0.0 ? sum * sum / squares : 0.0;
}

void bootstrap_extend(struct bootstrap *bootstrap, long first, long count, uint64_t seed,
                      int max_splats, const struct target *targets_by_thread, int threads)
{
    long begin = bootstrap->count;
    size_t all = (size_t)(begin + count);
    bootstrap->count += count;
    bootstrap->targets = mem_resize(bootstrap->targets, all, sizeof *bootstrap->targets);
    bootstrap->pixels = mem_resize(bootstrap->pixels, all, sizeof *bootstrap->pixels);
    struct contrib *contribs = mem_alloc((size_t)threads, sizeof *contribs);
    for (int i = 0; i < threads; i++)
        contrib_init(&contribs[i], max_splats);

    struct bootstrap_job job = {bootstrap,         begin,   first, seed,
                                targets_by_thread, contribs};
    par_for((count + BLOCK - 1) / BLOCK, threads, evaluate_block, &job);

    for (int i = 0; i < threads; i++) {
        bootstrap->nonfinite += contribs[i].nonfinite;
        contrib_deinit(&contribs[i]);
    }
    mem_free(contribs);
}

void bootstrap_run(struct bootstrap *bootstrap, long first, long count, uint64_t seed,
                   int max_splats, const struct target *targets_by_thread, int threads)
{
    *bootstrap = (struct bootstrap){0};
    bootstrap_extend(bootstrap, first, count, seed, max_splats, targets_by_thread,
                     threads);
    bootstrap_summarize(bootstrap, count);
}

void bootstrap_deinit(struct bootstrap *bootstrap)
{
    mem_free(bootstrap->targets);
    mem_free(bootstrap->pixels);
    bootstrap->targets = NULL;
    bootstrap->pixels = NULL;
}

void bootstrap_select(const struct bootstrap *bootstrap, double u, long *seeds,
                      int chains)
{
    double total = 0.0;
    long last = -1; /* the last path with a positive target */
    for (long i = 0; i < bootstrap->count; i++) {
        total += bootstrap->targets[i];
        if (bootstrap->targets[i] > 0.0)
            last = i;
    }
    long index = 0;
    double below = 0.0; /* sum of the targets before `index`, in the same order of
                           additions as `total` */
    for (int j = 0; j < chains; j++) {
        if (last < 0) {
            seeds[j] = (long)((double)bootstrap->count * j / chains);
            continue;
        }
        double position = ((double)j + u) / chains * total;
        while (index < last && below + bootstrap->targets[index] <= position)
            below += bootstrap->targets[index++];
        seeds[j] = index;
    }
}

void bootstrap_pack(struct pack *pack, struct bootstrap *bootstrap)
{
    pack_long(pack, "count", &bootstrap->count, 0, LONG_MAX);
    pack_double(pack, "b", &bootstrap->b);
    pack_double(pack, "b_se", &bootstrap->b_se);
    pack_double(pack, "eta_0", &bootstrap->eta_0);
    pack_double(pack, "eta_0_se", &bootstrap->eta_0_se);
    pack_double(pack, "effective", &bootstrap->effective);
    pack_long(pack, "nonfinite", &bootstrap->nonfinite, 0, LONG_MAX);
}

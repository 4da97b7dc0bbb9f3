#include "chain/startup.h"

#include "base/mem.h"
#include "base/pack.h"
#include "base/par.h"
#include "math/accum.h"

#include <limits.h>
#include <math.h>

/* ---- bootstrap ---- */

/* Paths evaluated between two looks at the loop counter; any size gives the same bits. */
#define BLOCK 256

struct bootstrap_job {
    struct bootstrap *bootstrap;
    long first;
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
    long end = (block + 1) * BLOCK;
    if (end > job->bootstrap->count)
        end = job->bootstrap->count;
    struct contrib *contrib = &job->contribs[thread];
    for (long i = block * BLOCK; i < end; i++) {
        job->bootstrap->targets[i] = evaluate_path(&job->targets_by_thread[thread],
                                                   job->seed, job->first + i, contrib);
        job->bootstrap->pixels[i] = contrib->count > 0 ? contrib->splats[0].pixel : -1;
    }
}

static void summarize(struct bootstrap *bootstrap)
{
    struct welford value = {0}, nonzero = {0};
    for (long i = 0; i < bootstrap->count; i++) {
        welford_add(&value, bootstrap->targets[i]);
        welford_add(&nonzero, bootstrap->targets[i] > 0.0 ? 1.0 : 0.0);
    }
    bootstrap->b = value.mean;
    bootstrap->b_se = welford_se(&value);
    bootstrap->eta_0 = nonzero.mean;
    bootstrap->eta_0_se = welford_se(&nonzero);
}

void bootstrap_run(struct bootstrap *bootstrap, long first, long count, uint64_t seed,
                   int max_splats, const struct target *targets_by_thread, int threads)
{
    *bootstrap = (struct bootstrap){.count = count};
    bootstrap->targets = mem_alloc((size_t)count, sizeof *bootstrap->targets);
    bootstrap->pixels = mem_alloc((size_t)count, sizeof *bootstrap->pixels);
    struct contrib *contribs = mem_alloc((size_t)threads, sizeof *contribs);
    for (int i = 0; i < threads; i++)
        contrib_init(&contribs[i], max_splats);

    struct bootstrap_job job = {bootstrap, first, seed, targets_by_thread, contribs};
    par_for((count + BLOCK - 1) / BLOCK, threads, evaluate_block, &job);

    for (int i = 0; i < threads; i++) {
        bootstrap->nonfinite += contribs[i].nonfinite;
        contrib_deinit(&contribs[i]);
    }
    mem_free(contribs);
    summarize(bootstrap);
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
    long last = -1; /* the last path that may be picked */
    for (long i = 0; i < bootstrap->count; i++) {
        total += bootstrap->targets[i];
        if (bootstrap->targets[i] > 0.0)
            last = i;
    }
    long index = 0;
    double below = 0.0; /* sum before `index`, rounded exactly as the total was */
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

/* ---- statistics ---- */

/* Quantile .995 of Student's t: tabulated while Fisher's expansion about the normal one
 * [AbramowitzStegun 26.7.5] is not yet good to 1e-4. */
static double quantile_995(int freedom)
{
    static const double small[] = {63.65674, 9.92484, 5.84091, 4.60409, 4.03214,
                                   3.70743,  3.49948, 3.35539, 3.24984};
    const int tabulated = (int)(sizeof small / sizeof *small);
    if (freedom <= tabulated)
        return small[freedom - 1];
    const double z = 2.5758293035489004, z2 = z * z, n = freedom;
    double g1 = (z2 + 1.0) * z / 4.0;
    double g2 = ((5.0 * z2 + 16.0) * z2 + 3.0) * z / 96.0;
    double g3 = (((3.0 * z2 + 19.0) * z2 + 17.0) * z2 - 15.0) * z / 384.0;
    double g4 = ((((79.0 * z2 + 776.0) * z2 + 1482.0) * z2 - 1920.0) * z2 - 945.0) * z /
                92160.0;
    return z + (g1 + (g2 + (g3 + g4 / n) / n) / n) / n;
}

/* sum(value)/sum(count) over chains. */
struct ratio {
    double (*value)(const struct tally *t);
    double (*count)(const struct tally *t);
    double estimate, total;
};

static double small_acceptance(const struct tally *t)
{
    return tally_local_acceptance(t);
}

static double large_acceptance(const struct tally *t)
{
    return t->acceptance[MOVE_LARGE];
}

static double small_count(const struct tally *t)
{
    return (double)tally_local(t->proposed);
}

static double large_count(const struct tally *t)
{
    return (double)t->proposed[MOVE_LARGE];
}

static double small_nonzero(const struct tally *t)
{
    return (double)tally_local(t->nonzero);
}

static double large_nonzero(const struct tally *t)
{
    return (double)t->nonzero[MOVE_LARGE];
}

static struct ratio measure(double (*value)(const struct tally *),
                            double (*count)(const struct tally *),
                            const struct tally *tallies, int chains)
{
    struct ratio r = {value, count, 0.0, 0.0};
    double sum = 0.0;
    for (int i = 0; i < chains; i++) {
        sum += value(&tallies[i]);
        r.total += count(&tallies[i]);
    }
    r.estimate = r.total > 0.0 ? sum / r.total : 0.0;
    return r;
}

static double residual(const struct ratio *r, const struct tally *t)
{
    return r->value(t) - r->estimate * r->count(t);
}

/* Delta method: the residuals value - ratio * count have mean 0 over chains, and the
 * error of a ratio is their sum over the total count. */
static double covariance(const struct ratio *a, const struct ratio *b,
                         const struct tally *tallies, int chains)
{
    if (chains < 2 || !(a->total > 0.0) || !(b->total > 0.0))
        return HUGE_VAL;
    double sum = 0.0;
    for (int i = 0; i < chains; i++)
        sum += residual(a, &tallies[i]) * residual(b, &tallies[i]);
    return sum * chains / (chains - 1) / (a->total * b->total);
}

static void set_interval(struct statistics *s)
{
    s->quantile = quantile_995((int)s->freedom);
    s->r_lo = fmax(0.0, s->r - s->quantile * s->r_se);
    s->r_hi = fmin(1.0, s->r + s->quantile * s->r_se);
}

void statistics_measure(const struct tally *tallies, int chains, struct statistics *out)
{
    struct ratio s = measure(small_acceptance, small_count, tallies, chains);
    struct ratio l = measure(large_acceptance, large_count, tallies, chains);
    struct ratio z = measure(large_nonzero, large_count, tallies, chains);
    struct ratio r = measure(large_acceptance, large_nonzero, tallies, chains);
    *out = (struct statistics){
        .eta_s = s.estimate,
        .eta_s_se = sqrt(covariance(&s, &s, tallies, chains)),
        .eta_l = l.estimate,
        .eta_l_se = sqrt(covariance(&l, &l, tallies, chains)),
        .eta_0 = z.estimate,
        .eta_0_se = sqrt(covariance(&z, &z, tallies, chains)),
        .z_small = measure(small_nonzero, small_count, tallies, chains).estimate,
        .eta_sl_cov = covariance(&s, &l, tallies, chains),
        .eta_l0_cov = covariance(&l, &z, tallies, chains),
        .freedom = chains > 1 ? chains - 1 : 1,
        .r = r.estimate,
        .r_se = sqrt(covariance(&r, &r, tallies, chains)),
        .small = (int64_t)s.total,
        .large = (int64_t)l.total,
    };
    set_interval(out);
}

/* Variance of the part's share in the error of r = eta_l/eta_0, by the delta method. */
static double ratio_variance(const struct statistics *part, double r, double eta_0)
{
    double l = part->eta_l_se, z = part->eta_0_se;
    return (l * l - 2.0 * r * part->eta_l0_cov + r * r * z * z) / (eta_0 * eta_0);
}

/* Sums of weighted estimates and of variances with squared weights, of which
 * standard errors are then the roots. */
static void add_part(struct statistics *sum, const struct statistics *part, double w)
{
    sum->small += part->small;
    sum->large += part->large;
    if (!(w > 0.0))
        return;
    sum->eta_s += w * part->eta_s;
    sum->eta_l += w * part->eta_l;
    sum->eta_0 += w * part->eta_0;
    sum->z_small += w * part->z_small;
    sum->eta_s_se += w * w * part->eta_s_se * part->eta_s_se;
    sum->eta_l_se += w * w * part->eta_l_se * part->eta_l_se;
    sum->eta_0_se += w * w * part->eta_0_se * part->eta_0_se;
    sum->eta_sl_cov += w * w * part->eta_sl_cov;
    sum->eta_l0_cov += w * w * part->eta_l0_cov;
}

static void join_ratio(struct statistics *sum, const struct statistics *parts,
                       const double *weights, int count, double total)
{
    double variance = 0.0, squares = 0.0;
    sum->freedom = 1.0;
    sum->r_se = HUGE_VAL;
    if (!(sum->eta_0 > 0.0))
        return;
    sum->r = sum->eta_l / sum->eta_0;
    for (int i = 0; i < count; i++) {
        double w = weights[i] / total;
        double own = w > 0.0 ? w * w * ratio_variance(&parts[i], sum->r, sum->eta_0)
                             : 0.0;
        variance += own;
        squares += own * own / parts[i].freedom;
    }
    if (!(variance < HUGE_VAL))
        return;
    sum->r_se = sqrt(fmax(variance, 0.0));
    if (squares > 0.0)
        sum->freedom = fmax(variance * variance / squares, 1.0);
}

void statistics_join(const struct statistics *parts, const double *weights, int count,
                     struct statistics *out)
{
    struct statistics sum = {0};
    double total = 0.0;
    if (count == 1) {
        *out = parts[0];
        return;
    }
    for (int i = 0; i < count; i++)
        total += weights[i];
    for (int i = 0; i < count; i++)
        add_part(&sum, &parts[i], weights[i] / total);
    if (!(total > 0.0))
        sum.eta_s_se = sum.eta_l_se = sum.eta_0_se = HUGE_VAL;
    sum.eta_s_se = sqrt(sum.eta_s_se);
    sum.eta_l_se = sqrt(sum.eta_l_se);
    sum.eta_0_se = sqrt(sum.eta_0_se);
    join_ratio(&sum, parts, weights, count, total);
    set_interval(&sum);
    *out = sum;
}

/* ---- checkpoints ---- */

void bootstrap_pack(struct pack *pack, struct bootstrap *bootstrap)
{
    pack_long(pack, "count", &bootstrap->count, 0, LONG_MAX);
    pack_double(pack, "b", &bootstrap->b);
    pack_double(pack, "b_se", &bootstrap->b_se);
    pack_double(pack, "eta_0", &bootstrap->eta_0);
    pack_double(pack, "eta_0_se", &bootstrap->eta_0_se);
    pack_long(pack, "nonfinite", &bootstrap->nonfinite, 0, LONG_MAX);
}

void statistics_pack(struct pack *pack, struct statistics *s)
{
    struct {
        const char *name;
        double *value;
    } figures[] = {
        {"eta_s", &s->eta_s},
        {"eta_s_se", &s->eta_s_se},
        {"eta_l", &s->eta_l},
        {"eta_l_se", &s->eta_l_se},
        {"eta_0", &s->eta_0},
        {"eta_0_se", &s->eta_0_se},
        {"z_small", &s->z_small},
        {"eta_sl_cov", &s->eta_sl_cov},
        {"eta_l0_cov", &s->eta_l0_cov},
        {"freedom", &s->freedom},
        {"r", &s->r},
        {"r_se", &s->r_se},
        {"r_lo", &s->r_lo},
        {"r_hi", &s->r_hi},
        {"quantile", &s->quantile},
    };
    for (size_t i = 0; i < sizeof figures / sizeof *figures; i++)
        pack_double(pack, figures[i].name, figures[i].value);
    pack_int64s(pack, "small", &s->small, 1);
    pack_int64s(pack, "large", &s->large, 1);
}

/* Predicts the error that passes and chains would have for any split, and takes the
 * least.
 *
 * Let r(u) = sum over splats of luminance / sqrt(I_j^2 + e^2), and relMSE the mean over N
 * pixels of the variance of pixel j over I_j^2 + e^2. Of n samples that are independent
 * and have one splat each, a part h(u) F(u) has relMSE N E[(h r)^2] / n; passes are
 * stratified by pixel and have N (E[(h r)^2] - mean^2) / n, with the square of the mean
 * over pixels for the mean over pixels of squares. The pilot has independent samples, so
 * V_p = E[((1-s) r)^2] - E[(1-s) r]^2 is known for every c and W.
 *
 * Of chains with target T = r s and large steps with probability p, let a(x) = E_u min(1,
 * T(u)/T(x)) be the acceptance of large steps. Large steps that are accepted begin tours
 * (chain/tours.c). From a state x_0 of the stationary density T/b follow the small steps
 * x_0, x_1, ...: the chain at p leaves x_i with probability e_i = 1 - p (1 - a_i) a
 * mutation, 1/e_i mutations after it came, and then by a small step with probability c_i
 * = (1-p)/e_i. With y(x) = b T/(T + p b), what a state and what a large step adds
 * (kelemen, estimator.h), and k(x,x') the sum over pixels of the product of the two
 * states' shares of relative brightness,
 *
 *     V_c = E[2 (1 + p a_0) y_0 sum over i of (c_0 ... c_{i-1} / e_i) y_i k_0i
 *             - y_0^2 k_00] + p E_u[y^2],
 *
 * up to terms with the means of pixels, 1/N of these. The trajectories come from probes:
 * chains of small steps alone whose target is r; a start x_0 has the weight T/r of the
 * density that is asked for. That their small steps are accepted by r rather than by T is
 * an approximation; T is the flatter of the two, so V_c is too large. Where a trajectory
 * ends, the rest of its tour is taken to stay where it is, but not for longer than a
 * chain will be: V_c is too large again, against chains when in doubt.
 *
 * A mutation costs k_c and a pass k_p, in the unit of WORK_EVENT. With a share q of
 * passes in all paths, error times cost is
 *
 *     J = (V_p / q + V_c / (1 - q)) (q k_p + (1 - q) k_c),
 *
 * least for q : 1 - q = sqrt(V_p/k_p) : sqrt(V_c/k_c). Chains of several lengths have V_c
 * = (sum over lengths of sqrt(V_k))^2 with numbers in proportion to sqrt(V_k) (Neyman
 * allocation). c and W are taken from a grid; W at most such that a chain is not expected
 * to stay for more than a third of its length (STAY) at any state. */

#include "integrator/markov/split_plan.h"

#include "base/mem.h"
#include "integrator/markov/markov_group.h"
#include "integrator/markov/pilot.h"
#include "integrator/markov/split_probe.h"

#include <stdio.h>
#include <string.h>

#define STAY        (1.0 / 3.0) /* of a chain's length */
#define SURVIVAL    1e-3        /* a tour's rest of less probability is left out */
#define PASSES_MOST 0.98
#define EASY        1.03 /* passes alone if their error times cost is within this */

static const double floors[] = {0.0, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0};
static const double ceilings[] = {1.0, 0.3, 0.1}; /* of the greatest */
#define FLOORS   ((int)(sizeof floors / sizeof *floors))
#define CEILINGS ((int)(sizeof ceilings / sizeof *ceilings))

struct plan {
    const struct markov *m;
    const struct pilot *pilot;
    double planned;
    struct split_probes probes;
    struct large_acceptance *acceptance; /* [group_count], of the candidate */
    double *targets;                     /* scratch, of one group's paths */
};

/* --- the variance of chains ------------------------------------------------------- */

/* What a candidate's chains of one length do. */
struct outlook {
    double b;      /* E[T], T = r s */
    double square; /* E_u[y^2] */
    double eta[3]; /* s, l, 0 */
    double p_large, variance;
};

static void sum_targets(struct plan *plan, const struct split *split, int group,
                        struct outlook *o)
{
    const struct bootstrap *paths = &plan->m->groups[group].bootstrap;
    long count = paths->count;
    double sum = 0.0, nonzero = 0.0;
    for (long i = 0; i < count; i++) {
        double rho = paths->targets[i] / split->unit;
        plan->targets[i] = rho > 0.0 ? rho * split_share(split, rho) : 0.0;
        sum += plan->targets[i];
        nonzero += plan->targets[i] > 0.0;
    }
    o->b = sum / (double)count;
    o->eta[2] = nonzero / (double)count;
    large_acceptance_build(&plan->acceptance[group], plan->targets, count);
}

static double acceptance_of(const struct plan *plan, int group, double target)
{
    double mean, square;
    large_acceptance_at(&plan->acceptance[group], target, &mean, &square);
    return fmax(mean, 1e-12);
}

/* eta_s, eta_l of the density T/b; the p_l that the published rule would give. */
static void find_plarge(const struct plan *plan, const struct split *split, int group,
                        struct outlook *o)
{
    double weights = 0.0;
    for (int i = 0; i < plan->probes.count; i++) {
        const struct split_probe *probe = &plan->probes.all[i];
        double s = split_share(split, probe->rho[0]);
        if (probe->group != group || !(probe->rho[0] > 0.0))
            continue;
        weights += s;
        o->eta[0] += s * probe->accepted;
        o->eta[1] += s * acceptance_of(plan, group, probe->rho[0] * s);
    }
    for (int k = 0; k < 2 && weights > 0.0; k++)
        o->eta[k] /= weights;
    o->p_large = settings_auto(plan->m->settings)
                     ? plarge_of_rates(o->eta[0], o->eta[1], o->eta[2])
                     : plan->m->settings->p_large;
}

/* The expectation over starts of one probe: its sum of weights times values, and of
 * weights. */
static void add_probe(const struct plan *plan, const struct split *split,
                      const struct split_probe *probe, const struct outlook *o,
                      double longest, double *sum, double *weights)
{
    double y[PROBE_STEPS + 1], a[PROBE_STEPS + 1], stay[PROBE_STEPS + 1], p = o->p_large;
    int n = probe->states;
    for (int i = 0; i < n; i++) {
        double target = probe->rho[i] * split_share(split, probe->rho[i]);
        a[i] = acceptance_of(plan, probe->group, target);
        y[i] = o->b * target / (target + p * o->b);
        stay[i] = 1.0 / (1.0 - p * (1.0 - a[i]));
    }
    for (int i = 0; i < (n + 1) / 2; i++) {
        double survive = 1.0, tour = 0.0, s = split_share(split, probe->rho[i]);
        int k = i;
        for (; k < n && survive > SURVIVAL; k++) {
            tour += survive * stay[k] * y[k] * (double)probe->same[i][k];
            survive *= (1.0 - p) * stay[k];
        }
        if (k == n)
            tour += survive * y[n - 1] * (double)probe->same[i][n - 1] *
                    fmin(1.0 / (p * a[n - 1]), longest);
        /* NOLINTNEXTLINE(clang-analyzer-core.*): i < n */
        *sum += s * (2.0 * (1.0 + p * a[i]) * y[i] * tour -
                     y[i] * y[i] * (double)probe->same[i][i]);
        *weights += s;
    }
}

/* longest: mutations of a chain. */
static void find_outlook(struct plan *plan, const struct split *split, int group,
                         double longest, struct outlook *o)
{
    double sum = 0.0, weights = 0.0, same = 0.0, probes = 0.0;
    *o = (struct outlook){.p_large = 0.5};
    if (!(plan->m->groups[group].bootstrap.b > 0.0))
        return;
    sum_targets(plan, split, group, o);
    find_plarge(plan, split, group, o);
    for (int i = 0; i < plan->probes.count; i++)
        if (plan->probes.all[i].group == group && plan->probes.all[i].rho[0] > 0.0) {
            add_probe(plan, split, &plan->probes.all[i], o, longest, &sum, &weights);
            same += (double)plan->probes.all[i].same[0][0];
            probes++;
        }
    long count = plan->m->groups[group].bootstrap.count;
    for (long i = 0; i < count; i++) {
        double t = plan->targets[i], y = o->b * t / (t + o->p_large * o->b);
        o->square += t > 0.0 ? y * y / (double)count : 0.0;
    }
    if (weights > 0.0)
        o->variance = sum / weights + o->p_large * o->square * same / probes;
}

/* --- candidates ------------------------------------------------------------------- */

/* A split with its predicted error. */
struct candidate {
    double floor, ceiling, passes, p_large;
    double product; /* J */
    double error;   /* V_p / q + V_c / (1 - q): relMSE over pixels per path */
};

struct costs {
    double pass, small, large;
};

static struct costs find_costs(const struct plan *plan)
{
    double work = 0.0;
    for (int i = 0; i < plan->probes.count; i++)
        work += plan->probes.all[i].work / plan->probes.count;
    double pass = plan->pilot->work / fmax((double)plan->pilot->count, 1.0);
    /* A large step of whole samples is a sample of the passes. */
    bool whole = !plan->m->split->split.by_technique;
    return (struct costs){.pass = pass, .small = work, .large = whole ? pass : work};
}

/* Fills in error and cost of a candidate with its floor and ceiling set. passes: the
 * share, or NAN for the best. */
static void judge(struct plan *plan, const struct costs *costs, double passes,
                  struct candidate *c)
{
    const struct markov *m = plan->m;
    struct split split = m->split->split;
    double root = 0.0, brightness = 0.0, least, mean_p = 0.0;
    split.floor = c->floor;
    split.ceiling = c->ceiling;
    double longest = fmax(0.5 * plan->planned / m->chain_count, 1.0);
    for (int g = 0; g < m->group_count; g++) {
        struct outlook o;
        find_outlook(plan, &split, g, longest, &o);
        root += sqrt(fmax(o.variance, 0.0));
        brightness += o.b;
        mean_p += o.b * o.p_large;
    }
    c->p_large = brightness > 0.0 ? mean_p / brightness : 0.5;
    struct pilot_rest rest = pilot_rest(plan->pilot, &split);
    double v_p = m->design.passes.estimate
                     ? fmax(rest.square - rest.mean * rest.mean, 0.0)
                     : 0.0;
    double v_c = root * root;
    double k_c = c->p_large * costs->large + (1.0 - c->p_large) * costs->small;
    least = fmin(2.0 * markov_pixels(m) / plan->planned, 0.5);
    double a = sqrt(v_p / costs->pass), b = sqrt(v_c / k_c);
    c->passes = !isnan(passes) ? passes : a + b > 0.0 ? a / (a + b) : 0.5;
    if (isnan(passes))
        c->passes = fmin(fmax(c->passes, least), PASSES_MOST);
    double q = fmin(fmax(c->passes, least), PASSES_MOST);
    c->error = v_p / q + v_c / (1.0 - q);
    c->product = c->error * (q * costs->pass + (1.0 - q) * k_c);
}

/* The greatest ceiling, see above. */
static double greatest_ceiling(struct plan *plan, double floor)
{
    const struct markov *m = plan->m;
    struct split split = m->split->split;
    double stay = 0.0;
    split.floor = floor;
    split.ceiling = (double)INFINITY;
    for (int g = 0; g < m->group_count; g++) {
        struct outlook o = {.b = 0.0};
        if (!(m->groups[g].bootstrap.b > 0.0))
            continue;
        sum_targets(plan, &split, g, &o);
        find_plarge(plan, &split, g, &o);
        stay = fmax(stay, o.b * o.p_large);
    }
    double length = fmax(0.5 * plan->planned / m->chain_count, 1.0);
    return fmax(STAY * stay * length, 1.0);
}

/* Tries the ceilings at one floor. */
static void try_floor(struct plan *plan, const struct costs *costs, double floor,
                      struct candidate *best)
{
    const struct settings *s = plan->m->settings;
    double given = settings_ceiling(s), most = 1.0;
    double passes = plan->m->design.passes.estimate ? s->passes_share : 0.0;
    bool automatic = isnan(given);
    if (automatic)
        most = greatest_ceiling(plan, floor);
    for (int i = 0; i < (automatic ? CEILINGS : 1); i++) {
        struct candidate c = {.floor = floor,
                              .ceiling = automatic ? most * ceilings[i] : given};
        judge(plan, costs, passes, &c);
        if (!(best->product <= c.product))
            *best = c;
    }
}

/* --- the choice ------------------------------------------------------------------- */

static void explain(struct split_plan *out, bool passes_only, double easy)
{
    if (passes_only && out->chains_alone >= 1.0)
        snprintf(out->reason, sizeof out->reason,
                 "independent samples alone: chains alone would have %.3g times their "
                 "error, and a mix of both %.3g times, at equal cost",
                 out->chains_alone, easy);
    else if (passes_only)
        snprintf(out->reason, sizeof out->reason, "independent samples alone");
    else
        snprintf(out->reason, sizeof out->reason,
                 "independent samples %.0f %% of all paths; at equal cost they alone "
                 "would have %.3g times the error, chains alone %.3g times",
                 100.0 * out->passes, out->passes_alone, out->chains_alone);
}

static void choose(struct plan *plan, struct split_plan *out)
{
    const struct markov *m = plan->m;
    const struct settings *s = m->settings;
    struct costs costs = find_costs(plan);
    struct candidate best = {.product = (double)NAN};
    struct candidate chains = {.floor = 0.0, .ceiling = (double)INFINITY};
    bool smlt = m->design.passes.estimate != NULL;
    struct split none = m->split->split;
    none.floor = (double)INFINITY;
    struct pilot_rest all = pilot_rest(plan->pilot, &none);
    double alone = costs.pass * (all.square - all.mean * all.mean);
    if (smlt && isnan(s->share_floor))
        for (int i = 0; i < FLOORS; i++)
            try_floor(plan, &costs, floors[i], &best);
    else
        try_floor(plan, &costs, smlt ? s->share_floor : 0.0, &best);
    judge(plan, &costs, 0.0, &chains);
    bool free = smlt && isnan(s->share_floor) && isnan(s->passes_share);
    bool passes_only = free && alone <= EASY * best.product;
    double chosen = passes_only ? alone : best.product;
    *out = (struct split_plan){
        .floor = passes_only ? (double)INFINITY : best.floor,
        .ceiling = passes_only ? (double)INFINITY : best.ceiling,
        .passes = passes_only ? 1.0 : best.passes,
        .p_large = best.p_large,
        .relmse = markov_pixels(m) / plan->planned *
                  (passes_only ? all.square - all.mean * all.mean : best.error),
        .passes_alone = smlt ? sqrt(alone / chosen) : (double)NAN,
        .chains_alone = sqrt(chains.product / chosen),
    };
    explain(out, passes_only, sqrt(best.product / chosen));
}

void split_plan_find(const struct markov *m, const struct pilot *pilot, double planned,
                     struct split_plan *out)
{
    struct plan plan = {.m = m, .pilot = pilot, .planned = planned};
    long most = 0;
    for (int g = 0; g < m->group_count; g++)
        if (m->groups[g].bootstrap.count > most)
            most = m->groups[g].bootstrap.count;
    plan.acceptance = mem_alloc((size_t)m->group_count, sizeof *plan.acceptance);
    plan.targets = mem_alloc((size_t)most, sizeof *plan.targets);
    split_probes_run(m, &plan.probes);
    choose(&plan, out);
    mem_free(plan.probes.all);
    mem_free(plan.acceptance);
    mem_free(plan.targets);
}

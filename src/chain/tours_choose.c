/* The minimum of the predicted curve, its interval, and the conditions under which it is
 * used.
 *
 * p_l minimises relMSE times cost, the error at equal work. Work is counted, not timed,
 * so that the choice is the same on any machine under any load; p_l is rounded to
 * 1/STEPS, so that it does not hang on the last bits of a logarithm unless it lies at the
 * very edge of two steps.
 *
 * Halves of the chains tell what p_l costs that one half chooses, by the curve of the
 * other. More than HALVES asks for a longer start. Both halves together choose about half
 * way between, and the regret is quadratic, so that theirs is about a quarter of it: more
 * than HALVES_MOST means EXPECTED_MOST, and then the published rule decides instead, as
 * it does if there are too few tours or visits, or if clipping took more than CLIPPED of
 * the curve. As a single pair of halves may agree by chance, the same is asked of the
 * jackknife. Independent samples alone, p_l = 1, have the heaviest tails: a chain is held
 * by a bright state for as long as it takes to find a brighter one. They are chosen only
 * if they are better for certain, and if the brightest state that was found holds a chain
 * for STAY_MOST mutations at most. */

#include "chain/tours_choose.h"

#include "base/mem.h"
#include "base/pack.h"
#include "math/accum.h"
#include "math/student.h"

#include <math.h>
#include <stdio.h>

#define P             TOURS_POINTS
#define CAP           TOURS_CAP
#define LEAST         TOURS_LEAST
#define STEPS         256.0
#define HALVES        0.05 /* regret, for a longer start */
#define HALVES_MOST   0.4  /* for the published rule */
#define EXPECTED      0.03
#define EXPECTED_MOST 0.1
#define CLIPPED       0.8
#define BLOCKS        8 /* of the jackknife */
#define INTERVAL      0.99
#define TOURS_FEW     32.0
#define STAY_MOST     64.0 /* mutations */
#define LEAST_PART    1e-6 /* of the variance: a part whose own is not told */

static const struct tours_subset everything = {1, -1, -1};

/* --- the minimum ------------------------------------------------------------------- */

/* The vertex of the parabola in ln p through the least of the points up to the cap and
 * its neighbours. */
static double minimum(const struct tours_curve *c)
{
    int best = LEAST;
    for (int i = LEAST; i <= CAP; i++)
        if (tours_curve_height(c, i) < tours_curve_height(c, best))
            best = i;
    if (best == LEAST || best == CAP)
        return tours_p[best];
    double x[3], y[3];
    for (int k = 0; k < 3; k++) {
        x[k] = log(tours_p[best + k - 1]);
        y[k] = tours_curve_height(c, best + k - 1);
    }
    double left = (y[1] - y[0]) / (x[1] - x[0]), right = (y[2] - y[1]) / (x[2] - x[1]);
    double curvature = (right - left) / (x[2] - x[0]);
    if (!(curvature > 0.0))
        return tours_p[best];
    double vertex = 0.5 * (x[0] + x[1]) - 0.5 * left / curvature;
    return exp(fmin(fmax(vertex, x[0]), x[2]));
}

/* The jackknife over blocks of chains: standard error of ln p_l, the expected regret of
 * p_l by the curve of all chains, and whether p = 1 is better than p = .9 for certain. */
struct spread {
    double se, regret;
    bool independent;
};

static struct spread jackknife(const struct tours_problem *problem,
                               const struct tours_curve *curve)
{
    double best = minimum(curve), regret = 0.0;
    struct welford p = {0}, gain = {0};
    for (int b = 0; b < BLOCKS; b++) {
        struct tours_curve c;
        tours_curve_find(problem, &(struct tours_subset){BLOCKS, -1, b}, &c);
        if (!c.whole)
            return (struct spread){HUGE_VAL, HUGE_VAL, false};
        double chosen = minimum(&c);
        welford_add(&p, log(chosen));
        regret += fmax(tours_regret(curve, chosen, best) - 1.0, 0.0);
        welford_add(&gain, tours_curve_height(&c, P - 1) - tours_curve_height(&c, CAP));
    }
    double scale = (BLOCKS - 1.0) / BLOCKS;
    double t = student_quantile(INTERVAL, BLOCKS - 1.0);
    return (struct spread){sqrt(scale * p.m2), 1.0 + scale * regret,
                           gain.mean + t * sqrt(scale * gain.m2) < 0.0};
}

/* Whether independent samples alone may be trusted: chains of these are held for long by
 * bright states, which few tapes contain. */
static bool may_be_independent(const struct tours_problem *problem)
{
    for (int g = 0; g < problem->count; g++)
        if (problem->parts[g].stay > STAY_MOST)
            return false;
    return true;
}

/* Greatest regret of one half's p_l on the other's curve. */
static double compare_halves(const struct tours_problem *problem)
{
    struct tours_curve half[2];
    for (int h = 0; h < 2; h++) {
        tours_curve_find(problem, &(struct tours_subset){2, h, -1}, &half[h]);
        if (!half[h].whole)
            return HUGE_VAL;
    }
    double a = minimum(&half[0]), b = minimum(&half[1]);
    return fmax(tours_regret(&half[1], a, b), tours_regret(&half[0], b, a));
}

/* Variance and work of a mutation of each part, from half of its chains, at the point
 * next to p. */
static void measure_parts(const struct tours_problem *all, int half, double p,
                          double *variance, double *work)
{
    int i = LEAST;
    while (i < CAP && tours_p[i] < p)
        i++;
    for (int g = 0; g < all->count; g++) {
        struct tours_problem one = {all->parts + g, 1, all->run, all->ends + g};
        double share = all->parts[g].share, fixed = all->run->fixed_work;
        struct tours_curve c;
        tours_curve_find(&one, &(struct tours_subset){2, half, -1}, &c);
        variance[g] = fmax(c.relmse[i] * share, 0.0);
        work[g] = (c.cost[i] - fixed) / share + fixed;
    }
}

/* Error times cost for the shares as they are, over that for shares in proportion to
 * sqrt(V_g / c_g) (Neyman allocation), at the same p_l. The shares of one half of the
 * chains are judged by V_g of the other: by its own V_g any shares that follow it seem
 * to gain, however noisy it is. */
static double allocation_gain(const struct tours_problem *problem, double p)
{
    const struct tours_part *parts = problem->parts;
    int count = problem->count;
    size_t n = (size_t)count;
    double *all = mem_alloc(4 * n, sizeof *all), gain = 0.0;
    for (size_t h = 0; h < 2; h++)
        measure_parts(problem, (int)h, p, all + h * n, all + (2 + h) * n);
    for (size_t h = 0; h < 2; h++) {
        const double *from = all + h * n, *to = all + (1 - h) * n;
        const double *work = all + (2 + h) * n;
        double now[2] = {0.0}, then[2] = {0.0}, sum = 0.0; /* error, cost */
        for (int g = 0; g < count; g++)
            sum += from[g];
        for (int g = 0; g < count; g++) {
            double share = sqrt(fmax(from[g], LEAST_PART * sum) / work[g]);
            now[0] += to[g] / parts[g].share;
            now[1] += parts[g].share * work[g];
            then[0] += to[g] / share;
            then[1] += share * work[g];
        }
        gain += 0.5 * log(now[0] * now[1] / (then[0] * then[1]));
    }
    mem_free(all);
    return isfinite(gain) ? exp(gain) : 1.0;
}

/* --- the choice -------------------------------------------------------------------- */

const char *tours_doubt(const struct tours_choice *c)
{
    if (!c->found)
        return "there are too few tours or visits";
    if (!(c->halves <= 1.0 + HALVES_MOST && c->expected <= 1.0 + EXPECTED_MOST))
        return "halves of the chains disagree";
    if (c->curve.clipped > CLIPPED)
        return "a few chains make most of the predicted error";
    return "";
}

bool tours_wants_more(const struct tours_choice *c)
{
    return *tours_doubt(c) || c->halves > 1.0 + HALVES || c->expected > 1.0 + EXPECTED;
}

static void explain(const struct tours_run *run, struct tours_choice *c)
{
    struct plarge *p = &c->plarge;
    const char *doubt = tours_doubt(c);
    snprintf(p->reason, sizeof p->reason,
             "predicted relMSE at the end %.3g at p_l = %.3f (99 %%: [%.3f, %.3f]); 0.3 "
             "would give %.2f times as much at equal work, zsolnai2013's %.3f %.2f "
             "times%s%s",
             c->relmse, p->p_l, p->p_l_lo, p->p_l_hi,
             tours_regret(&c->curve, 0.3, p->p_l), run->p_zsolnai,
             tours_regret(&c->curve, run->p_zsolnai, p->p_l), *doubt ? "; unsure, " : "",
             doubt);
}

static double round_p(double p)
{
    return fmax(rint(p * STEPS), 1.0) / STEPS;
}

/* Variance of rounding; at an end of the range also that of a least error which may lie
 * anywhere up to half of the way to the next point. */
static double resolution(double p)
{
    double step = 1.0 / STEPS, gap = 0.0;
    if (p <= tours_p[LEAST] + step)
        gap = tours_p[LEAST] - tours_p[LEAST - 1];
    else if (p >= tours_p[CAP] - step)
        gap = 1.0 - tours_p[CAP];
    return (step * step + gap * gap) / 12.0;
}

static struct plarge choose(const struct tours_problem *problem,
                            const struct tours_curve *curve, double *expected)
{
    struct spread spread = jackknife(problem, curve);
    *expected = spread.regret;
    bool independent = spread.independent && may_be_independent(problem);
    double p = independent ? 1.0 : round_p(minimum(curve));
    double se = sqrt(p * spread.se * p * spread.se + resolution(p));
    double half = student_quantile(0.5 * (1.0 + INTERVAL), BLOCKS - 1.0) * se / p;
    bool known = spread.se < HUGE_VAL;
    return (struct plarge){
        .p_l = p,
        .p_l_lo = known ? fmax(p * exp(-half), tours_p[LEAST - 1]) : tours_p[LEAST - 1],
        .p_l_hi = known ? fmin(p * exp(half), 1.0) : 1.0,
        .p_l_se = known ? se : 0.5 * (1.0 - tours_p[LEAST]),
        .p_l_freedom = BLOCKS - 1.0,
        .branch = PLARGE_TOURS,
    };
}

void tours_choose(const struct tours_part *parts, int count, const struct tours_run *run,
                  struct tours_choice *out)
{
    double tours = 0.0;
    int chains = 0;
    struct tours_problem problem;
    *out = (struct tours_choice){.allocation = 1.0};
    for (int g = 0; g < count; g++) {
        chains += parts[g].count;
        for (int c = 0; c < parts[g].count; c++)
            tours += parts[g].chains[c].tours;
    }
    tours_problem_init(&problem, parts, count, run);
    tours_curve_find(&problem, &everything, &out->curve);
    out->found = tours >= TOURS_FEW && chains >= TOURS_CHAINS_FEW && out->curve.whole;
    if (out->found) {
        out->plarge = choose(&problem, &out->curve, &out->expected);
        double p = out->plarge.p_l;
        out->halves = compare_halves(&problem);
        out->relmse = exp(tours_curve_height_at(&out->curve, p)) /
                      tours_curve_cost(&out->curve, p);
        out->allocation = count > 1 ? allocation_gain(&problem, p) : 1.0;
        out->plarge.unsure = *tours_doubt(out) != '\0';
        explain(run, out);
    }
    tours_problem_deinit(&problem);
}

void tours_choice_pack(struct pack *pack, struct tours_choice *c)
{
    pack_flag(pack, "tours_found", &c->found);
    pack_doubles(pack, "tours_relmse", c->curve.relmse, P);
    pack_doubles(pack, "tours_cost", c->curve.cost, P);
    pack_doubles(pack, "tours_spread", c->curve.spread, P);
    pack_flag(pack, "tours_whole", &c->curve.whole);
    pack_double(pack, "tours_at_p_l", &c->relmse);
    pack_double(pack, "tours_halves", &c->halves);
    pack_double(pack, "tours_expected", &c->expected);
    pack_double(pack, "tours_clipped", &c->curve.clipped);
    pack_double(pack, "tours_allocation", &c->allocation);
    plarge_pack(pack, &c->plarge);
}

/* From the sums over visits (tours.c) to a curve and its minimum.
 *
 * Parts g with shares n_g of M mutations have a relMSE of sum_g V_g(p) / (n_g M), V_g the
 * variance per mutation, and a cost of sum_g n_g c_g(p) a mutation; p_l minimises their
 * product, the error at equal work. Work is counted, not timed, so that the choice is the
 * same on any machine under any load.
 *
 * A tape ends. Pairs further apart than its length are missing, and few that are nearly
 * as far apart are there, so `pair` is too small where tours are longer than the tape. Of
 * visits a pair of lag l survives with the mean probability r^l, r = 1 - hazard, so the
 * sum over lags is that over a window of W = sum (1 - l/n) r^l lags, n visits on the
 * tape. If the correlation of the splats falls like l^-beta, then e pair / E_pi[g^2]
 * grows like W^gamma, gamma = 1 - beta, from 0 (no correlation beyond the first lags) to
 * 1 (none is ever lost). gamma is the slope of its logarithm over ln W, seen in the
 * values of p themselves, and pair is multiplied by (W' / W)^gamma, W' the window in a
 * chain of the whole run.
 *
 * At small p the weights of pairs are large and the sums noisy, even negative. There the
 * curve is bounded from below by its values at larger p. With t = p / (1 - p), A =
 * diag(a) and S the kernel of local steps, the sum over a tour is (I - K)^-1 h with I - K
 * = (1 - p) ((I - S) + t A), and as S is reversible, (1 - p) E_pi[h (I - K)^-1 h] is an
 * integral of 1 / (lambda + t) over a positive measure of lambda: a Stieltjes function of
 * t, whose logarithm is convex. (1 - p) sigma^2(p) is this to within E_pi[h^2]; on all
 * toys of tests/stat/test_chain_tours.c its logarithm is convex, for both estimators.
 *
 * The sums have heavy tails: a chain that is stuck at a bright state can make half of the
 * curve. Two halves of the chains that differ by more than HALVES ask for a longer start;
 * a single chain must not do so alone, so that its share is clipped to HALVES / 2 of the
 * whole curve (or to FAIR times its equal share, if chains are few). The bias is the
 * share that is clipped; it is reported. */

#include "chain/tours_curve.h"

#include "base/mem.h"
#include "base/pack.h"
#include "math/accum.h"
#include "math/student.h"

#include <math.h>
#include <stdio.h>

#define P          TOURS_POINTS
#define CAP        (P - 2) /* p = .9: what more needs to be certain */
#define LEAST      1       /* p = .02, the least that is chosen */
#define HALVES     0.05    /* regret */
#define FAIR       4.0     /* equal shares of a chain that are never clipped */
#define BLOCKS     8       /* of the jackknife */
#define INTERVAL   0.99
#define TOURS_FEW  32.0
#define LEAST_PART 1e-6 /* of the variance: a part whose own is not told */
#define CHAINS_FEW (2 * BLOCKS)
#define FIT_FIRST  2 /* values of p from which gamma is estimated: .04 to .8 */
#define FIT_LAST   13

/* --- sums -------------------------------------------------------------------------- */

/* Which chains count: of `blocks` equal blocks, only block `only`, or all but `without`;
 * -1: no such condition. Neighbours may have begun at the same path, so blocks are
 * contiguous. */
struct subset {
    int blocks, only, without;
};

static const struct subset everything = {1, -1, -1};

static bool is_in(const struct subset *s, int chain, int count)
{
    int block = (int)((long)chain * s->blocks / count);
    return (s->only < 0 || block == s->only) && (s->without < 0 || block != s->without);
}

static void add_sums(struct tours_sums *to, const struct tours_sums *s)
{
    to->mutations += s->mutations;
    to->visits += s->visits;
    to->tours += s->tours;
    for (int i = 0; i < P; i++) {
        for (int k = 0; k < 3; k++) {
            to->self[k][i] += s->self[k][i];
            to->pair[k][i] += s->pair[k][i];
        }
        to->mean[i] += s->mean[i];
        to->rejected[i] += s->rejected[i];
        to->weight[i] += s->weight[i];
        to->leave[i] += s->leave[i];
        to->hazard[i] += s->hazard[i];
        to->power[i] += s->power[i];
    }
}

static double centred(double terms[3][P], int i, double theta)
{
    return terms[0][i] + theta * (terms[1][i] + theta * terms[2][i]);
}

/* --- the end of the tapes ----------------------------------------------------------- */

/* Sum of (1 - l/n) r^l over lags l = 1..n. */
static double window(double r, double n)
{
    double d = 1.0 - r;
    if (n < 2.0 || r <= 0.0)
        return fmax(r, 0.0);
    if (d * n < 1e-3)
        return 0.5 * (n - 1.0) * (1.0 - d * (n + 1.0) / 3.0);
    return r / d * (1.0 - (1.0 - pow(r, n)) / (n * d));
}

/* Factors of `pair` of a part, from its sums. */
static void correct_end(const struct tours_part *part, struct tours_sums *s,
                        double factor[P])
{
    double x[P], n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
    double seen = part->recorded * s->visits / s->mutations;
    for (int i = 0; i < P; i++) {
        double theta = s->mean[i] / s->mutations, r = 1.0 - s->hazard[i] / s->weight[i];
        double y = centred(s->pair, i, theta) / s->power[i] * s->leave[i] / s->weight[i];
        x[i] = window(r, seen);
        if (i < FIT_FIRST || i > FIT_LAST || !(y > 0.0 && x[i] > 0.0))
            continue;
        n += 1.0;
        sx += log(x[i]);
        sy += log(y);
        sxx += log(x[i]) * log(x[i]);
        sxy += log(x[i]) * log(y);
    }
    double spread = n * sxx - sx * sx;
    double gamma = spread > 0.0 ? fmin(fmax((n * sxy - sx * sy) / spread, 0.0), 1.0)
                                : 0.0;
    for (int i = 0; i < P; i++) {
        double leave = s->leave[i] / s->weight[i], r = 1.0 - s->hazard[i] / s->weight[i];
        double whole = window(r, part->planned * leave);
        factor[i] = x[i] > 0.0 && whole > 0.0 ? pow(whole / x[i], gamma) : 1.0;
    }
}

/* --- the curve --------------------------------------------------------------------- */

/* Contributions of all chains of a part to the sum over parts of V_g / n_g; adds their
 * sum to total. */
static void add_part(const struct tours_part *part, const struct subset *subset,
                     double (*own)[P], double total[P])
{
    struct tours_sums sum = {0};
    double factor[P];
    for (int c = 0; c < part->count; c++)
        if (is_in(subset, c, part->count))
            add_sums(&sum, &part->chains[c]);
    if (!(sum.mutations > 0.0 && sum.weight[0] > 0.0))
        return;
    correct_end(part, &sum, factor);
    for (int c = 0; c < part->count; c++) {
        struct tours_sums s = part->chains[c];
        for (int i = 0; i < P && is_in(subset, c, part->count); i++) {
            double theta = sum.mean[i] / sum.mutations;
            double rejected = sum.rejected[i] / sum.mutations;
            double v = centred(s.self, i, theta) + factor[i] * centred(s.pair, i, theta);
            v -= s.mutations * rejected * rejected * s.square;
            own[c][i] = v / (sum.mutations * part->share);
            total[i] += own[c][i];
        }
    }
}

/* Raises values to the lower bound by log-convexity in t, see above; from the cap on to
 * smaller p, by the chord through the next point and that two further. */
static void bound_below(double total[P])
{
    double t[P], y[P] = {0.0};
    for (int i = 0; i < P - 1; i++)
        t[i] = tours_p[i] / (1.0 - tours_p[i]);
    for (int i = CAP; i >= 0; i--) {
        double stay = 1.0 - tours_p[i], least = 0.0;
        if (i + 3 <= CAP) {
            double slope = (y[i + 3] - y[i + 1]) / (t[i + 3] - t[i + 1]);
            least = exp(y[i + 1] + slope * (t[i] - t[i + 1])) / stay;
        } else if (i < CAP) {
            least = exp(y[i + 1]) / stay; /* decreasing */
        }
        total[i] = fmax(total[i], least);
        y[i] = log(stay * fmax(total[i], 1e-300));
    }
}

/* Scales down chains with more than `most` of the curve anywhere below the cap. */
static void clip(double (*own)[P], int chains, double most, double total[P])
{
    double sum[P] = {0.0};
    for (int c = 0; c < chains; c++) {
        double share = 0.0;
        for (int i = LEAST; i <= CAP; i++)
            share = total[i] > 0.0 ? fmax(share, own[c][i] / total[i]) : share;
        for (int i = 0; i < P; i++)
            sum[i] += (share > most ? most / share : 1.0) * own[c][i];
    }
    for (int i = 0; i < P; i++)
        total[i] = sum[i];
}

/* Sets the curve and returns the share that clipping took at the least error. */
static double find_curve(const struct tours_part *parts, int count,
                         const struct tours_run *run, const struct subset *subset,
                         struct tours_curve *out)
{
    int chains = 0, first = 0;
    double before[P], total[P] = {0.0};
    for (int g = 0; g < count; g++)
        chains += parts[g].count;
    double(*own)[P] = mem_alloc((size_t)chains, sizeof *own);
    for (int i = 0; i < P; i++)
        out->cost[i] = run->fixed_work;
    for (int g = 0; g < count; g++) {
        const struct tours_part *part = &parts[g];
        add_part(part, subset, own + first, total);
        for (int i = 0; i < P; i++)
            out->cost[i] += part->share * ((1.0 - tours_p[i]) * part->work[0] +
                                           tours_p[i] * part->work[1]);
        first += part->count;
    }
    double kept = subset->only >= 0      ? 1.0 / subset->blocks
                  : subset->without >= 0 ? 1.0 - 1.0 / subset->blocks
                                         : 1.0;
    bound_below(total);
    for (int i = 0; i < P; i++)
        before[i] = total[i];
    clip(own, chains, fmax(0.5 * HALVES, FAIR / chains) / kept, total);
    bound_below(total);
    mem_free(own);
    double lost = 0.0;
    for (int i = 0; i < P; i++) {
        out->relmse[i] = total[i] / run->mutations;
        if (i >= LEAST && i <= CAP && before[i] > 0.0)
            lost = fmax(lost, 1.0 - total[i] / before[i]);
    }
    return lost;
}

static bool is_whole(const struct tours_curve *c)
{
    for (int i = 0; i < P; i++)
        if (!(c->relmse[i] > 0.0 && c->relmse[i] < HUGE_VAL && c->cost[i] > 0.0))
            return false;
    return true;
}

/* --- the minimum ------------------------------------------------------------------- */

static double height(const struct tours_curve *c, int i)
{
    return log(c->relmse[i] * c->cost[i]);
}

/* Linear in ln p between the points. */
static double height_at(const struct tours_curve *c, double p)
{
    int i = 0;
    while (i < P - 2 && tours_p[i + 1] < p)
        i++;
    double t = log(p / tours_p[i]) / log(tours_p[i + 1] / tours_p[i]);
    t = fmin(fmax(t, 0.0), 1.0);
    return (1.0 - t) * height(c, i) + t * height(c, i + 1);
}

/* Work is linear in p. */
static double cost_at(const struct tours_curve *c, double p)
{
    double slope = (c->cost[P - 1] - c->cost[0]) / (tours_p[P - 1] - tours_p[0]);
    return c->cost[0] + slope * (p - tours_p[0]);
}

double tours_regret(const struct tours_curve *curve, double p, double q)
{
    return exp(height_at(curve, p) - height_at(curve, q));
}

/* The vertex of the parabola in ln p through the least of the points up to the cap and
 * its neighbours. */
static double minimum(const struct tours_curve *c)
{
    int best = LEAST;
    for (int i = LEAST; i <= CAP; i++)
        if (height(c, i) < height(c, best))
            best = i;
    if (best == LEAST || best == CAP)
        return tours_p[best];
    double x[3], y[3];
    for (int k = 0; k < 3; k++) {
        x[k] = log(tours_p[best + k - 1]);
        y[k] = height(c, best + k - 1);
    }
    double left = (y[1] - y[0]) / (x[1] - x[0]), right = (y[2] - y[1]) / (x[2] - x[1]);
    double curvature = (right - left) / (x[2] - x[0]);
    if (!(curvature > 0.0))
        return tours_p[best];
    double vertex = 0.5 * (x[0] + x[1]) - 0.5 * left / curvature;
    return exp(fmin(fmax(vertex, x[0]), x[2]));
}

/* The jackknife over blocks of chains: standard error of ln p_l, and whether p = 1 is
 * better than p = .9 for certain. */
struct spread {
    double se;
    bool independent;
};

static struct spread jackknife(const struct tours_part *parts, int count,
                               const struct tours_run *run)
{
    struct welford p = {0}, gain = {0};
    for (int b = 0; b < BLOCKS; b++) {
        struct tours_curve c;
        find_curve(parts, count, run, &(struct subset){BLOCKS, -1, b}, &c);
        if (!is_whole(&c))
            return (struct spread){HUGE_VAL, false};
        welford_add(&p, log(minimum(&c)));
        welford_add(&gain, height(&c, P - 1) - height(&c, CAP));
    }
    double scale = (BLOCKS - 1.0) / BLOCKS;
    double t = student_quantile(INTERVAL, BLOCKS - 1.0);
    return (struct spread){sqrt(scale * p.m2),
                           gain.mean + t * sqrt(scale * gain.m2) < 0.0};
}

/* Greatest regret of one half's p_l on the other's curve. */
static double compare_halves(const struct tours_part *parts, int count,
                             const struct tours_run *run)
{
    struct tours_curve half[2];
    for (int h = 0; h < 2; h++) {
        find_curve(parts, count, run, &(struct subset){2, h, -1}, &half[h]);
        if (!is_whole(&half[h]))
            return HUGE_VAL;
    }
    double a = minimum(&half[0]), b = minimum(&half[1]);
    return fmax(tours_regret(&half[1], a, b), tours_regret(&half[0], b, a));
}

/* Variance and work of a mutation of each part, from half of its chains, at the point
 * next to p. */
static void measure_parts(const struct tours_part *parts, int count,
                          const struct tours_run *run, int half, double p,
                          double *variance, double *work)
{
    int i = LEAST;
    while (i < CAP && tours_p[i] < p)
        i++;
    for (int g = 0; g < count; g++) {
        struct tours_curve c;
        find_curve(&parts[g], 1, run, &(struct subset){2, half, -1}, &c);
        variance[g] = fmax(c.relmse[i] * parts[g].share, 0.0);
        work[g] = (c.cost[i] - run->fixed_work) / parts[g].share + run->fixed_work;
    }
}

/* Error times cost for the shares as they are, over that for shares in proportion to
 * sqrt(V_g / c_g) (Neyman allocation), at the same p_l. The shares of one half of the
 * chains are judged by V_g of the other: by its own V_g any shares that follow it seem
 * to gain, however noisy it is. */
static double allocation_gain(const struct tours_part *parts, int count,
                              const struct tours_run *run, double p)
{
    size_t n = (size_t)count;
    double *all = mem_alloc(4 * n, sizeof *all), gain = 0.0;
    for (size_t h = 0; h < 2; h++)
        measure_parts(parts, count, run, (int)h, p, all + h * n, all + (2 + h) * n);
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

static void explain(const struct tours_run *run, struct tours_choice *c)
{
    struct plarge *p = &c->plarge;
    snprintf(p->reason, sizeof p->reason,
             "predicted relMSE at the end %.3g at p_l = %.3f (99 %%: [%.3f, %.3f]); 0.3 "
             "would give %.2f times as much at equal work, zsolnai2013's %.3f %.2f "
             "times%s",
             c->relmse, p->p_l, p->p_l_lo, p->p_l_hi,
             tours_regret(&c->curve, 0.3, p->p_l), run->p_zsolnai,
             tours_regret(&c->curve, run->p_zsolnai, p->p_l),
             p->unsure ? "; unsure, halves of the chains disagree" : "");
}

void tours_choose(const struct tours_part *parts, int count, const struct tours_run *run,
                  struct tours_choice *out)
{
    double tours = 0.0;
    int chains = 0;
    *out = (struct tours_choice){.allocation = 1.0};
    for (int g = 0; g < count; g++) {
        chains += parts[g].count;
        for (int c = 0; c < parts[g].count; c++)
            tours += parts[g].chains[c].tours;
    }
    out->clipped = find_curve(parts, count, run, &everything, &out->curve);
    out->found = tours >= TOURS_FEW && chains >= CHAINS_FEW && is_whole(&out->curve);
    if (!out->found)
        return;
    struct spread spread = jackknife(parts, count, run);
    double p = spread.independent ? 1.0 : minimum(&out->curve);
    double half = spread.se < HUGE_VAL
                      ? student_quantile(0.5 * (1.0 + INTERVAL), BLOCKS - 1.0) * spread.se
                      : HUGE_VAL;
    out->halves = compare_halves(parts, count, run);
    out->relmse = exp(height_at(&out->curve, p)) / cost_at(&out->curve, p);
    out->allocation = count > 1 ? allocation_gain(parts, count, run, p) : 1.0;
    out->plarge = (struct plarge){
        .p_l = p,
        .p_l_lo = fmax(p * exp(-half), tours_p[LEAST]),
        .p_l_hi = fmin(p * exp(half), 1.0),
        .p_l_se = spread.se < HUGE_VAL ? p * spread.se : 0.5 * (1.0 - tours_p[LEAST]),
        .p_l_freedom = BLOCKS - 1.0,
        .branch = PLARGE_TOURS,
        .unsure = !(out->halves <= 1.0 + HALVES),
    };
    explain(run, out);
}

void tours_choice_pack(struct pack *pack, struct tours_choice *c)
{
    pack_flag(pack, "tours_found", &c->found);
    pack_doubles(pack, "tours_relmse", c->curve.relmse, P);
    pack_doubles(pack, "tours_cost", c->curve.cost, P);
    pack_double(pack, "tours_at_p_l", &c->relmse);
    pack_double(pack, "tours_halves", &c->halves);
    pack_double(pack, "tours_clipped", &c->clipped);
    pack_double(pack, "tours_allocation", &c->allocation);
    plarge_pack(pack, &c->plarge);
}

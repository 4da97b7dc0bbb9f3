/* From the sums over visits (tours.c) to the predicted error at every p.
 *
 * Parts g with shares n_g of M mutations have a relMSE of sum_g V_g(p) / (n_g M), V_g the
 * variance per mutation: the sums `self` and `pair`, the latter with what tapes are too
 * short to show (tours_end.c).
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
 * curve. A single chain must not decide, so that its share is clipped to CLIP of the
 * whole curve (or to FAIR times its equal share, if chains are few). The bias is the
 * share that is clipped; it is reported. */

#include "chain/tours_curve.h"

#include "base/mem.h"

#include <math.h>

#define P      TOURS_POINTS
#define CLIP   0.025 /* of the curve: most that one chain may have */
#define FAIR   4.0   /* equal shares of a chain that are never clipped */
#define MIDDLE 10    /* p = .5 */
#define SHORT  0.1   /* of the curve: most that parts with too short tapes may make */

/* --- sums -------------------------------------------------------------------------- */

/* Which chains count: of `blocks` equal blocks, only block `only`, or all but `without`.
 * Neighbours may have begun at the same path, so blocks are contiguous. A part that has
 * fewer chains than there are blocks has one chain in some of them; left out entirely, it
 * would tell a greater error than the jackknife over so few chains does. It stays with a
 * weight such that both agree. */
static double weight_of(const struct tours_subset *s, int chain, int count)
{
    int block = (int)((long)chain * s->blocks / count);
    if (s->only >= 0)
        return block == s->only ? 1.0 : 0.0;
    if (s->without < 0 || block != s->without)
        return 1.0;
    if (count >= s->blocks)
        return 0.0;
    double n = count, b = s->blocks, shrink = sqrt(b * (n - 1.0) / ((b - 1.0) * n));
    return count > 1 ? (n - 1.0) * (1.0 - shrink) / (n - 1.0 + shrink) : 1.0;
}

static void add_sums(struct tours_sums *to, const struct tours_sums *s, double weight)
{
    to->mutations += weight * s->mutations;
    for (int i = 0; i < P; i++) {
        for (int k = 0; k < 3; k++) {
            to->self[k][i] += weight * s->self[k][i];
            for (int c = 0; c < TOURS_CUTS; c++)
                to->pair[c][k][i] += weight * s->pair[c][k][i];
        }
        to->mean[i] += weight * s->mean[i];
        to->rejected[i] += weight * s->rejected[i];
    }
}

/* Terms about the means times theta. */
static double self_of(const struct tours_sums *s, int i, double theta)
{
    return s->self[0][i] + theta * (s->self[1][i] + theta * s->self[2][i]);
}

static double pair_of(const struct tours_sums *s, int cut, int i, double theta)
{
    return s->pair[cut][0][i] + theta * (s->pair[cut][1][i] + theta * s->pair[cut][2][i]);
}

/* --- the problem ------------------------------------------------------------------- */

/* Visits of a chain on its tape, if there are enough of them to be cut into pieces. */
static double visits_of(const struct tours_part *part)
{
    double visits = 0.0, mutations = 0.0;
    for (int c = 0; c < part->count; c++) {
        visits += part->chains[c].visits;
        mutations += part->chains[c].mutations;
    }
    return mutations > 0.0 ? part->recorded * visits / mutations : 0.0;
}

void tours_problem_init(struct tours_problem *problem, const struct tours_part *parts,
                        int count, const struct tours_run *run)
{
    *problem = (struct tours_problem){parts, count, run, NULL};
    /* NOLINTNEXTLINE(bugprone-sizeof-expression): pointers are meant */
    problem->ends = mem_alloc((size_t)count, sizeof *problem->ends);
    for (int g = 0; g < count; g++) {
        double visits = visits_of(&parts[g]), whole[P];
        /* Where large steps are rejected, a visit is as long as the wait for a small one.
         */
        for (int i = 0; i < P; i++)
            whole[i] = parts[g].planned * (1.0 - tours_p[i]);
        problem->ends[g] = visits >= TOURS_END_VISITS ? tours_end_create(visits, whole)
                                                      : NULL;
    }
}

void tours_problem_deinit(struct tours_problem *problem)
{
    for (int g = 0; g < problem->count; g++)
        tours_end_destroy(problem->ends[g]);
    mem_free(problem->ends);
}

/* --- the curve --------------------------------------------------------------------- */

/* Sums of a part, by weights of its chains. */
static void sum_part(const struct tours_part *part, const double *weights,
                     struct tours_sums *sum)
{
    *sum = (struct tours_sums){.square = part->chains[0].square};
    for (int c = 0; c < part->count; c++)
        if (weights[c] > 0.0)
            add_sums(sum, &part->chains[c], weights[c]);
}

/* What chains with the sums s, of all of a part, add to the sum over parts of V_g / n_g.
 */
static double variance(const struct tours_part *part, const struct tours_sums *all,
                       const struct tours_sums *s, double factor, int i)
{
    double theta = all->mean[i] / all->mutations;
    double rejected = all->rejected[i] / all->mutations;
    double v = self_of(s, i, theta) + factor * pair_of(s, 0, i, theta);
    v -= s->mutations * rejected * rejected * s->square;
    return v / (all->mutations * part->share);
}

/* Raises values to the lower bound by log-convexity in t, see above; from the cap on to
 * smaller p, by the chord through the next point and that two further. */
static void bound_below(double total[P])
{
    double t[P], y[P] = {0.0};
    for (int i = 0; i < P - 1; i++)
        t[i] = tours_p[i] / (1.0 - tours_p[i]);
    for (int i = TOURS_CAP; i >= 0; i--) {
        double stay = 1.0 - tours_p[i], least = 0.0;
        if (i + 3 <= TOURS_CAP) {
            double slope = (y[i + 3] - y[i + 1]) / (t[i + 3] - t[i + 1]);
            least = exp(y[i + 1] + slope * (t[i] - t[i + 1])) / stay;
        } else if (i < TOURS_CAP) {
            least = exp(y[i + 1]) / stay; /* decreasing */
        }
        total[i] = fmax(total[i], least);
        y[i] = log(stay * fmax(total[i], 1e-300));
    }
}

/* Greatest share of each chain in a curve between the ends of its range, as it is on the
 * tapes; scales the chains' weights down to `most`. Returns the share that is lost. */
static double clip(const struct tours_problem *problem, double most, double *weights)
{
    double total[P] = {0.0}, gone[P] = {0.0}, lost = 0.0;
    struct tours_sums *sums = mem_alloc((size_t)problem->count, sizeof *sums);
    double *w = weights;
    for (int g = 0; g < problem->count; w += problem->parts[g++].count) {
        sum_part(&problem->parts[g], w, &sums[g]);
        for (int i = 0; i < P && sums[g].mutations > 0.0; i++)
            total[i] += variance(&problem->parts[g], &sums[g], &sums[g], 1.0, i);
    }
    bound_below(total);
    w = weights;
    for (int g = 0; g < problem->count; w += problem->parts[g++].count) {
        const struct tours_part *part = &problem->parts[g];
        for (int c = 0; c < part->count && sums[g].mutations > 0.0; c++) {
            double own[P], share = 0.0;
            for (int i = TOURS_LEAST; i <= TOURS_CAP; i++) {
                own[i] = w[c] * variance(part, &sums[g], &part->chains[c], 1.0, i);
                share = total[i] > 0.0 ? fmax(share, own[i] / total[i]) : share;
            }
            double keep = share > most ? most / share : 1.0;
            for (int i = TOURS_LEAST; i <= TOURS_CAP; i++)
                gone[i] += (1.0 - keep) * own[i];
            w[c] *= keep;
        }
    }
    for (int i = TOURS_LEAST; i <= TOURS_CAP; i++)
        lost = total[i] > 0.0 ? fmax(lost, gone[i] / total[i]) : lost;
    mem_free(sums);
    return lost;
}

/* Factors of the pairs; false if the tapes are too short to tell. */
static bool extrapolate(const struct tours_end *end, const struct tours_sums *sum,
                        double factor[P], double spread[P])
{
    double pair[TOURS_CUTS][P], self[P];
    if (!end)
        return false;
    for (int i = 0; i < P; i++) {
        double theta = sum->mean[i] / sum->mutations;
        self[i] = self_of(sum, i, theta);
        for (int c = 0; c < TOURS_CUTS; c++)
            pair[c][i] = pair_of(sum, c, i, theta);
    }
    tours_end_extrapolate(end, pair, self, factor, spread);
    return true;
}

/* Adds a part to the sum over parts of V_g / n_g; its clipped chains lower both terms
 * without lowering the number of mutations. Returns what it adds at p = .5 if its tapes
 * are too short to be extended, else 0. */
static double add_part(const struct tours_problem *problem, int g, const double *weights,
                       double mutations, double total[P], double spread[P])
{
    const struct tours_part *part = &problem->parts[g];
    struct tours_sums sum;
    double factor[P], uncertain[P], before = total[MIDDLE];
    sum_part(part, weights, &sum);
    if (!(sum.mutations > 0.0))
        return 0.0;
    bool known = extrapolate(problem->ends[g], &sum, factor, uncertain);
    for (int i = 0; i < P; i++) {
        double f = known ? factor[i] : 1.0, theta = sum.mean[i] / sum.mutations;
        double scale = sum.mutations / mutations;
        total[i] += scale * variance(part, &sum, &sum, f, i);
        if (known)
            spread[i] += f * pair_of(&sum, 0, i, theta) / (mutations * part->share) *
                         uncertain[i];
    }
    return known ? 0.0 : total[MIDDLE] - before;
}

static void find_cost(const struct tours_problem *problem, double cost[P])
{
    for (int i = 0; i < P; i++) {
        cost[i] = problem->run->fixed_work;
        for (int g = 0; g < problem->count; g++) {
            const struct tours_part *part = &problem->parts[g];
            cost[i] += part->share *
                       ((1.0 - tours_p[i]) * part->work[0] + tours_p[i] * part->work[1]);
        }
    }
}

void tours_curve_find(const struct tours_problem *problem,
                      const struct tours_subset *subset, struct tours_curve *out)
{
    int chains = 0;
    double total[P] = {0.0}, used = 0.0, unknown = 0.0;
    for (int g = 0; g < problem->count; g++)
        chains += problem->parts[g].count;
    double *weights = mem_alloc((size_t)chains, sizeof *weights), *w = weights;
    double *mutations = mem_alloc((size_t)problem->count, sizeof *mutations);
    for (int g = 0; g < problem->count; w += problem->parts[g++].count)
        for (int c = 0; c < problem->parts[g].count; c++) {
            w[c] = weight_of(subset, c, problem->parts[g].count);
            mutations[g] += w[c] * problem->parts[g].chains[c].mutations;
            used += w[c];
        }
    *out = (struct tours_curve){.whole = false};
    out->clipped = clip(problem, fmax(CLIP * chains, FAIR) / used, weights);
    w = weights;
    for (int g = 0; g < problem->count; w += problem->parts[g++].count)
        unknown += add_part(problem, g, w, mutations[g], total, out->spread);
    out->whole = unknown < SHORT * total[MIDDLE];
    bound_below(total);
    find_cost(problem, out->cost);
    for (int i = 0; i < P; i++) {
        out->relmse[i] = total[i] / problem->run->mutations;
        out->spread[i] /= total[i];
        out->whole = out->whole && total[i] > 0.0 && out->relmse[i] < HUGE_VAL &&
                     out->cost[i] > 0.0;
    }
    mem_free(mutations);
    mem_free(weights);
}

/* --- values ------------------------------------------------------------------------ */

double tours_curve_height(const struct tours_curve *curve, int point)
{
    return log(curve->relmse[point] * curve->cost[point]);
}

double tours_curve_height_at(const struct tours_curve *c, double p)
{
    int i = 0;
    while (i < P - 2 && tours_p[i + 1] < p)
        i++;
    double t = log(p / tours_p[i]) / log(tours_p[i + 1] / tours_p[i]);
    t = fmin(fmax(t, 0.0), 1.0);
    return (1.0 - t) * tours_curve_height(c, i) + t * tours_curve_height(c, i + 1);
}

double tours_curve_cost(const struct tours_curve *c, double p)
{
    double slope = (c->cost[P - 1] - c->cost[0]) / (tours_p[P - 1] - tours_p[0]);
    return c->cost[0] + slope * (p - tours_p[0]);
}

double tours_regret(const struct tours_curve *curve, double p, double q)
{
    return exp(tours_curve_height_at(curve, p) - tours_curve_height_at(curve, q));
}

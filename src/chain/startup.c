/* Standard errors of the statistics. Chains that start at the same bootstrap path are
 * correlated while they mix slowly, so together they are one unit; units are independent,
 * as the paths are. A part's figure is the ratio e = sum A_i / sum n_i over such units
 * (A: what was counted, n: proposals), whose error is to first order
 *
 *     sum x_i,   x_i = (A_i - e n_i) / sum n.
 *
 * This includes the errors of the bootstrap and of the resampling. A unit's residual from
 * a mean that includes the unit is too small; it is divided by sqrt(1 - h)
 * [BellMcCaffrey02], where h is the unit's share of the chains. For equal weights this is
 * the factor n/(n-1) of the variance.
 *
 * The whole over parts (path lengths) is e = sum b_k e_k / sum b_k. Its error adds those
 * of the parts, weighted, and those of the weights: de/db_k = (e_k - e) / b, b = sum b_k,
 * so they add sum (e_k - e)^2 var(b_k) / b^2. To a ratio u/v of two such figures a unit
 * or a weight adds (x_u - (u/v) x_v) / v (delta method).
 *
 * Acceptance and failure rate of a run mix those of large and of small steps by p_l,
 * which the start decided: a = p_l a_L + (1 - p_l) a_S in the main pass. Where p_l is a
 * smooth function of q, each unit's x of q is added to its x of a, times da/dq: the units
 * of the start are those of the run. Where it is not, because p_l jumps between two
 * branches of its rule, (da/dp_l)^2 times the variance of p_l is added to the sum
 * instead.
 *
 * The variance V = sum x_i^2 of a part has as many degrees of freedom as a multiple of
 * chi-squared with its mean and variance, 2 V^2 / var(V) [Satterthwaite46], where var(V)
 * is estimated from the spread of the x_i^2: if a few units dominate, there are few
 * degrees of freedom. */

#include "chain/startup.h"

#include "base/mem.h"
#include "base/pack.h"
#include "math/student.h"

#include <math.h>

#define INTERVAL 0.99

/* Figures: first those that are counts over counts, then ratios of these. */
enum figure { SMALL, LARGE, NONZERO, ACCEPTED, FAILED, COUNTED, R = COUNTED, Q, FIGURES };

struct counts {
    double value[COUNTED], of[COUNTED];
};

static void add_counts(struct counts *c, const struct tally *t)
{
    double small = (double)tally_small(t->proposed);
    double first = (double)tally_first(t->proposed);
    double large = (double)t->proposed[MOVE_LARGE];
    double nonzero = (double)tally_first(t->nonzero);
    const double value[COUNTED] = {
        [SMALL] = tally_small_acceptance(t),
        [LARGE] = t->acceptance[MOVE_LARGE],
        [NONZERO] = (double)t->nonzero[MOVE_LARGE],
        [ACCEPTED] = (double)tally_moves(t),
        [FAILED] = first - nonzero,
    };
    const double of[COUNTED] = {small, large, large, first, first};
    for (int f = 0; f < COUNTED; f++) {
        c->value[f] += value[f];
        c->of[f] += of[f];
    }
}

/* Sums over the units of a part, by figure. */
struct part {
    struct counts all;
    double weight[COUNTED]; /* weight of the part's figure in that of the whole */
    int units;
    double concentration; /* sum of h^2: 1 / effective number of units */
    double squares[FIGURES], fourths[FIGURES]; /* of x */
};

static double ratio(double a, double b)
{
    return b > 0.0 ? a / b : 0.0;
}

/* Weights of the parts: by b for some figures, by proposals for others. */
static void weigh(const struct statistics_part *parts, struct part *own, int count)
{
    double b = 0.0, n[COUNTED] = {0.0};
    for (int i = 0; i < count; i++) {
        b += parts[i].b;
        for (int f = 0; f < COUNTED; f++)
            n[f] += own[i].all.of[f];
    }
    for (int i = 0; i < count; i++)
        for (int f = 0; f < COUNTED; f++)
            own[i].weight[f] = f < ACCEPTED ? (count > 1 ? ratio(parts[i].b, b) : 1.0)
                                            : ratio(own[i].all.of[f], n[f]);
}

/* Figures of the whole: weighted means over the parts. */
static void estimate(const struct part *own, int count, double e[FIGURES])
{
    for (int f = 0; f < FIGURES; f++)
        e[f] = 0.0;
    for (int i = 0; i < count; i++)
        for (int f = 0; f < COUNTED; f++)
            e[f] += own[i].weight[f] * ratio(own[i].all.value[f], own[i].all.of[f]);
    e[R] = ratio(e[LARGE], e[NONZERO]);
    e[Q] = ratio(e[LARGE], e[SMALL]);
}

/* Errors of the ratios R and Q by the delta method, from those of the counted figures. */
static void derive(const double e[FIGURES], double x[FIGURES])
{
    /* Delta method for a ratio u/v: (x_u - (u/v) x_v) / v. */
    x[R] = e[NONZERO] > 0.0 ? (x[LARGE] - e[R] * x[NONZERO]) / e[NONZERO] : HUGE_VAL;
    x[Q] = e[SMALL] > 0.0 ? (x[LARGE] - e[Q] * x[SMALL]) / e[SMALL] : HUGE_VAL;
}

/* The unit's x, as defined above. */
static void unit_errors(const struct part *p, const struct counts *unit, double h,
                        const double e[FIGURES], double x[FIGURES])
{
    for (int f = 0; f < COUNTED; f++) {
        double own = ratio(p->all.value[f], p->all.of[f]);
        /* x_i = (A_i - e n_i) / sum n, over sqrt(1 - h) [BellMcCaffrey02]. */
        x[f] = p->weight[f] * ratio(unit->value[f] - own * unit->of[f], p->all.of[f]) /
               sqrt(1.0 - h);
    }
    derive(e, x);
}

/* The start that p_l was decided from. */
struct origin {
    const struct statistics_part *parts;
    const struct part *own;
    const double *e; /* [FIGURES] */
    const struct statistics_mixing *mixing;
};

static void add_squares(struct part *p, const double x[FIGURES])
{
    for (int f = 0; f < FIGURES; f++) {
        p->squares[f] += x[f] * x[f];
        p->fourths[f] += x[f] * x[f] * x[f] * x[f];
    }
}

/* The first chain after the unit that begins at `first`. */
static int unit_end(const struct statistics_part *part, int first)
{
    int end = first + 1;
    while (part->seeds && end < part->chains && part->seeds[end] == part->seeds[first])
        end++;
    return end;
}

static struct counts sum_counts(const struct tally *tallies, int first, int end)
{
    struct counts sum = {{0.0}, {0.0}};
    for (int i = first; i < end; i++)
        add_counts(&sum, &tallies[i]);
    return sum;
}

/* Adds the squares of the units' x. origin: NULL, or the start whose p_l also moves the
 * figures; index: of the part. */
static void add_units(const struct statistics_part *part, struct part *p,
                      const double e[FIGURES], const struct origin *origin, int index)
{
    for (int i = 0, end; i < part->chains; i = end) {
        double x[FIGURES], before[FIGURES];
        end = unit_end(part, i);
        struct counts unit = sum_counts(part->tallies, i, end);
        double h = (double)(end - i) / part->chains;
        p->units++;
        p->concentration += h * h;
        if (!(h < 1.0))
            continue;
        unit_errors(p, &unit, h, e, x);
        if (origin && origin->e[SMALL] > 0.0) {
            struct counts start = sum_counts(origin->parts[index].tallies, i, end);
            unit_errors(&origin->own[index], &start, h, origin->e, before);
            x[ACCEPTED] += origin->mixing->slope[0] * before[Q];
            x[FAILED] += origin->mixing->slope[1] * before[Q];
        }
        add_squares(p, x);
    }
}

/* R and Q are ratios of large-step figures and have their weights. */
static double weight_of(const struct part *p, int f)
{
    return p->weight[f < COUNTED ? f : LARGE];
}

/* Whether the part has enough units for an error of its own. */
static bool has_own_error(const struct part *p, int f)
{
    double counted = p->all.of[f < COUNTED ? f : LARGE];
    if (f == Q)
        counted = fmin(counted, p->all.of[SMALL]);
    return p->units > 1 && counted > 0.0;
}

/* Variance of one unit's figure: the weighted mean over parts with an error of their own,
 * used for parts with a single unit. */
static double unit_variance(const struct part *own, int count, int f)
{
    double sum = 0.0, weights = 0.0;
    for (int i = 0; i < count; i++) {
        double w = weight_of(&own[i], f);
        if (!(w > 0.0) || !has_own_error(&own[i], f))
            continue;
        sum += own[i].squares[f] / (w * own[i].concentration);
        weights += w;
    }
    return weights > 0.0 ? sum / weights : HUGE_VAL;
}

static double freedom_of(const struct part *p, int f)
{
    double v = p->squares[f], most = fmax(p->units - 1.0, 1.0);
    double spread = p->fourths[f] - v * v / p->units;
    return spread > 0.0 ? fmin(fmax(student_freedom(v, spread), 1.0), most) : most;
}

struct error {
    bool known;
    double variance, spread; /* spread: sum of variance^2 / freedom */
};

static void add_error(struct error *e, double variance, double freedom)
{
    e->variance += variance;
    e->spread += variance * variance / freedom;
}

static void add_parts(const struct part *own, int count, int f, struct error *error)
{
    double borrowed = unit_variance(own, count, f);
    for (int i = 0; i < count; i++) {
        double w = weight_of(&own[i], f);
        if (!(w > 0.0))
            continue;
        error->known = true;
        if (has_own_error(&own[i], f))
            add_error(error, own[i].squares[f], freedom_of(&own[i], f));
        else
            add_error(error, w * w * borrowed, 1.0);
    }
}

/* Adds the errors of the weights b. Acceptance and failure rate are weighted by proposals
 * and have no such error. */
static void add_weight(const struct statistics_part *part, const struct part *p, double b,
                       const double e[FIGURES], struct error errors[FIGURES])
{
    double x[FIGURES] = {0.0};
    for (int f = 0; f < ACCEPTED; f++)
        x[f] = (ratio(p->all.value[f], p->all.of[f]) - e[f]) * sqrt(part->b_variance) / b;
    derive(e, x);
    for (int f = 0; f < FIGURES; f++)
        add_error(&errors[f], x[f] * x[f], fmax(part->b_freedom, 1.0));
}

static void find_errors(const struct statistics_part *parts, const struct part *own,
                        int count, const double e[FIGURES], struct error errors[FIGURES])
{
    double b = 0.0;
    for (int f = 0; f < FIGURES; f++)
        add_parts(own, count, f, &errors[f]);
    for (int i = 0; i < count; i++)
        b += parts[i].b;
    for (int i = 0; i < count && count > 1; i++)
        if (parts[i].b > 0.0 && parts[i].b_variance > 0.0)
            add_weight(&parts[i], &own[i], b, e, errors);
}

static void add_mixing(const struct statistics_mixing *mixing,
                       struct error errors[FIGURES])
{
    double freedom = fmax(mixing->freedom, 1.0);
    add_error(&errors[ACCEPTED], mixing->variance[0], freedom);
    add_error(&errors[FAILED], mixing->variance[1], freedom);
}

/* --- results ----------------------------------------------------------------------- */

static void set_figures(const double e[FIGURES], const struct error errors[FIGURES],
                        struct statistics *s)
{
    struct {
        double *value, *se, *freedom;
    } to[FIGURES] = {
        [SMALL] = {&s->eta_s, &s->eta_s_se, &s->eta_s_freedom},
        [LARGE] = {&s->eta_l, &s->eta_l_se, &s->eta_l_freedom},
        [NONZERO] = {&s->eta_0, &s->eta_0_se, &s->eta_0_freedom},
        [ACCEPTED] = {&s->acceptance, &s->acceptance_se, &s->acceptance_freedom},
        [FAILED] = {&s->failure_rate, &s->failure_rate_se, &s->failure_rate_freedom},
        [R] = {&s->r, &s->r_se, &s->r_freedom},
        [Q] = {&s->q, &s->q_se, &s->q_freedom},
    };
    for (int f = 0; f < FIGURES; f++) {
        double v = errors[f].variance, spread = errors[f].spread;
        bool known = errors[f].known && v < HUGE_VAL;
        *to[f].value = e[f];
        *to[f].se = known ? sqrt(v) : HUGE_VAL;
        *to[f].freedom = known && spread > 0.0 ? fmax(v / spread * v, 1.0) : 1.0;
    }
}

static void set_interval(struct statistics *s)
{
    double half = s->r_se < HUGE_VAL
                      ? student_quantile(0.5 * (1.0 + INTERVAL), s->r_freedom) * s->r_se
                      : HUGE_VAL;
    s->r_lo = fmax(0.0, s->r - half);
    s->r_hi = fmin(1.0, s->r + half);
}

static double small_nonzero(const struct statistics_part *part)
{
    double nonzero = 0.0, small = 0.0;
    for (int i = 0; i < part->chains; i++) {
        nonzero += (double)tally_small(part->tallies[i].nonzero);
        small += (double)tally_small(part->tallies[i].proposed);
    }
    return ratio(nonzero, small);
}

/* The parts with their estimates and weights; the caller frees the array. */
static struct part *find_parts(const struct statistics_part *parts, int count,
                               double e[FIGURES])
{
    struct part *own = mem_alloc((size_t)count, sizeof *own);
    for (int i = 0; i < count; i++)
        own[i].all = sum_counts(parts[i].tallies, 0, parts[i].chains);
    weigh(parts, own, count);
    estimate(own, count, e);
    return own;
}

static void measure(const struct statistics_part *parts, int count,
                    const struct origin *origin, struct statistics *out)
{
    struct error errors[FIGURES] = {{0}};
    double e[FIGURES];
    struct part *own = find_parts(parts, count, e);
    *out = (struct statistics){0};
    for (int i = 0; i < count; i++) {
        add_units(&parts[i], &own[i], e, origin, i);
        out->z_small += own[i].weight[SMALL] * small_nonzero(&parts[i]);
        out->seeds += own[i].units;
        out->small += (int64_t)own[i].all.of[SMALL];
        out->large += (int64_t)own[i].all.of[LARGE];
    }
    find_errors(parts, own, count, e, errors);
    if (origin)
        add_mixing(origin->mixing, errors);
    set_figures(e, errors, out);
    set_interval(out);
    mem_free(own);
}

void statistics_measure(const struct statistics_part *parts, int count,
                        struct statistics *out)
{
    measure(parts, count, NULL, out);
}

void statistics_measure_after(const struct statistics_part *parts,
                              const struct statistics_part *start, int count,
                              const struct statistics_mixing *mixing,
                              struct statistics *out)
{
    double e[FIGURES];
    struct part *own = find_parts(start, count, e);
    measure(parts, count, &(struct origin){start, own, e, mixing}, out);
    mem_free(own);
}

/* --- checkpoints ------------------------------------------------------------------- */

void statistics_pack(struct pack *pack, struct statistics *s)
{
    struct {
        const char *name;
        double *value;
    } figures[] = {
        {"eta_s", &s->eta_s},
        {"eta_s_se", &s->eta_s_se},
        {"eta_s_freedom", &s->eta_s_freedom},
        {"eta_l", &s->eta_l},
        {"eta_l_se", &s->eta_l_se},
        {"eta_l_freedom", &s->eta_l_freedom},
        {"eta_0", &s->eta_0},
        {"eta_0_se", &s->eta_0_se},
        {"eta_0_freedom", &s->eta_0_freedom},
        {"z_small", &s->z_small},
        {"r", &s->r},
        {"r_se", &s->r_se},
        {"r_freedom", &s->r_freedom},
        {"r_lo", &s->r_lo},
        {"r_hi", &s->r_hi},
        {"q", &s->q},
        {"q_se", &s->q_se},
        {"q_freedom", &s->q_freedom},
        {"acceptance", &s->acceptance},
        {"acceptance_se", &s->acceptance_se},
        {"acceptance_freedom", &s->acceptance_freedom},
        {"failure_rate", &s->failure_rate},
        {"failure_rate_se", &s->failure_rate_se},
        {"failure_rate_freedom", &s->failure_rate_freedom},
        {"seeds", &s->seeds},
    };
    for (size_t i = 0; i < sizeof figures / sizeof *figures; i++)
        pack_double(pack, figures[i].name, figures[i].value);
    pack_int64s(pack, "small", &s->small, 1);
    pack_int64s(pack, "large", &s->large, 1);
}

/* The asymptotic variance of a chain's picture for every p_l from tapes at p_l = p0.
 *
 * From state x, a large step is accepted with probability a(x), which depends on the
 * target alone (large_acceptance.h); the landing has the density nu = pi a / eta_l. If
 * every landing is replaced by an independent one with that density, the chain
 * regenerates at accepted large steps [Mykland95]: what lies between two is a tour, and
 * the sums over tours are independent. Within a tour the chain visits states x_0, x_1,
 * ... A visit lasts for K rejected large steps and ends with a local step (which may stay
 * where it is, and begins the next visit) or an accepted large step. With
 *   e = 1 - p (1 - a)   probability that a mutation ends the visit,
 *   P(K = k) = (1 - e)^k e,
 *   s = (1 - p) / e     probability that a local step ends it,
 * X_i the splats of visit i in pixel j by their expected values, and visits that occur
 * pi e times a mutation, the variance of a pixel's sum, per mutation, is
 *   sigma_j^2(p) = E_pi[e X^2] + 2 E_pi[sum over k > i of e_i X_i s_i ... s_(k-1) X_k]
 * of X less its mean: the first term is `self`, the second `pair`. A local step from x
 * with acceptance alpha of y gives, by expected values,
 *   X = (K rho + 1 - alpha) g(x) + alpha g(y),
 * and an accepted large one (K rho + lambda) g(x), with g = F / (f + p b) (kelemen;
 * plain: F / f), rho = E_u[(1 - a_u)^2] / (1 - a) and lambda = E_u[(1 - a_u) a_u] / a. A
 * large proposal u adds (1 + a_u) g(u) (plain: a_u g(u)): its variance to the self term,
 * and if it is accepted, a first summand to its tour.
 *
 * The tape was recorded at p0. A visit that ends with a local step is seen (1 - p0) pi
 * times a mutation. So a visit that is seen has the weight e / (1 - p0), and a pair i < k
 * of which all visits i..k are seen the weight
 *   (1 - p) / (1 - p0) * product over i < l < k of s_l / s0_l * 1 / s0_k,
 * by which expectations at p0 become those at p. Backwards sums B_j over the visits of
 * the tour give all pairs in one pass: B <- B s / s0 + (1 - p)/(1 - p0) E[X | local].
 *
 * Second stages: after a large step without a contribution, of probability p z, the chain
 * moves by a second proposal, which is a local step too. It is narrower than a small
 * step, so that the chain explores more slowly where many local steps are of that kind.
 * Local steps of all kinds are taken to have one kernel and a speed each, the mean of
 * acceptance times width^2; the chain at p to be that at p0 with local steps of the
 * probability l(p) = (1 - p + p z) at p0, else in proportion to 1 - p + p z speed, and
 * the rest 1 - p + p z - l(p), which may be negative, to stay where it is. Then e = l(p)
 * + p a,   s = l(p) / e, and what the visit stays has the mean sum (p E_u[(1 - a_u)^2,
 * f(u) > 0] + rest) / e, K rho above. Exact weights for every local step between two
 * visits, p / p0 or (1 - p) / (1 - p0) by its kind, are of no use: where steps are many,
 * their products tell nothing.
 */

#include "chain/tours.h"

#include "base/mem.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#define P TOURS_POINTS
/* s / s0 at least, as it is 0 at p = 1. */
#define LEAST_STEP 1e-12

const double tours_p[P] = {0.01, 0.02, 0.04, 0.07, 0.1, 0.15, 0.2, 0.25,
                           0.3,  0.4,  0.5,  0.6,  0.7, 0.8,  0.9, 1.0};

#define C TOURS_CUTS

/* Sums of the visits of a tour in one pixel, times 1 / product of s / s0; [c]: of those
 * in the present one of 2^c pieces of the tape. */
struct pixel_sums {
    double of[C][P];
};

struct tours_scratch {
    int32_t *slots;          /* [pixels], valid if owners[slot] is the pixel */
    int32_t *owners;         /* [most] */
    struct pixel_sums *sums; /* [most] */
    size_t count, most;      /* pixels of the present tour; that a tour has at most */
};

static void arrays(struct tours_scratch *scratch, long pixels, long splats,
                   struct mem_plan *plan)
{
    scratch->most = (size_t)(splats < pixels ? splats : pixels);
    scratch->slots = mem_take(plan, 0, (size_t)pixels, sizeof *scratch->slots);
    scratch->owners = mem_take(plan, 0, scratch->most, sizeof *scratch->owners);
    scratch->sums = mem_take(plan, 0, scratch->most, sizeof *scratch->sums);
}

struct tours_scratch *tours_scratch_create(long pixels, long splats)
{
    struct tours_scratch *scratch = mem_alloc(1, sizeof *scratch);
    arrays(scratch, pixels, splats, &(struct mem_plan){.take = true});
    return scratch;
}

void tours_scratch_destroy(struct tours_scratch *scratch)
{
    if (!scratch)
        return;
    mem_free(scratch->slots);
    mem_free(scratch->owners);
    mem_free(scratch->sums);
    mem_free(scratch);
}

double tours_scratch_bytes(long pixels, long splats, double *untouched)
{
    struct tours_scratch scratch;
    struct mem_plan plan = {.take = false};
    arrays(&scratch, pixels, splats, &plan);
    *untouched = (double)scratch.most * (sizeof *scratch.owners + sizeof *scratch.sums);
    return plan.bytes;
}

static struct pixel_sums *sums_of(struct tours_scratch *t, int32_t pixel)
{
    size_t slot = (size_t)t->slots[pixel];
    if (slot < t->count && t->owners[slot] == pixel)
        return &t->sums[slot];
    assert(t->count < t->most);
    t->slots[pixel] = (int32_t)t->count;
    t->owners[t->count] = pixel;
    t->sums[t->count] = (struct pixel_sums){{{0.0}}};
    return &t->sums[t->count++];
}

/* What a visit's state has for all p. */
struct visit {
    double e[P], s[P], ratio[P]; /* ratio: (1/e) / (1/e0) of the transition weights */
    double stays[P], squares[P]; /* K rho: mean and second moment */
    double weight[P];            /* 1 / (f + p b) */
    double lambda, s0;
};

/* As fmax, which is a call. */
static double at_least(double x, double least)
{
    return x > least ? x : least;
}

struct pass {
    const struct tours_target *target;
    const struct tours_pixels *pixels;
    struct tours_scratch *scratch;
    struct tours_sums *out;
    const struct tape_splat *current, *next; /* splats of the state, of the proposal */
    int current_count, next_count;
    double current_target, next_target;
    double square;
    struct visit visit;
    double decay[P];                  /* product of s / s0 since the tour began */
    double first[C][P], second[C][P]; /* sums B of the counts and of the mean terms */
};

static void splat_weights(const struct tours_target *t, double f, double out[P])
{
    for (int i = 0; i < P; i++)
        out[i] = 1.0 /
                 (f + (t->estimator == ESTIMATOR_KELEMEN ? tours_p[i] * t->b : 0.0));
}

/* Probability that a mutation is a local step; l(p). */
static double local_steps(const struct tours_target *t, double p)
{
    return 1.0 - p + p * t->failing;
}

static double local_share(const struct tours_target *t, double p)
{
    double slow = t->failing * t->speed;
    return local_steps(t, t->p0) * (1.0 - p + p * slow) / (1.0 - t->p0 + t->p0 * slow);
}

static void enter(struct pass *w)
{
    const struct tours_target *t = w->target;
    struct visit *v = &w->visit;
    double a, a2;
    large_acceptance_at(t->acceptance, w->current_target, &a, &a2);
    double e0 = at_least(local_share(t, t->p0) + t->p0 * a, 1e-9),
           hit = 1.0 - a - t->failing;
    double stays = at_least(1.0 - 2.0 * a + a2 - t->failing, 0.0);
    double rho = hit > 1e-9 ? stays / hit : 0.0;
    v->lambda = a > 0.0 ? (a - a2) / a : 0.0;
    v->s0 = local_share(t, t->p0) / e0;
    splat_weights(t, w->current_target, v->weight);
    for (int i = 0; i < P; i++) {
        double p = tours_p[i], local = local_share(t, p),
               e = at_least(local + p * a, 1e-9);
        double rest = local_steps(t, p) - local;
        v->e[i] = e;
        v->s[i] = local / e;
        v->ratio[i] = e0 / e;
        v->stays[i] = (p * stays + rest) / e;
        v->squares[i] = 2.0 * v->stays[i] * v->stays[i] + (p * stays * rho + rest) / e;
    }
}

static void begin_tour(struct pass *w)
{
    w->scratch->count = 0;
    w->out->tours += 1.0;
    for (int i = 0; i < P; i++)
        w->decay[i] = 1.0;
    memset(w->first, 0, sizeof w->first);
    memset(w->second, 0, sizeof w->second);
}

/* Begins another piece. */
static void begin_piece(struct pass *w, int cut)
{
    for (size_t k = 0; k < w->scratch->count; k++)
        memset(w->scratch->sums[k].of[cut], 0, sizeof w->scratch->sums[k].of[cut]);
    memset(w->first[cut], 0, sizeof w->first[cut]);
    memset(w->second[cut], 0, sizeof w->second[cut]);
}

/* Keeps the sums in the range of double: multiplies them by `decay` where that has become
 * small or great. */
static void rescale(struct pass *w)
{
    for (int i = 0; i < P; i++) {
        double by = w->decay[i];
        if (by > 1e-60 && by < 1e60)
            continue;
        for (int c = 0; c < C; c++) {
            for (size_t k = 0; k < w->scratch->count; k++)
                w->scratch->sums[k].of[c][i] *= by;
            w->first[c][i] *= by;
            w->second[c][i] *= by;
        }
        w->decay[i] = 1.0;
    }
}

/* Sum of the products of splats with the pixels' means. */
static double mean_term(const struct pass *w, const struct tape_splat *splats, int count)
{
    double sum = 0.0;
    for (int k = 0; k < count; k++) {
        int tile = tours_tile_of(w->pixels, splats[k].pixel);
        sum += (double)(splats[k].luminance * w->pixels->scale[tile] *
                        w->pixels->mean[tile]);
    }
    return sum * w->target->b * w->target->share;
}

static double amplitude(const struct pass *w, const struct tape_splat *s)
{
    float scale = w->pixels->scale[tours_tile_of(w->pixels, s->pixel)];
    return (double)(s->luminance * scale) * w->target->b;
}

static double splat_on(const struct pass *w, const struct tape_splat *splats, int count,
                       int32_t pixel)
{
    for (int k = 0; k < count; k++)
        if (splats[k].pixel == pixel)
            return amplitude(w, &splats[k]);
    return 0.0;
}

/* Coefficients of a visit: X in pixel j has the mean x fx + y fy, given a local event
 * (local) and at all (any), and the second moment xx fx^2 + 2 xy fx fy + yy fy^2. */
struct moments {
    double local_x[P], local_y[P], any_x[P], any_y[P], xx[P], xy[P], yy[P];
};

static void find_moments(const struct visit *v, double alpha, const double next[P],
                         struct moments *m)
{
    for (int i = 0; i < P; i++) {
        double s = v->s[i], x = v->weight[i], y = alpha * next[i], stay = 1.0 - alpha;
        double k = v->stays[i], l = v->lambda;
        double last = s * stay + (1.0 - s) * l;
        m->local_x[i] = (k + stay) * x;
        m->local_y[i] = y;
        m->any_x[i] = (k + last) * x;
        m->any_y[i] = s * y;
        m->xx[i] = (v->squares[i] + 2.0 * k * last + s * stay * stay +
                    (1.0 - s) * l * l) *
                   x * x;
        m->xy[i] = s * (k + stay) * x * y;
        m->yy[i] = s * y * y;
    }
}

/* The products of the visit's splats fx, fy in one pixel with themselves and with the
 * tour's. */
static void add_pixel(const struct moments *restrict m, double fx, double fy,
                      struct pixel_sums *restrict sums, const double *restrict gain,
                      double *restrict self, double (*restrict pair)[P])
{
    for (int i = 0; i < P; i++)
        self[i] += m->xx[i] * fx * fx + 2.0 * m->xy[i] * fx * fy + m->yy[i] * fy * fy;
    for (int c = 0; c < C; c++)
        for (int i = 0; i < P; i++) {
            pair[c][i] += (m->any_x[i] * fx + m->any_y[i] * fy) * sums->of[c][i];
            sums->of[c][i] += gain[i] * (m->local_x[i] * fx + m->local_y[i] * fy);
        }
}

/* Terms of the means: products with the number of mutations, which is K + 1. */
static void add_means(struct pass *restrict w, const struct moments *restrict m,
                      const double *restrict gain, const double *restrict self,
                      double (*restrict pair)[P], double local0)
{
    struct tours_sums *restrict out = w->out;
    const struct visit *v = &w->visit;
    double ux = mean_term(w, w->current, w->current_count);
    double uy = mean_term(w, w->next, w->next_count);
    double fx = w->current_target, fy = w->next_target;
    double any[P], local[P];
    for (int i = 0; i < P; i++) {
        double e = v->e[i], weight = e / local0;
        any[i] = m->any_x[i] * ux + m->any_y[i] * uy;
        local[i] = m->local_x[i] * ux + m->local_y[i] * uy;
        double counted = (v->stays[i] * v->weight[i] * ux + any[i]) / e;
        out->self[0][i] += weight * self[i];
        out->self[1][i] -= weight * 2.0 * counted;
        out->self[2][i] += weight * w->square * (2.0 - e) / (e * e);
        out->mean[i] += weight * (m->any_x[i] * fx + m->any_y[i] * fy);
    }
    for (int c = 0; c < C; c++)
        for (int i = 0; i < P; i++) {
            double e = v->e[i], twice = 2.0 * w->decay[i] / v->s0;
            out->pair[c][0][i] += twice * pair[c][i];
            out->pair[c][1][i] -= twice * (w->second[c][i] / e + w->first[c][i] * any[i]);
            out->pair[c][2][i] += twice * w->first[c][i] * w->square / e;
            w->first[c][i] += gain[i] / e;
            w->second[c][i] += gain[i] * local[i];
        }
}

static void add_local(struct pass *w, const struct tape_record *r)
{
    const struct tours_target *t = w->target;
    const struct visit *v = &w->visit;
    double next[P], gain[P], self[P] = {0}, pair[C][P] = {{0}}, factor[P];
    double alpha = (double)r->acceptance, local0 = local_share(t, t->p0);
    struct moments m;
    splat_weights(t, r->target > 0.0 ? r->target : 1.0, next);
    find_moments(v, r->target > 0.0 ? alpha : 0.0, next, &m);
    for (int i = 0; i < P; i++) {
        factor[i] = local_share(t, tours_p[i]) / local0;
        double step = at_least(factor[i] * v->ratio[i], LEAST_STEP);
        gain[i] = factor[i] / (w->decay[i] * step);
    }
    for (int k = 0; k < w->current_count; k++) {
        int32_t pixel = w->current[k].pixel;
        add_pixel(&m, amplitude(w, &w->current[k]),
                  splat_on(w, w->next, w->next_count, pixel), sums_of(w->scratch, pixel),
                  gain, self, pair);
    }
    for (int k = 0; k < w->next_count; k++) {
        int32_t pixel = w->next[k].pixel;
        if (splat_on(w, w->current, w->current_count, pixel) == 0.0)
            add_pixel(&m, 0.0, amplitude(w, &w->next[k]), sums_of(w->scratch, pixel),
                      gain, self, pair);
    }
    add_means(w, &m, gain, self, pair, local0);
    for (int i = 0; i < P; i++)
        w->decay[i] *= at_least(factor[i] * v->ratio[i], LEAST_STEP);
    rescale(w);
    w->out->visits += 1.0;
}

/* A large proposal: an independent sample, and if it is accepted the first summand of the
 * next tour. */
static void add_large(struct pass *w, const struct tape_record *r)
{
    const struct tours_target *t = w->target;
    double weight[P], alpha = (double)r->acceptance;
    double times = t->estimator == ESTIMATOR_KELEMEN ? 1.0 + alpha : alpha;
    if (r->accepted)
        begin_tour(w);
    if (!(r->target > 0.0))
        return;
    splat_weights(t, r->target, weight);
    double squares = 0.0, mean = mean_term(w, w->next, w->next_count);
    for (int k = 0; k < w->next_count; k++)
        squares += amplitude(w, &w->next[k]) * amplitude(w, &w->next[k]);
    for (int i = 0; i < P; i++) {
        double factor = tours_p[i] / t->p0, x = times * weight[i];
        w->out->self[0][i] += factor * x * x * squares;
        if (!r->accepted) {
            w->out->rejected[i] += factor * x * r->target;
        } else {
            w->out->mean[i] += factor * x * r->target;
            for (int c = 0; c < C; c++)
                w->second[c][i] += factor * x * mean;
        }
    }
    for (int k = 0; k < w->next_count && r->accepted; k++) {
        struct pixel_sums *sums = sums_of(w->scratch, w->next[k].pixel);
        double f = amplitude(w, &w->next[k]);
        for (int c = 0; c < C; c++)
            for (int i = 0; i < P; i++)
                sums->of[c][i] += tours_p[i] / t->p0 * times * weight[i] * f;
    }
}

void tours_add_moves(const struct tape *tape, double second_stage, double sums[2][2])
{
    for (long i = 1; i < tape->count; i++) {
        const struct tape_record *r = &tape->records[i];
        double width = r->event == TAPE_LOCAL ? 1.0 : second_stage;
        double *of = sums[r->event == TAPE_AFTER_LARGE];
        if (r->event == TAPE_LARGE)
            continue;
        of[0] += 1.0;
        of[1] += (double)r->acceptance * width * width;
    }
}

static void move(struct pass *w)
{
    w->current = w->next;
    w->current_count = w->next_count;
    w->current_target = w->next_target;
    if (w->current_target > 0.0)
        enter(w);
}

void tours_add(const struct tape *tape, const struct tours_target *target,
               const struct tours_pixels *pixels, double square,
               struct tours_scratch *scratch, struct tours_sums *out)
{
    struct pass w = {.target = target,
                     .pixels = pixels,
                     .scratch = scratch,
                     .out = out,
                     .square = square,
                     .next = tape->splats};
    out->square = square;
    begin_tour(&w);
    for (long i = 0; i < tape->count; i++) {
        const struct tape_record *r = &tape->records[i];
        for (int c = 1; c < C && i > 0; c++)
            if ((i << c) / tape->count != ((i - 1) << c) / tape->count)
                begin_piece(&w, c);
        w.next_count = r->splats;
        w.next_target = r->target;
        if (i > 0 && w.current_target > 0.0) {
            out->mutations += 1.0;
            if (r->event == TAPE_LARGE)
                add_large(&w, r);
            else
                add_local(&w, r);
        }
        if (r->accepted)
            move(&w);
        w.next += r->splats;
    }
}

#ifndef ETALON_TESTS_SUPPORT_MATRIX_TOY_H
#define ETALON_TESTS_SUPPORT_MATRIX_TOY_H

/* Toy chains on MATRIX_STATES states on a circle, whose asymptotic variance follows from
 * their transition matrices. A pixel is MATRIX_STATES / MATRIX_PIXELS neighbouring
 * states; local steps are wrapped normal, large steps uniform; splats by expected values,
 * as chain/step.h has them. */

#include "chain/tours_choose.h"
#include "math/rng.h"

#include <math.h>
#include <string.h>

#define MATRIX_STATES 120
#define MATRIX_PIXELS 24
#define MATRIX_FLOOR  0.01 /* of relMSE, times the mean brightness squared */

struct matrix_toy {
    int count;                /* states with a positive target */
    int place[MATRIX_STATES]; /* on the circle */
    int pixel[MATRIX_STATES];
    double f[MATRIX_STATES], pi[MATRIX_STATES], b;
    double q[MATRIX_STATES][MATRIX_STATES]; /* local proposals; rows sum to <= 1 */
    double eta_s, eta_l, eta_0;
    enum estimator estimator;
    bool second; /* a local step follows a large one to a state of target 0 */
};

/* targets[MATRIX_STATES]; sigma: width of local steps, 1 is the whole circle. */
static inline void matrix_toy_init(struct matrix_toy *toy, const double *targets,
                                   double sigma, enum estimator estimator)
{
    double sum = 0.0;
    memset(toy, 0, sizeof *toy);
    toy->estimator = estimator;
    for (int i = 0; i < MATRIX_STATES; i++) {
        if (!(targets[i] > 0.0))
            continue;
        toy->place[toy->count] = i;
        toy->pixel[toy->count] = i * MATRIX_PIXELS / MATRIX_STATES;
        toy->f[toy->count++] = targets[i];
        sum += targets[i];
    }
    toy->b = sum / MATRIX_STATES;
    toy->eta_0 = (double)toy->count / MATRIX_STATES;
    for (int i = 0; i < toy->count; i++) {
        double kernel[MATRIX_STATES], all = 0.0;
        toy->pi[i] = toy->f[i] / sum;
        for (int j = 0; j < MATRIX_STATES; j++) {
            double d = (double)(j - toy->place[i]) / MATRIX_STATES;
            d = (d - rint(d)) / sigma;
            all += kernel[j] = exp(-0.5 * d * d);
        }
        for (int j = 0; j < toy->count; j++) {
            double a = fmin(1.0, toy->f[j] / toy->f[i]);
            toy->q[i][j] = kernel[toy->place[j]] / all;
            toy->eta_s += toy->pi[i] * toy->q[i][j] * a;
            toy->eta_l += toy->pi[i] * a / MATRIX_STATES;
        }
    }
}

/* Probability that a mutation ends with a local proposal. */
static inline double matrix_toy_local(const struct matrix_toy *toy, double p)
{
    return 1.0 - p + (toy->second ? p * (1.0 - toy->eta_0) : 0.0);
}

/* P of the chain at p. */
static inline void matrix_toy_transitions(const struct matrix_toy *toy, double p,
                                          double P[MATRIX_STATES][MATRIX_STATES])
{
    for (int i = 0; i < toy->count; i++) {
        double left = 0.0;
        for (int j = 0; j < toy->count; j++) {
            double a = fmin(1.0, toy->f[j] / toy->f[i]);
            P[i][j] = (matrix_toy_local(toy, p) * toy->q[i][j] + p / MATRIX_STATES) * a;
            left += j == i ? 0.0 : P[i][j];
        }
        P[i][i] = 1.0 - left;
    }
}

static inline double matrix_toy_splat(const struct matrix_toy *toy, int i, double p)
{
    return toy->f[i] /
           (toy->f[i] + (toy->estimator == ESTIMATOR_KELEMEN ? p * toy->b : 0.0));
}

/* Solves A X = R for `columns` columns that follow A in its rows. */
static inline void matrix_toy_solve(int n, int columns,
                                    double A[][MATRIX_STATES + MATRIX_PIXELS])
{
    int width = n + columns;
    for (int c = 0; c < n; c++) {
        int best = c;
        for (int r = c + 1; r < n; r++)
            best = fabs(A[r][c]) > fabs(A[best][c]) ? r : best;
        for (int k = c; k < width && best != c; k++) {
            double t = A[best][k];
            A[best][k] = A[c][k];
            A[c][k] = t;
        }
        for (int r = 0; r < n; r++) {
            double g = r == c ? 0.0 : A[r][c] / A[c][c];
            for (int k = c; k < width && g != 0.0; k++)
                A[r][k] -= g * A[c][k];
        }
    }
    for (int c = 0; c < n; c++)
        for (int k = n; k < width; k++)
            A[c][k] /= A[c][c];
}

/* E[(r + Phi(x') - Phi(x))^2] of one kind of proposal y from x, r the splats in pixel j
 * less their mean; large: with the splat of y as an independent sample. */
static inline double matrix_toy_jump(const struct matrix_toy *toy, int x, int y, int j,
                                     double p, double mean, bool large,
                                     double A[][MATRIX_STATES + MATRIX_PIXELS])
{
    double a = fmin(1.0, toy->f[y] / toy->f[x]);
    double gx = toy->pixel[x] == j ? matrix_toy_splat(toy, x, p) : 0.0;
    double gy = toy->pixel[y] == j ? matrix_toy_splat(toy, y, p) : 0.0;
    double r = (1.0 - a) * gx + a * gy - mean,
           d = A[y][toy->count + j] - A[x][toy->count + j];
    r += large && toy->estimator == ESTIMATOR_KELEMEN ? gy : 0.0;
    return a * (r + d) * (r + d) + (1.0 - a) * r * r;
}

/* Exact sum over pixels of the variance per mutation, weighted as in relMSE: the relMSE
 * of a long run times its mutations. By the martingale of Poisson's equation. */
static inline double matrix_toy_variance(const struct matrix_toy *toy, double p)
{
    static double P[MATRIX_STATES][MATRIX_STATES];
    static double A[MATRIX_STATES][MATRIX_STATES + MATRIX_PIXELS];
    double light[MATRIX_PIXELS] = {0.0}, states[MATRIX_PIXELS] = {0.0}, sum = 0.0;
    double large[MATRIX_PIXELS] = {0.0}, moves = matrix_toy_local(toy, p);
    int n = toy->count;
    matrix_toy_transitions(toy, p, P);
    for (int i = 0; i < n; i++) {
        light[toy->pixel[i]] += toy->pi[i];
        states[toy->pixel[i]] += toy->pi[i] * matrix_toy_splat(toy, i, p);
        if (toy->estimator == ESTIMATOR_KELEMEN)
            large[toy->pixel[i]] += p * matrix_toy_splat(toy, i, p) / MATRIX_STATES;
    }
    for (int i = 0; i < n; i++) {
        for (int k = 0; k < n; k++)
            A[i][k] = (i == k) - P[i][k] + toy->pi[k];
        for (int j = 0; j < MATRIX_PIXELS; j++)
            A[i][n + j] = -states[j];
        for (int k = 0; k < n; k++)
            A[i][n + toy->pixel[k]] += P[i][k] * matrix_toy_splat(toy, k, p);
    }
    matrix_toy_solve(n, MATRIX_PIXELS, A);
    for (int j = 0; j < MATRIX_PIXELS; j++) {
        double v = 0.0, mean = states[j] + large[j];
        for (int i = 0; i < n; i++) {
            double jumps = 0.0, local = 0.0;
            for (int k = 0; k < n; k++) {
                local += toy->q[i][k];
                jumps += moves * toy->q[i][k] *
                         matrix_toy_jump(toy, i, k, j, p, mean, false, A);
                jumps += p / MATRIX_STATES *
                         matrix_toy_jump(toy, i, k, j, p, mean, true, A);
            }
            double still = (toy->pixel[i] == j ? matrix_toy_splat(toy, i, p) : 0.0) -
                           mean;
            double missed = 1.0 - p * toy->eta_0 - moves * local;
            v += toy->pi[i] * (jumps + missed * still * still);
        }
        double relative = MATRIX_PIXELS * light[j];
        sum += MATRIX_PIXELS * v / (relative * relative + MATRIX_FLOOR);
    }
    return sum;
}

static inline int matrix_toy_draw(const double *weights, int count, double u)
{
    int i = 0;
    while (i < count - 1 && (u -= weights[i]) >= 0.0)
        i++;
    return i;
}

/* The state that is proposed from x; -1: none with a positive target. */
static inline int matrix_toy_propose(const struct matrix_toy *toy, int x, bool large,
                                     struct rng *rng)
{
    double v = rng_double(rng), local = 0.0;
    int place = (int)(v * MATRIX_STATES);
    for (int k = 0; k < toy->count; k++) {
        if (large ? toy->place[k] == place : v < local + toy->q[x][k])
            return k;
        local += toy->q[x][k];
    }
    return -1;
}

/* Runs one chain at p0 from a state of its stationary law and records it. */
static inline void matrix_toy_record(const struct matrix_toy *toy, double p0,
                                     long mutations, double u, struct rng *rng,
                                     struct tape *tape)
{
    struct contrib y;
    contrib_init(&y, 1);
    int x = matrix_toy_draw(toy->pi, toy->count, u);
    contrib_clear(&y);
    contrib_add(&y, toy->pixel[x], rgb_grey(toy->f[x]), 0, 0);
    tape_begin(tape, &y);
    for (long i = 0; i < mutations; i++) {
        bool large = rng_double(rng) < p0;
        int next = matrix_toy_propose(toy, x, large, rng);
        double a = 0.0;
        enum tape_event event = large ? TAPE_LARGE : TAPE_LOCAL;
        if (large && next < 0 && toy->second) {
            next = matrix_toy_propose(toy, x, false, rng);
            event = TAPE_AFTER_LARGE;
        }
        contrib_clear(&y);
        if (next >= 0) {
            contrib_add(&y, toy->pixel[next], rgb_grey(toy->f[next]), 0, 0);
            a = fmin(1.0, toy->f[next] / toy->f[x]);
        }
        bool accepted = rng_double(rng) < a;
        tape_work(tape, large, 1.0, 1.0);
        tape_record(tape, event, &y, a, accepted);
        x = accepted ? next : x;
    }
    contrib_deinit(&y);
}

/* The rule, from `chains` tapes of `mutations` each. sums[chains]. */
static inline void matrix_toy_sum(const struct matrix_toy *toy, double p0, int chains,
                                  long mutations, uint64_t seed, struct tours_sums *sums)
{
    static struct large_acceptance acceptance;
    float scale[MATRIX_PIXELS], mean[MATRIX_PIXELS];
    double light[MATRIX_PIXELS] = {0.0}, targets[MATRIX_STATES] = {0.0}, square = 0.0;
    struct rng rng;
    rng_init(&rng, seed, RNG_TEST, 0);
    for (int i = 0; i < toy->count; i++)
        targets[toy->place[i]] = toy->f[i];
    large_acceptance_build(&acceptance, targets, MATRIX_STATES); /* every state once */
    for (int i = 0; i < toy->count; i++)
        light[toy->pixel[i]] += MATRIX_PIXELS * toy->pi[i] * toy->b;
    for (int j = 0; j < MATRIX_PIXELS; j++) {
        double w = 1.0 / (light[j] * light[j] + MATRIX_FLOOR * toy->b * toy->b);
        scale[j] = (float)sqrt(MATRIX_PIXELS * w);
        mean[j] = (float)(light[j] * sqrt(w / MATRIX_PIXELS));
        square += (double)(mean[j] * mean[j]);
    }
    double failing = toy->second ? 1.0 - toy->eta_0 : 0.0;
    struct tours_target target = {&acceptance, toy->estimator, toy->b, p0,
                                  1.0,         failing,        1.0};
    struct tours_pixels pixels = {MATRIX_PIXELS, 0, MATRIX_PIXELS, scale, mean};
    struct tours_scratch *scratch = tours_scratch_create(MATRIX_PIXELS, MATRIX_PIXELS);
    double u = rng_double(&rng);
    memset(sums, 0, (size_t)chains * sizeof *sums);
    for (int c = 0; c < chains; c++) {
        struct tape tape;
        tape_init(&tape, mutations, 1);
        matrix_toy_record(toy, p0, mutations, (c + u) / chains, &rng, &tape);
        tours_add(&tape, &target, &pixels, square, scratch, &sums[c]);
        tape_deinit(&tape);
    }
    tours_scratch_destroy(scratch);
}

#endif

/* The sum over pairs as a function of the length of a tape.
 *
 * Pairs of a lag of l visits have the sum (1 - l/n) c(l) on a tape of n visits. What
 * c(l) is made of: the correlation of splats in a pixel l small steps apart, and the
 * probability that no large step was accepted between. A tape shorter than the stays of
 * stuck chains shows neither in full, and the mean acceptance of large steps tells
 * little: a few bright states, from which large steps are hardly ever accepted, make
 * most of the sum. The growth with n shows what is needed. It is modelled by
 *   c(l) = u l^-beta / (1 + l t rate),   t = p / (1 - p),
 * a correlation that falls like a power (of many time scales none stands out), and
 * survival of l visits with probability prod 1 / (1 + t a), for an acceptance a that has
 * an exponential distribution of mean `rate` over the pairs. u is free for each p; beta
 * and rate hold for all p, so that large p, where tours end within the tape, tell how
 * those at small p will end.
 *
 * Of a grid of beta and rate every model is weighed by exp(-chi^2 / 2), chi^2 from the
 * growth between pieces of n/8, n/4, n/2 and n visits, the mean over p, as the noise at
 * all p is the same chains'. Longer pieces are fewer, so that the variance of their
 * growth is in proportion to their length; its scale is NOISE, where pairs are most of
 * the variance, and greater where they are a small part of it. The mean over models
 * depends smoothly on the data, which the best model does not. */

#include "chain/tours_end.h"

#include "base/mem.h"

#include <float.h>
#include <math.h>

#define P     TOURS_POINTS
#define C     TOURS_CUTS
#define BETAS 13 /* 0 to 1.8 */
#define RATES 14 /* 2^-12 to 2 */
#define NOISE \
    0.1 /* standard deviation of the growth's logarithm, from n/8 to n/4 times 2 */
#define BLOCKS_MOST 128
#define BLOCK_GROWS                                                    \
    1.2 /* lags of a block: the next begins at so many times its begin \
         */
#define P_MOST 0.95

struct tours_end {
    double sums[BETAS][RATES][P][C + 1]; /* logarithms; [C]: of the whole run */
};

/* Blocks of lags: their number of lags, the mean lag, and correlations by model. */
struct blocks {
    int count;
    double begin[BLOCKS_MOST + 1];
    double lag[BLOCKS_MOST], correlation[BETAS][BLOCKS_MOST];
};

static void make_blocks(double most, struct blocks *blocks)
{
    int n = 0;
    blocks->begin[0] = 1.0;
    while (n < BLOCKS_MOST && blocks->begin[n] <= most) {
        double begin = blocks->begin[n];
        double end = fmax(begin + 1.0, floor(begin * BLOCK_GROWS));
        blocks->begin[n + 1] = end;
        blocks->lag[n] = 0.5 * (begin + end - 1.0);
        for (int b = 0; b < BETAS; b++)
            blocks->correlation[b][n] = pow(blocks->lag[n], -0.15 * b);
        n++;
    }
    blocks->count = n;
}

/* Terms (1 - l/n) l^-beta of the sums over lags up to n, without survival. */
static void set_terms(const struct blocks *blocks, int beta, double n,
                      double out[BLOCKS_MOST])
{
    for (int k = 0; k < blocks->count; k++) {
        double begin = blocks->begin[k];
        double end = fmin(blocks->begin[k + 1], floor(n) + 1.0);
        double lag = 0.5 * (begin + end - 1.0);
        out[k] = begin <= n ? (end - begin) * fmax(1.0 - lag / n, 0.0) *
                                  blocks->correlation[beta][k]
                            : 0.0;
    }
}

/* Survival of visits at tours_p[i], for each rate. */
static void set_survival(const struct blocks *blocks, int i,
                         double out[RATES][BLOCKS_MOST])
{
    double p = fmin(tours_p[i], P_MOST);
    for (int r = 0; r < RATES; r++) {
        double hazard = ldexp(p / (1.0 - p), r - 12);
        for (int k = 0; k < blocks->count; k++)
            out[r][k] = 1.0 / (1.0 + hazard * blocks->lag[k]);
    }
}

static void set_models(struct tours_end *end, const struct blocks *blocks, int i,
                       const double lengths[C + 1])
{
    double survival[RATES][BLOCKS_MOST], terms[BLOCKS_MOST];
    set_survival(blocks, i, survival);
    for (int b = 0; b < BETAS; b++)
        for (int c = 0; c <= C; c++) {
            set_terms(blocks, b, lengths[c], terms);
            for (int r = 0; r < RATES; r++) {
                double sum = 0.0;
                for (int k = 0; k < blocks->count; k++)
                    sum += terms[k] * survival[r][k];
                end->sums[b][r][i][c] = log(fmax(sum, DBL_MIN));
            }
        }
}

struct tours_end *tours_end_create(double visits, const double whole[TOURS_POINTS])
{
    struct tours_end *end = mem_alloc(1, sizeof *end);
    struct blocks *blocks = mem_alloc(1, sizeof *blocks);
    double lengths[C + 1], most = visits;
    for (int i = 0; i < P; i++)
        most = fmax(most, whole[i]);
    make_blocks(most, blocks);
    for (int i = 0; i < P; i++) {
        for (int c = 0; c < C; c++)
            lengths[c] = fmax(ldexp(visits, -c), 2.0);
        lengths[C] = fmax(whole[i], lengths[0]);
        set_models(end, blocks, i, lengths);
    }
    mem_free(blocks);
    return end;
}

void tours_end_destroy(struct tours_end *end)
{
    mem_free(end);
}

double tours_end_bytes(void)
{
    return (double)sizeof(struct tours_end);
}

/* Growth of ln pair between pieces, and the weights of the points. */
struct growth {
    double ln[C][P], weight[P];
};

static bool measure(double pair[C][P], const double self[P], struct growth *growth)
{
    double sum = 0.0;
    for (int i = TOURS_END_FIRST; i <= TOURS_END_LAST; i++) {
        double share = pair[0][i] / (self[i] + pair[0][i]);
        growth->weight[i] = share;
        for (int c = 0; c < C; c++)
            if (!(pair[c][i] > 0.0 && self[i] > 0.0))
                growth->weight[i] = 0.0;
        for (int c = 0; c < C - 1 && growth->weight[i] > 0.0; c++)
            growth->ln[c][i] = log(pair[c][i] / pair[c + 1][i]);
        sum += growth->weight[i];
    }
    return sum > 0.0;
}

static double chi_square(const double model[P][C + 1], const struct growth *growth)
{
    double sum = 0.0;
    for (int i = TOURS_END_FIRST; i <= TOURS_END_LAST; i++)
        for (int c = 0; c < C - 1 && growth->weight[i] > 0.0; c++) {
            double d = growth->ln[c][i] - (model[i][c] - model[i][c + 1]);
            sum += growth->weight[i] * ldexp(d * d, c);
        }
    return sum / (TOURS_END_LAST - TOURS_END_FIRST + 1) / (NOISE * NOISE);
}

void tours_end_extrapolate(const struct tours_end *end,
                           double pair[TOURS_CUTS][TOURS_POINTS],
                           const double self[TOURS_POINTS], double factor[TOURS_POINTS],
                           double spread[TOURS_POINTS])
{
    struct growth growth = {{{0.0}}, {0.0}};
    double chi[BETAS][RATES], least = HUGE_VAL, all = 0.0;
    double mean[P] = {0.0}, square[P] = {0.0};
    bool grows = measure(pair, self, &growth);
    for (int b = 0; b < BETAS; b++)
        for (int r = 0; r < RATES; r++) {
            chi[b][r] = chi_square(end->sums[b][r], &growth);
            least = fmin(least, chi[b][r]);
        }
    for (int b = 0; b < BETAS; b++)
        for (int r = 0; r < RATES; r++) {
            double weight = exp(0.5 * (least - chi[b][r]));
            all += weight;
            for (int i = 0; i < P; i++) {
                double add = end->sums[b][r][i][C] - end->sums[b][r][i][0];
                mean[i] += weight * add;
                square[i] += weight * add * add;
            }
        }
    for (int i = 0; i < P; i++) {
        double m = mean[i] / all;
        factor[i] = grows ? exp(m) : 1.0;
        spread[i] = grows ? sqrt(fmax(square[i] / all - m * m, 0.0)) : 0.0;
    }
}

#ifndef ETALON_IMAGE_NOISE_H
#define ETALON_IMAGE_NOISE_H

/* Noise of a picture that is the mean of two independent ones, and the weights by which
 * it is measured.
 *
 * Let A and B be pictures with the same expectation t and independent errors, m = (A+B)/2
 * and d = (A-B)/2. Then E[d^2] = Var m, whatever the law of the errors is. relMSE weighs
 * a pixel by 1/(m^2 + 0.01). The mean of d^2/(m^2 + 0.01) is not the mean of (m-t)^2/(m^2
 * + 0.01), as m and d^2 are not independent: where both halves are low, the weight is
 * high and d is small. Pictures are not negative, so that |d| <= m and d^2/(m^2 + 0.01) <
 * 1, however wrong m is.
 *
 * So noise has another weight here:
 *
 *   w_j = 1/(q_j^2 + 0.01), q_j = max(n_j, m_j/2), n_j = mean of m over the (up to eight)
 *   neighbours of pixel j
 *
 * for each channel. If the errors of different pixels are independent, n_j and d_j are
 * too, and where q_j = n_j, E[w_j d_j^2] = E[w_j] Var m_j for any law of the errors. The
 * pixel's own value counts only where it is more than twice the neighbours' mean. Without
 * that a single bright pixel between dark ones decides the mean: on scenes/door at 75x50
 * one had 91 % of it, and the noise was 0.0236 +- 0.021 where runs have a relMSE of
 * 0.004. Measured on scenes/glass-caustic, halves by bdpt, against ten (24) times as many
 * samples: at 210x140 and 96 samples a pixel each half the noise is 0 % +- 1 % off E[w
 * (m-t)^2], the pixel's own weight 18 % +- 1.5 % below it; at 75x50 and 256 samples 12 %
 * +- 8 % and 15 % +- 7 % below.
 *
 * analysis/analysis_split.h takes the same weights for variance and bias. In pictures by
 * Markov chains neighbours have correlated errors, and independence is approximate.
 *
 * The noise's exact part of relMSE as image/metric.h defines it is E[(m-t)^2/(m^2 +
 * 0.01)], with the weight of the reference's own pixel, which no two halves tell. There
 * it was 0.0049 (own weight: 0.0040, these weights: 0.0057) and 0.0025 (0.0021, 0.0029);
 * against the truth, E[(m-t)^2/(t^2 + 0.01)], 0.0065 and 0.0028. Trimmed it was 0.00293
 * and 0.00130, and told were 0.00266 and 0.00123: m-t has the longer tail of the two, and
 * more of it is cut. */

#include "base/err.h"
#include "image/image.h"

struct noise {
    double rmse;           /* root of the mean of d^2 */
    double relmse;         /* mean of w d^2 */
    double relmse_se;      /* its standard error, if errors of pixels are independent */
    double relmse_trimmed; /* the same without the pixels that have the highest, as many
                            * as image/metric.h leaves out */
};

/* w_j of pixel (x, y) and channel. Neighbours that are not finite are left out; without
 * any, q_j = m_j. */
double noise_weight(const struct image *mean, int x, int y, int channel);

/* The noise of `mean`, from itself and one of its halves: half - mean is +-d. Pixels that
 * are not finite in either are left out. False if the sizes differ or no pixel is finite
 * in both. */
bool noise_of_mean(const struct image *half, const struct image *mean,
                   struct noise *noise, struct err *err);

#endif

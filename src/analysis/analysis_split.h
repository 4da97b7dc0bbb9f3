#ifndef ETALON_ANALYSIS_ANALYSIS_SPLIT_H
#define ETALON_ANALYSIS_ANALYSIS_SPLIT_H

/* Error as bias and variance, from the n pictures of a cell's seeds. With <.> the mean
 * over pixels and channels of squares weighted as in image/noise.h (as relMSE, but by a
 * pixel's neighbours in the reference), m the mean picture, s^2 the pixels' variance over
 * seeds and N the reference's own noise, from its halves,
 *
 *   variance = <s^2>                       of one run
 *   bias^2   = <(m - r)^2> - <s^2>/n - N   may come out negative
 *   total    = bias^2 + variance + N       exactly, of these pictures
 *
 * All three have the same weights, which are independent of the pixel's own errors, and
 * are unbiased: E<(m - r)^2> = <bias^2> + <Var x>/n + <Var r>. The weights of relMSE
 * itself, 1/(r^2 + 0.01), are not independent of r: they make N too small and the rest of
 * <(m - r)^2>, which then passes for a bias, too large. So `total` is not the relMSE of
 * the tables.
 *
 * Standard errors by the jackknife over at least three seeds [Efron82]; to that of bias^2
 * comes the error of N. Two seeds have none: there it is from blocks of pixels
 * (analysis/pixel_blocks.h), and no test is made. In 10000 simulated cases of six seeds,
 * the t intervals contained the variance in 95 % and a bias in 97 %, and an absent bias
 * was called significant in 1.3 %.
 *
 * On scenes/glass-caustic (210x140, six runs of mmlt, 128 mutations per pixel) bias^2
 * came out as .0001 to .0008, +- .0005 each, against five references of two times 96
 * samples, and as .0003 +- .0002 against one of ten times as many. By relMSE's own
 * weights it was .0006 to .0009 against the former, and .0002 against the latter. */

#include "base/err.h"
#include "image/noise.h"
#include "lab/reference.h"
#include "analysis/results.h"

#define ANALYSIS_SPLIT_SEEDS 3 /* the fewest with an error from their spread */

struct analysis_split {
    double total, total_se; /* mean over seeds, with N in it */
    double bias2, bias2_se;
    double variance, variance_se;
    double noise; /* N; 0 if it is not known */
    bool noise_is_known;
    bool
        errors_from_blocks; /* two seeds: the standard errors are from blocks of pixels */
    bool bias_is_significant; /* bias^2 > 0, one-sided t-test at 5 % */
    double bias2_hi;          /* upper end of the 95 % t interval of bias^2; or NaN */
    size_t seeds;             /* pictures; below 2 all is NaN */
    long nonfinite;           /* pixels left out: not finite in one of them */
};

/* The split itself: pictures[n] and reference of one size. noise: NULL or NAN if it is
 * not known. */
bool analysis_split_pictures(const struct image *const *pictures, size_t n,
                             const struct image *reference, const struct noise *noise,
                             struct analysis_split *split, struct err *err);

/* Reads the pictures of the cell. reference may be NULL: then the one that the cell names
 * is read. False with the reason if a picture cannot be read, or if the tables do not
 * name a reference. */
bool analysis_split_cell(const struct results *results, const struct results_cell *cell,
                         const struct reference *reference, struct analysis_split *split,
                         struct err *err);

#endif

#ifndef ETALON_CHAIN_TOURS_H
#define ETALON_CHAIN_TOURS_H

/* The variance that a chain's picture would have at any p_l, from tapes of chains that
 * ran at another, p0. See tours.c for the derivation. */

#include "chain/estimator.h"
#include "chain/large_acceptance.h"
#include "chain/tape.h"

/* The values of p_l at which the curve is computed. */
#define TOURS_POINTS 16
extern const double tours_p[TOURS_POINTS];

/* Pairs of visits are summed four times: of whole tapes, and of tapes cut into two, four
 * and eight pieces, as if each piece were a tape. How the sum grows with the length of a
 * piece tells what the pairs beyond the tapes' ends add (chain/tours_end.h). */
#define TOURS_CUTS 4

/* Weights of pixels j with brightness I_j, of N, in square tiles of 2^shift pixels each
 * way: the variance s_j^2 of pixel j adds s_j^2 / (I_j^2 + e) / N to relMSE. */
struct tours_pixels {
    int width, shift, across; /* pixels in a line of the film, tiles in a line of these */
    const float *scale;       /* [tiles], sqrt(N / (I_j^2 + e)) */
    const float *mean;        /* [tiles], I_j / sqrt(N (I_j^2 + e)) */
};

static inline int tours_tile_of(const struct tours_pixels *pixels, int32_t pixel)
{
    int y = pixel / pixels->width, x = pixel - y * pixels->width;
    return (y >> pixels->shift) * pixels->across + (x >> pixels->shift);
}

/* The chains of one normalisation b. */
struct tours_target {
    const struct large_acceptance *acceptance;
    enum estimator estimator;
    double b, p0;
    double share;   /* of these chains in the brightness of the whole picture */
    double failing; /* share of large steps after which there is a second stage */
    double speed;   /* of local steps after these, relative to those of small steps */
};

/* Sums over the visits of one chain, for all p: a quadratic function of the factor theta
 * by which the pixels' means are subtracted, [0] + [1] theta + [2] theta^2. */
struct tours_sums {
    double mutations, visits, tours; /* recorded mutations; tours begun */
    double self[3][TOURS_POINTS];
    double pair[TOURS_CUTS][3][TOURS_POINTS]; /* [c]: of 2^c pieces */
    double mean[TOURS_POINTS]; /* sum of the splats over that of plain ones */
    /* The same of rejected large proposals, which are no part of tours; and the sum over
     * pixels of the squares of their means. */
    double rejected[TOURS_POINTS], square;
};

/* Sums over the local steps of a tape, [0] small ones with what follows them, [1] those
 * after large ones: their number, and their acceptance times the square of their width;
 * second_stage: that width, of small steps 1. speed = (sums[1][1] / sums[1][0]) /
 * (sums[0][1] / sums[0][0]). */
void tours_add_moves(const struct tape *tape, double second_stage, double sums[2][2]);

/* Scratch of one thread, for tapes of at most so many splats. The sums of pairs have 516
 * bytes for each pixel that a tour can reach; those that no tour reaches stay untouched.
 */
struct tours_scratch;
struct tours_scratch *tours_scratch_create(long pixels, long splats);
void tours_scratch_destroy(struct tours_scratch *scratch);
/* untouched: those of them that short tours leave untouched. */
double tours_scratch_bytes(long pixels, long splats, double *untouched);

/* square: sum over pixels of mean^2 times share^2. */
void tours_add(const struct tape *tape, const struct tours_target *target,
               const struct tours_pixels *pixels, double square,
               struct tours_scratch *scratch, struct tours_sums *out);

#endif

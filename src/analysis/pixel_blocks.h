#ifndef ETALON_ANALYSIS_PIXEL_BLOCKS_H
#define ETALON_ANALYSIS_PIXEL_BLOCKS_H

/* The standard error of a sum over the pixels of one picture, where there are too few
 * pictures to take it from their spread: sums of blocks of 4 x 4 pixels, and the squared
 * differences of blocks that lie beside each other. A pair of blocks with the same
 * expectation has E[(a-b)^2] = Var(a+b), if their errors are independent; differences of
 * expectation make the estimate too high. What all pixels share, such as the brightness
 * of a run of chains, is not seen: there it is too low. */

#define PIXEL_BLOCK 4 /* pixels a side */

struct pixel_blocks {
    int across, down;
    double *sums; /* [down][across] */
};

void pixel_blocks_init(struct pixel_blocks *blocks, int width, int height);
void pixel_blocks_deinit(struct pixel_blocks *blocks);
void pixel_blocks_add(struct pixel_blocks *blocks, int x, int y, double value);
/* Of the sum of all that was added; NaN if there are no two blocks beside each other. */
double pixel_blocks_se(const struct pixel_blocks *blocks);

#endif

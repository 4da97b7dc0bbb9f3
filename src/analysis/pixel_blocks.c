#include "analysis/pixel_blocks.h"

#include "base/mem.h"

#include <math.h>

void pixel_blocks_init(struct pixel_blocks *blocks, int width, int height)
{
    *blocks = (struct pixel_blocks){
        .across = (width + PIXEL_BLOCK - 1) / PIXEL_BLOCK,
        .down = (height + PIXEL_BLOCK - 1) / PIXEL_BLOCK,
    };
    blocks->sums = mem_alloc((size_t)blocks->across * (size_t)blocks->down,
                             sizeof *blocks->sums);
}

void pixel_blocks_deinit(struct pixel_blocks *blocks)
{
    mem_free(blocks->sums);
    *blocks = (struct pixel_blocks){0};
}

void pixel_blocks_add(struct pixel_blocks *blocks, int x, int y, double value)
{
    blocks->sums[y / PIXEL_BLOCK * blocks->across + x / PIXEL_BLOCK] += value;
}

/* Of an odd number of blocks in a row the last has no partner; the others stand for it.
 */
double pixel_blocks_se(const struct pixel_blocks *blocks)
{
    double squares = 0.0, paired = 0.0;
    for (int v = 0; v < blocks->down; v++)
        for (int u = 0; u + 1 < blocks->across; u += 2) {
            const double *at = blocks->sums + (size_t)v * (size_t)blocks->across + u;
            squares += (at[0] - at[1]) * (at[0] - at[1]);
            paired += 2.0;
        }
    double all = (double)blocks->across * (double)blocks->down;
    return paired > 0.0 ? sqrt(squares * all / paired) : (double)NAN;
}

#ifndef ETALON_MATH_DIST_TREE_H
#define ETALON_MATH_DIST_TREE_H

/* A piecewise-constant density over the unit square that is fine only where it pays: a
 * grid of 16 x 16 cells, of which each may be divided into 8 x 8, and each of these
 * again, down to the weights' own cells and once below them where details are given. A
 * few hundred kilobytes serve for a picture of any size, and a level of a sample waits
 * for two cache lines: a row by inversion of its marginal, then a column by inversion
 * within the row [Pharr16, section 13.6.7], beside which the densities of the row lie. So
 * a sample takes constant time, and a small step of u stays small in each coordinate. The
 * density is read from one number a level.
 */

#include <stdbool.h>
#include <stddef.h>

#define DIST_TREE_ROOT  16  /* cells of the first grid along each axis */
#define DIST_TREE_SIDE  8   /* of the others */
#define DIST_TREE_NODES 512 /* most of these */

struct dist_tree {
    /* The root, then the nodes. Of each: cumulated probabilities of rows [side], then row
     * by row the cumulated probabilities of its cells [side], and for each cell [side]
     * its density, or minus the number of the node that divides it (from 1 on). */
    double *tables;
    int node_count;
};

/* What is known below the cells of the weights: fill sets the weights of the parts of
 * cell (x, y), row by row, up to a factor. Finite and >= 0. */
struct dist_tree_detail {
    void (*fill)(const struct dist_tree_detail *self, int x, int y,
                 double parts[DIST_TREE_SIDE * DIST_TREE_SIDE]);
};

/* weights [size][size], row by row; size = 16 * 8^k. A positive weight has a density,
 * unless at some level it is below about 2^-53 of its row, or its row of all rows: such a
 * share may round to 0. Weights must be finite and >= 0 with a positive, finite sum, else
 * false (and *tree is empty). detail: asked for bright cells only; NULL for none. */
bool dist_tree_build(struct dist_tree *tree, const double *weights, int size,
                     const struct dist_tree_detail *detail);
void dist_tree_deinit(struct dist_tree *tree);
/* Point in [0,1)^2. */
void dist_tree_sample(const struct dist_tree *tree, const double u[2], double point[2]);
/* u with which dist_tree_sample gives the point. False if none does. */
bool dist_tree_invert(const struct dist_tree *tree, const double point[2], double u[2]);
/* Density over [0,1)^2, with respect to which dist_tree_sample samples. */
double dist_tree_pdf(const struct dist_tree *tree, const double point[2]);
size_t dist_tree_bytes(const struct dist_tree *tree);

#endif

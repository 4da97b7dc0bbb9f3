#include "math/dist_tree.h"

#include "base/mem.h"
#include "math/warp.h"

#include <string.h>

#define ROOT DIST_TREE_ROOT
#define SIDE DIST_TREE_SIDE
#define LINE 8 /* numbers of a cache line */

#define TABLES(side) ((side) + 2 * (side) * (side)) /* numbers of a node */

/* A uniform density in a cell of probability p adds p (E[w^2] / E[w]^2 - 1) to the second
 * moment of an estimate of the sum of all weights w, which is at least 1. A cell that
 * adds less than this is not divided, unless there would be too many nodes. */
#define LEAST_EXCESS (0.05 / (ROOT * ROOT * SIDE))

/* Parts can add up to (SIDE^2 - 1) p. They cost time, so they are asked for only where
 * that is at least this many times what pays: of 10000 cells at most. */
#define DETAIL_MARGIN 256.0

struct builder {
    struct dist_tree *tree;
    const double *weights; /* of all fine cells, over their sum */
    int size;
    const struct dist_tree_detail *detail; /* or NULL */
    double least_excess;
    bool full; /* more nodes were wanted than there may be */
};

static inline double *node_tables(const struct dist_tree *tree, int node)
{
    return tree->tables + (node == 0 ? 0 : TABLES(ROOT) + (node - 1) * TABLES(SIDE));
}

/* Of row j of a node: cumulated probabilities, and densities or nodes, of its cells. */
static inline ptrdiff_t row_cumulated(int side, int j)
{
    return side + (ptrdiff_t)2 * side * j;
}

static inline ptrdiff_t row_cells(int side, int j)
{
    return row_cumulated(side, j) + side;
}

/* The square of fine cells with corner (x, y): its sum, and the sum of squares. */
static double square_sum(const struct builder *b, int x, int y, int extent,
                         double *squares)
{
    double sum = 0.0;
    *squares = 0.0;
    for (int j = y; j < y + extent; j++)
        for (int i = x; i < x + extent; i++) {
            double w = b->weights[(size_t)j * (size_t)b->size + (size_t)i];
            sum += w;
            *squares += w * w;
        }
    return sum;
}

/* Replaces weights by their cumulated shares, exactly 1 from the last positive one on. */
static void cumulate(double *table, int count)
{
    for (int i = 1; i < count; i++)
        table[i] += table[i - 1];
    double sum = table[count - 1];
    for (int i = 0; i < count && sum > 0.0; i++)
        table[i] /= sum;
}

static double share(const double *table, int i)
{
    return i > 0 ? table[i] - table[i - 1] : table[0];
}

/* Turns the rows of a node, which hold weights, into its tables of probabilities. */
static void cumulate_node(double *tables, int side)
{
    for (int j = 0; j < side; j++) {
        double *row = tables + row_cumulated(side, j);
        tables[j] = 0.0;
        for (int i = 0; i < side; i++)
            tables[j] += row[i];
        cumulate(row, side);
    }
    cumulate(tables, side);
}

/* Of the node's cell, where density is that of its whole square. */
static double cell_density(const double *tables, int side, int i, int j, double density)
{
    double p = share(tables, j) * share(tables + row_cumulated(side, j), i);
    return density * p * side * side;
}

/* The number of a new node, 0 if there are too many. */
static int new_node(struct builder *b)
{
    if (b->tree->node_count < DIST_TREE_NODES)
        return ++b->tree->node_count;
    b->full = true;
    return 0;
}

/* Divides cell (x, y) of the weights, whose density is *cell, if that pays. */
static void build_detail(struct builder *b, double *cell, int x, int y)
{
    enum { PARTS = SIDE * SIDE };
    double parts[PARTS], sum = 0.0, squares = 0.0;
    double p = b->weights[(size_t)y * (size_t)b->size + (size_t)x];
    if (!b->detail || !((PARTS - 1) * p > DETAIL_MARGIN * b->least_excess))
        return;
    b->detail->fill(b->detail, x, y, parts);
    for (int k = 0; k < PARTS; k++) {
        sum += parts[k];
        squares += parts[k] * parts[k];
    }
    if (!(p * (squares / (sum * sum) * PARTS - 1.0) > b->least_excess))
        return;
    int node = new_node(b);
    if (node == 0)
        return;
    double *tables = node_tables(b->tree, node), density = *cell;
    for (int k = 0; k < PARTS; k++)
        tables[row_cumulated(SIDE, k / SIDE) + k % SIDE] = parts[k];
    cumulate_node(tables, SIDE);
    for (int k = 0; k < PARTS; k++)
        tables[row_cells(SIDE, k / SIDE) + k % SIDE] = cell_density(
            tables, SIDE, k % SIDE, k / SIDE, density);
    *cell = -node;
}

static int build_node(struct builder *b, int node, int side, int x, int y, int extent,
                      double density);

/* Divides the cell of corner (x, y), whose density is *cell, if that pays: *cell becomes
 * minus the number of a new node. */
static void build_cell(struct builder *b, double *cell, int x, int y, int extent)
{
    if (extent == 1) {
        build_detail(b, cell, x, y);
        return;
    }
    double squares, sum = square_sum(b, x, y, extent, &squares);
    double excess = sum > 0.0 ? squares / sum * (extent * extent) - sum : 0.0;
    if (!(excess > b->least_excess))
        return;
    int node = new_node(b);
    if (node > 0)
        *cell = -build_node(b, node, SIDE, x, y, extent, *cell);
}

/* density: of the node's whole square; returns node. */
static int build_node(struct builder *b, int node, int side, int x, int y, int extent,
                      double density)
{
    double *tables = node_tables(b->tree, node), squares;
    int each = extent / side;
    for (int j = 0; j < side; j++)
        for (int i = 0; i < side; i++)
            tables[row_cumulated(side, j) + i] = square_sum(b, x + i * each, y + j * each,
                                                            each, &squares);
    cumulate_node(tables, side);
    for (int j = 0; j < side; j++)
        for (int i = 0; i < side; i++) {
            double *cell = &tables[row_cells(side, j) + i];
            *cell = cell_density(tables, side, i, j, density);
            build_cell(b, cell, x + i * each, y + j * each, each);
        }
    return node;
}

/* The weights over their sum; NULL if they do not make a distribution. */
static double *normalise(const double *weights, size_t count)
{
    double max = 0.0, sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        if (!(weights[i] >= 0.0) || isinf(weights[i]))
            return NULL;
        max = fmax(max, weights[i]);
    }
    if (!(max > 0.0))
        return NULL;
    double *normal = mem_alloc(count, sizeof *normal);
    for (size_t i = 0; i < count; i++)
        sum += normal[i] = weights[i] / max;
    for (size_t i = 0; i < count; i++)
        normal[i] /= sum;
    return normal;
}

/* Gives back what the nodes do not use. */
static void shrink(struct dist_tree *tree)
{
    size_t bytes = dist_tree_bytes(tree);
    double *tables = mem_aligned(64, bytes / sizeof *tables, sizeof *tables);
    memcpy(tables, tree->tables, bytes);
    mem_free(tree->tables);
    tree->tables = tables;
}

bool dist_tree_build(struct dist_tree *tree, const double *weights, int size,
                     const struct dist_tree_detail *detail)
{
    size_t most = TABLES(ROOT) + DIST_TREE_NODES * TABLES(SIDE);
    *tree = (struct dist_tree){0};
    double *normal = normalise(weights, (size_t)size * (size_t)size);
    if (!normal)
        return false;
    tree->tables = mem_aligned(64, most, sizeof *tree->tables);
    struct builder b = {tree, normal, size, detail, LEAST_EXCESS, true};
    for (; b.full; b.least_excess *= 2.0) {
        b.full = false;
        tree->node_count = 0;
        build_node(&b, 0, ROOT, 0, 0, size, 1.0);
    }
    mem_free(normal);
    shrink(tree);
    return true;
}

void dist_tree_deinit(struct dist_tree *tree)
{
    mem_free(tree->tables);
    *tree = (struct dist_tree){0};
}

/* The first entry above u, which has a positive share; *u: rescaled within it. */
static inline int pick(const double *table, int side, double *u)
{
    typedef double double4 __attribute__((vector_size(32), aligned(8), may_alias));
    typedef long long long4 __attribute__((vector_size(32)));
    long4 above = {0};
    for (int k = 0; k < side; k += 4)
        above += *(const double4 *)(const void *)(table + k) <= *u;
    int i = -(int)(above[0] + above[1] + above[2] + above[3]); /* true is -1 */
    double below = i > 0 ? table[i - 1] : 0.0;
    double x = (*u - below) / (table[i] - below);
    *u = x < WARP_BELOW_ONE ? x : WARP_BELOW_ONE;
    return i;
}

/* Cell of a node; returns its density, or minus its node. */
static inline double pick_cell(const double *tables, int side, double u[2], int cell[2])
{
    cell[1] = pick(tables, side, &u[1]);
    const double *row = tables + row_cumulated(side, cell[1]), *cells = row + side;
    for (int k = 0; k < side; k += LINE)
        __builtin_prefetch(cells + k); /* while the row is awaited and searched */
    cell[0] = pick(row, side, &u[0]);
    return cells[cell[0]];
}

void dist_tree_sample(const struct dist_tree *tree, const double u[2], double point[2])
{
    double rest[2] = {u[0], u[1]};
    int cell[2], at[2], size = ROOT;
    double found = pick_cell(tree->tables, ROOT, rest, at);
    while (found < 0.0) {
        found = pick_cell(node_tables(tree, (int)-found), SIDE, rest, cell);
        size *= SIDE;
        for (int k = 0; k < 2; k++)
            at[k] = at[k] * SIDE + cell[k];
    }
    /* Sizes are powers of two: only the sum is rounded, and not to the next cell. */
    for (int k = 0; k < 2; k++) {
        double p = (at[k] + rest[k]) / size;
        point[k] = p < (at[k] + 1.0) / size ? p : nextafter(p, 0.0);
    }
}

static inline double cell_at(const double *tables, int side, double at[2])
{
    int x = (int)(at[0] * side), y = (int)(at[1] * side);
    at[0] = at[0] * side - x;
    at[1] = at[1] * side - y;
    return tables[row_cells(side, y) + x];
}

double dist_tree_pdf(const struct dist_tree *tree, const double point[2])
{
    double at[2] = {point[0], point[1]};
    double found = cell_at(tree->tables, ROOT, at);
    while (found < 0.0)
        found = cell_at(node_tables(tree, (int)-found), SIDE, at);
    return found;
}

/* Narrows [lo, lo + width) to the numbers of which pick takes entry i. */
static void narrow(const double *table, int i, double *lo, double *width)
{
    *lo += *width * (i > 0 ? table[i - 1] : 0.0);
    *width *= share(table, i);
}

bool dist_tree_invert(const struct dist_tree *tree, const double point[2], double u[2])
{
    double at[2] = {point[0], point[1]}, lo[2] = {0.0, 0.0}, width[2] = {1.0, 1.0};
    double found = 0.0;
    if (!warp_in_square(point))
        return false;
    for (int side = ROOT; side == ROOT || found < 0.0; side = SIDE) {
        const double *tables = node_tables(tree, (int)-found);
        int x = (int)(at[0] * side), y = (int)(at[1] * side);
        narrow(tables, y, &lo[1], &width[1]);
        narrow(tables + row_cumulated(side, y), x, &lo[0], &width[0]);
        found = cell_at(tables, side, at);
    }
    for (int k = 0; k < 2; k++)
        u[k] = warp_within(lo[k], lo[k] + width[k], at[k]);
    return width[0] > 0.0 && width[1] > 0.0 && warp_in_square(u);
}

size_t dist_tree_bytes(const struct dist_tree *tree)
{
    size_t count = TABLES(ROOT) + (size_t)tree->node_count * TABLES(SIDE);
    return tree->tables ? count * sizeof *tree->tables : 0;
}

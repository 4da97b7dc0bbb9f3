#ifndef ETALON_MATH_DIST_H
#define ETALON_MATH_DIST_H

/* Discrete (1D) and piecewise-constant (2D) distributions by inversion: monotone in u,
 * so that a small step of a chain stays small. */

#include <stdbool.h>

struct dist {
    int count;
    double sum;  /* of the weights given */
    double *cdf; /* [count+1], 0 .. 1 */
};

/* Weights must be finite and >= 0 with a positive sum, else false. */
bool dist_build(struct dist *dist, const double *weights, int count);
void dist_deinit(struct dist *dist);
double dist_pdf(const struct dist *dist, int index); /* probability */
/* Index with its probability; *rest (may be NULL) is u rescaled to [0,1) within it. */
int dist_sample(const struct dist *dist, double u, double *probability, double *rest);

struct dist2 {
    int width, height;
    struct dist rows, *columns; /* rows picks y, columns[y] picks x */
};
bool dist2_build(struct dist2 *dist, const double *weights, int width, int height);
void dist2_deinit(struct dist2 *dist);
/* Point in [0,1)^2 with its density over [0,1)^2. */
void dist2_sample(const struct dist2 *dist, const double u[2], double point[2],
                  double *pdf);
double dist2_pdf(const struct dist2 *dist, const double point[2]);

#endif

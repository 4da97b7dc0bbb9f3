#ifndef ETALON_IMAGE_FLIP_FILTER_H
#define ETALON_IMAGE_FLIP_FILTER_H

/* Filters of pictures that are products of a row and a column, for FLIP. */

#define FLIP_RADIUS_MOST 15

struct flip_filter {
    int radius; /* pixels */
    float weights[2 * FLIP_RADIUS_MOST + 1];
};

/* exp(-x^2 / (2 sd^2)), x in pixels; returns its sum, by which the weights are divided.
 */
double flip_gaussian(struct flip_filter *filter, int radius, double sd);
/* The first (order 1) or second derivative of a Gaussian, positive weights summing to 1
 * and negative ones to -1. */
void flip_derivative(struct flip_filter *filter, int radius, double sd, int order);

/* Filters a plane, [height][width]; the border repeats. scratch: a plane. in and out may
 * be the same. */
void flip_filter(const struct flip_filter *rows, const struct flip_filter *columns,
                 int width, int height, const float *in, float *scratch, float *out);

#endif

#ifndef ETALON_INTEGRATOR_RACE_MOMENTS_H
#define ETALON_INTEGRATOR_RACE_MOMENTS_H

/* How much greater pt's error is than that of bdpt, from samples of bdpt. A few samples
 * of pt tell it only if they meet the light that makes the error; bdpt's meet it by
 * another technique.
 *
 * Let v = w_t f / p_t be the contribution of a path by technique t, w_t = p_t / P the
 * balance heuristic, P the sum of the densities of all techniques [Veach97 Eq. 9.8].
 * bdpt's second moment is E[sum of v^2] = integral of f^2 / P, if what the techniques of
 * one sample have in common is left out. pt has the techniques s <= 1 alone, with the
 * summed density Q = (w_0 + w_1) P, so its second moment is
 *
 *     integral of f^2 / Q = E[sum of v^2 / (w_0 + w_1)]
 *
 * by the same samples. Of a path by a technique s >= 2 with weight w, w_0 + w_1 <= 1 - w;
 * of one by s <= 1 it is at most 1. With these bounds in place of w_0 + w_1 the ratio is
 * a lower bound, 1 at least. Second moments are near to variances where errors are
 * large. */

#include "scene/scene.h"

#include <stdint.h>

/* Ratio of the second moments of `count` samples of paths of at most `depth` edges, v
 * times scale[pixel]; 1 if no light is found. */
double race_moments(const struct scene *scene, int depth, uint64_t seed, long count,
                    const float *scale);

#endif

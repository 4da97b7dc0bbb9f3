#ifndef ETALON_PATH_ESTIMATE_ROULETTE_H
#define ETALON_PATH_ESTIMATE_ROULETTE_H

/* Russian roulette on the shadow rays of bdpt. A sample of bdpt has up to one connection
 * for each pair of vertices, most of which carry next to nothing, and the visibility of
 * each costs a ray. So all are first made without a test. With C_i the luminance that
 * connection i would splat if it were visible, and S their sum, which includes what needs
 * no such test, connection i is tested with probability
 *     q_i = min(1, K C_i / S),
 * and its value is divided by q_i: the mean is that of testing all [Veach97, section
 * 10.3.3 uses a fixed C_min in place of S / K]. At most K tests are made on average
 * beside the certain ones, and the relative variance that this adds to S is at most 1/K,
 * as sum C_i^2 (1/q_i - 1) <= sum C_i S / K. S and q_i depend on the numbers of the
 * sample alone, and one number more decides, so the contribution is a function of the
 * numbers, as chains want it. Decisions are systematic: connection i is tested if an
 * integer lies in the interval of length q_i that follows those of the connections before
 * it, the first of which begins at the number. */

#include "path/connect.h"

/* A connection that waits for its test. */
struct pending {
    struct connection x;
    double size;   /* C_i */
    double chance; /* q_i */
    int s, t;
    struct ray_endpoint y;
};

struct roulette {
    double rays; /* K */
    int count;
    struct pending pending[];
};

/* y: the end of the connection on the light's side; the other is the camera sub-path's
 * vertex t. */
void roulette_add(struct roulette *roulette, const struct connection *x, int s, int t,
                  const struct ray_endpoint *y);
/* Keeps those that are to be tested, in their order, and sets their chances; values are
 * the caller's to divide.
 * certain: the luminance of what is not pending. */
void roulette_choose(struct roulette *roulette, double certain, struct ustream *connect);

#endif

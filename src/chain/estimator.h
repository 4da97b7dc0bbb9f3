#ifndef ETALON_CHAIN_ESTIMATOR_H
#define ETALON_CHAIN_ESTIMATOR_H

/* How splats of a chain become a picture. After M mutations in all, N pixels, with films
 * of the splats times splat_weight:
 *
 *   plain:   pixel = N/M * b * states
 *   kelemen: pixel = N/M * (b * states + b0 * large)
 *
 * For `states` M is the number of states: without tally.excluded and without second
 * stages. */

enum estimator { ESTIMATOR_KELEMEN, ESTIMATOR_PLAIN };

/* Parameters that all chains of a phase share; constant within a round. */
struct chain_params {
    double p_large; /* probability of a large step */
    double b0;      /* kelemen: guess of b, >= 0 */
    enum estimator estimator;
};

/* Weight of the splats F of a state with target I, by its expected value: plain: 1/I;
 * kelemen: 1/(I + p_l b0), that is [Kelemen02]'s 1/(I/b0 + p_l) over b0, which the
 * factors b and b0 of the films above make up for. */
double splat_weight(const struct chain_params *params, double target);

#endif

#ifndef ETALON_INTEGRATOR_MARKOV_ERRORS_H
#define ETALON_INTEGRATOR_MARKOV_ERRORS_H

/* Error bars of the picture from the replicas. */

#include "integrator/markov/markov_state.h"

/* Sets out->deviations for the current picture; valid until the next call. */
void markov_errors_find(struct markov *m, struct evidence *out);
void markov_errors_destroy(struct errors *e);
/* Luminance that the chains' films contribute to a pixel. */
double markov_errors_value(const struct errors *e, long pixel);

#endif

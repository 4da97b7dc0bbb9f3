#ifndef ETALON_INTEGRATOR_MARKOV_ERRORS_H
#define ETALON_INTEGRATOR_MARKOV_ERRORS_H

/* Of the picture, from the replicas. */

#include "integrator/markov/markov_state.h"

/* Of the picture as it is, to be asked for by pixel through *out, until the next one. */
void markov_errors_find(struct markov *m, struct evidence *out);
void markov_errors_destroy(struct errors *e);
/* Luminance of the chain films' part of the picture. */
double markov_errors_value(const struct errors *e, long pixel);

#endif

#ifndef ETALON_INTEGRATOR_MARKOV_RESULT_H
#define ETALON_INTEGRATOR_MARKOV_RESULT_H

/* The functions of struct integrator_methods of the same names. */

#include "integrator/integrator.h"

void markov_picture(void *self, struct image *out);
void markov_layers(void *self, struct layers *out);
void markov_statistics(const void *self, struct run_statistics *out);

#endif

#ifndef ETALON_INTEGRATOR_MARKOV_RESULT_H
#define ETALON_INTEGRATOR_MARKOV_RESULT_H

/* The functions of struct integrator_methods of the same names. */

#include "image/film.h"
#include "integrator/integrator.h"

void markov_picture(void *self, struct image *out);
/* markov_layers.c. */
void markov_layers(void *self, struct layers *out);
/* sum[pixels][3] += scale * film. */
void markov_add_film(double *sum, const struct film *film, long pixels, double scale);
void markov_statistics(const void *self, struct run_statistics *out);
void markov_counts(const void *self, struct run_counts *out);

#endif

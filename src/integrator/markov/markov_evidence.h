#ifndef ETALON_INTEGRATOR_MARKOV_EVIDENCE_H
#define ETALON_INTEGRATOR_MARKOV_EVIDENCE_H

/* The evidence of a run for its verdict (integrator_methods.evidence). */

#include "convergence/verdict.h"

void markov_evidence(void *self, struct evidence *out);

#endif

#ifndef ETALON_INTEGRATOR_MARKOV_EVIDENCE_H
#define ETALON_INTEGRATOR_MARKOV_EVIDENCE_H

/* What a run shows for and against its convergence (integrator_methods.evidence). */

#include "convergence/verdict.h"

void markov_evidence(void *self, struct evidence *out);

#endif

#ifndef ETALON_INTEGRATOR_MARKOV_PACK_H
#define ETALON_INTEGRATOR_MARKOV_PACK_H

/* Writes a run to a checkpoint or reads it (integrator_methods.pack). */

#include "base/pack.h"

void markov_pack(void *self, struct pack *pack);

#endif

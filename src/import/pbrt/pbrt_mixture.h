#ifndef ETALON_IMPORT_PBRT_MIXTURE_H
#define ETALON_IMPORT_PBRT_MIXTURE_H

/* Materials made of others. */

#include "import/pbrt/pbrt_state.h"

/* The material "mix", from p->params. */
bool pbrt_mixture_mix(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                      struct err *err);
/* A material with an alpha mask; *index: in the desc. */
bool pbrt_mixture_masked(struct pbrt *p, int material, const struct texture *alpha,
                         int *index, struct err *err);

#endif

#ifndef ETALON_CHAIN_TARGET_H
#define ETALON_CHAIN_TARGET_H

/* What a chain samples: numbers in, contribution out. A chain knows no scene; a toy
 * density in [0,1]^d is as good a target as a renderer. Independent numbers give what the
 * bootstrap and large steps are: samples whose mean is b. */

#include "image/contrib.h"
#include "math/ustream.h"

struct target {
    /* Fills *out (cleared by the callee); out->target is the chain's scalar f(u) >= 0. */
    void (*eval)(void *ctx, const struct numbers *numbers, struct contrib *out);
    void *ctx; /* scratch of one thread; a state type may know more of it */
};

#endif

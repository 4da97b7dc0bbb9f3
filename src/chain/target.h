#ifndef ETALON_CHAIN_TARGET_H
#define ETALON_CHAIN_TARGET_H

/* What a chain samples: numbers in, contribution out. A chain knows no scene, so a toy
 * density in [0,1]^d is a valid target. With independent uniform numbers (bootstrap and
 * large steps) the targets have mean b. */

#include "image/contrib.h"
#include "math/ustream.h"

struct target {
    /* Fills *out (cleared by the callee); out->target is the chain's scalar f(u) >= 0. */
    void (*eval)(void *ctx, const struct numbers *numbers, struct contrib *out);
    void *ctx; /* scratch of one thread; a state type may know more of it */
};

#endif

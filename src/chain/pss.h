#ifndef ETALON_CHAIN_PSS_H
#define ETALON_CHAIN_PSS_H

/* The lazy primary-sample state: three streams of numbers, each number brought up to date
 * only when it is asked for (DESIGN section 2). `current` is the state of the chain,
 * `proposed` what this mutation drew from it. A number that was last touched before the
 * last accepted large step is redrawn; one that missed accepted small steps catches up.
 * The catch-up belongs to the current state and survives rejection. */

#include "chain/kernel.h"
#include "math/ustream.h"

#include <stdbool.h>

enum pss_stream_id { PSS_CAMERA, PSS_LIGHT, PSS_CONNECT, PSS_STREAMS };

struct pss;

struct pss_stream {
    struct ustream stream; /* must be first */
    struct pss *owner;
    int capacity; /* places; more is a programmer error */
    double *current, *proposed;
    int64_t *stamp;    /* accepted steps that current[i] has seen; -1: never drawn */
    uint16_t *touched; /* places asked for in this mutation */
    int touched_count;
};

struct pss {
    struct pss_stream streams[PSS_STREAMS];
    struct kernel kernel;
    struct rng *rng;    /* the chain's; another one while a seed is replayed */
    int64_t accepted;   /* accepted steps so far */
    int64_t last_large; /* `accepted` just after the last accepted large step */
    bool large;         /* this mutation is a large step */
};

void pss_init(struct pss *pss, const int capacity[PSS_STREAMS],
              const struct kernel *kernel);
void pss_deinit(struct pss *pss);
struct numbers pss_numbers(struct pss *pss);

void pss_begin(struct pss *pss, bool large, struct rng *rng);
void pss_accept(struct pss *pss);
void pss_reject(struct pss *pss);

#endif

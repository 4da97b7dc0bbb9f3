#ifndef ETALON_CONVERGENCE_REPLICAS_H
#define ETALON_CONVERGENCE_REPLICAS_H

/* Small pictures of luminance beside the film, one for each of several independent parts
 * of a run: how far they lie apart is how far the whole lies from the truth. Integer sums
 * as in film.h, in steps of 2^-30 of the caller's unit: the same bits for any number of
 * threads. Threads add to lanes of their own, or atomically where lanes take too much. */

#include "base/mem.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#define REPLICAS_ONE        0x1p30 /* steps in one unit */
#define REPLICAS_LIMIT      0x1p52 /* a splat beyond this many steps is clamped */
#define REPLICAS_SMALL      0x1p10 /* one of fewer steps is rounded at random */
#define REPLICAS_BINS       64
#define REPLICAS_BIAS       1023 /* exponent of one step */
#define REPLICAS_MOST       64
#define REPLICAS_BYTES      0x1p30 /* what they may take */
#define REPLICAS_LANE_BYTES 0x1p30 /* and, with lanes, at most */
#define REPLICAS_PENDING    256    /* splats on their way */

/* What one thread adds to. Splats go anywhere in memory: held back until there are some,
 * they wait for it together. */
struct replica_lane {
    _Alignas(MEM_APART) int64_t *sums; /* [replicas][height*width] */
    bool shared;                       /* by all threads */
    int64_t base;                      /* `at` that the first of the sums is for */
    int pending_count;
    struct {
        int64_t at, steps;
    } pending[REPLICAS_PENDING];
    int64_t splats[REPLICAS_BINS]; /* by the log2 of their steps */
};

/* Replicas, each times its factor and in units of it. More than one: contrasts of a few
 * chains. */
struct replica_share {
    int64_t first; /* where the replica's pixels begin */
    double states, large;
};

struct pack;

struct replicas {
    int width, height, count;
    struct replica_lane *lanes; /* [threads] */
    int threads;
};

/* `count` replicas, or as many as REPLICAS_BYTES hold. lanes: wanted, if they fit. */
struct replicas *replicas_create(int width, int height, int count, int threads,
                                 bool lanes);
void replicas_destroy(struct replicas *r);
/* How many replicas there would be, and what they would take. */
int replicas_that_fit(int width, int height, int count);
double replicas_bytes(int width, int height, int count, int threads, bool lanes);

/* The rare cases of replica_add: a whole number of steps. What is beyond the limit or no
 * number the film has counted. A small splat is rounded down or up with the probability
 * that makes it right on average: were the light of a dim pixel rounded off, no part
 * would show any of its error. */
double replica_clamp_or_round(int64_t at, double steps, uint64_t random_bits);

/* To the sums what is held back. A thread does so when it has added what it had to. */
void replica_flush(struct replica_lane *lane);

/* Adds to a pixel of a replica; `steps` = luminance in steps. random_bits: bits that are
 * others for every splat, whatever thread makes it (a word of its stream's state will
 * do). */
static inline void replica_add(struct replica_lane *lane, int64_t at, double steps,
                               uint64_t random_bits)
{
    double size = fabs(steps);
    if (!(size <= REPLICAS_LIMIT && size >= REPLICAS_SMALL))
        steps = replica_clamp_or_round(at, steps, random_bits);
    int i = lane->pending_count++;
    lane->pending[i].at = at;
    lane->pending[i].steps = (int64_t)(steps + copysign(0.5, steps));
    if (lane->pending_count == REPLICAS_PENDING)
        replica_flush(lane);
}

/* Keeps books of how bright splats are, by the exponent of `steps` > 0. */
static inline void replica_count_brightness(struct replica_lane *lane, double steps)
{
    uint64_t bits;
    memcpy(&bits, &steps, sizeof bits);
    uint64_t exponent = bits >> 52 & 0x7ff;
    uint64_t bin = exponent < REPLICAS_BIAS ? 0 : exponent - REPLICAS_BIAS;
    lane->splats[bin < REPLICAS_BINS ? bin : REPLICAS_BINS - 1]++;
}

/* Adds all of `from`, which has one replica, to one of `into`, which has one lane, and
 * empties it. */
void replicas_move(struct replicas *into, int replica, struct replicas *from);

/* Sum of a pixel over the lanes, in units. Not concurrent with replica_add. */
double replicas_value(const struct replicas *r, int replica, long pixel);
/* Share of all that was added in the brightest `share` of the splats; NAN: nothing was.
 */
double replicas_top(const struct replicas *r, double share);
/* To or from a checkpoint (base/pack.h); all is in the first lane then. */
void replicas_pack(struct pack *pack, struct replicas *r);

#endif

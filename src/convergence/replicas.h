#ifndef ETALON_CONVERGENCE_REPLICAS_H
#define ETALON_CONVERGENCE_REPLICAS_H

/* Luminance pictures of several independent parts of a run, kept beside the film. The
 * spread between them estimates the error of the whole picture. Sums are integers as in
 * film.h, in steps of 2^-30 of the caller's unit, so their bits do not depend on the
 * number of threads. Each thread adds to a lane of its own; where lanes would take too
 * much memory, all threads add atomically to one. */

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
#define REPLICAS_BYTES      0x1p30 /* memory for the sums of all replicas */
#define REPLICAS_LANE_BYTES 0x1p30 /* memory for the sums with one lane a thread */
#define REPLICAS_PENDING    256    /* size of a lane's queue of splats */

/* What one thread adds to. Splats go to random places in memory; they are queued and
 * added together, so that their cache misses overlap. */
struct replica_lane {
    _Alignas(MEM_APART) int64_t *sums; /* [replicas][height*width] */
    bool shared;                       /* `sums` are shared by all threads: atomic adds */
    int64_t base;                      /* pixel index of sums[0] */
    int pending_count;
    struct {
        int64_t at, steps;
    } pending[REPLICAS_PENDING];
    int64_t splats[REPLICAS_BINS]; /* histogram of log2(steps) */
};

/* A chain's weight in a replica. A chain of a path length with fewer chains than replicas
 * adds to several, see markov_replica.c. */
struct replica_share {
    int64_t first; /* index of the replica's first pixel */
    double states, large;
};

struct pack;

struct replicas {
    int width, height, count;
    struct replica_lane *lanes; /* [threads] */
    int threads;
};

/* Creates `count` replicas, or as many as fit into REPLICAS_BYTES. lanes: one a thread if
 * they fit into REPLICAS_LANE_BYTES. */
struct replicas *replicas_create(int width, int height, int count, int threads,
                                 bool lanes);
void replicas_destroy(struct replicas *r);
/* Number of replicas that replicas_create would make, and their memory in bytes. */
int replicas_that_fit(int width, int height, int count);
double replicas_bytes(int width, int height, int count, int threads, bool lanes);

/* The rare cases of replica_add; returns a whole number of steps. A value beyond the
 * limit is clamped and a NaN becomes 0 (the film has counted both). A small value is
 * rounded up or down at random such that its expectation is right: rounding it to 0 would
 * hide the variance of dim pixels. */
double replica_clamp_or_round(int64_t at, double steps, uint64_t random_bits);

/* Adds the queued splats to the sums. Each thread calls it after its last splat. */
void replica_flush(struct replica_lane *lane);

/* Adds `steps` (luminance in steps) to a pixel of a replica. random_bits: different for
 * every splat, but independent of the thread, for example a word of the state of the
 * chain's stream. */
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

/* Counts a splat of `steps` > 0 in the histogram of brightness, by the exponent of
 * `steps`. */
static inline void replica_count_brightness(struct replica_lane *lane, double steps)
{
    uint64_t bits;
    memcpy(&bits, &steps, sizeof bits);
    uint64_t exponent = bits >> 52 & 0x7ff;
    uint64_t bin = exponent < REPLICAS_BIAS ? 0 : exponent - REPLICAS_BIAS;
    lane->splats[bin < REPLICAS_BINS ? bin : REPLICAS_BINS - 1]++;
}

/* Adds `from`, which has one replica, to replica `replica` of `into`, which has one lane,
 * and clears `from`. */
void replicas_move(struct replicas *into, int replica, struct replicas *from);

/* Sum over the lanes at a pixel, in the caller's units. Must not run while replica_add
 * does. */
double replicas_value(const struct replicas *r, int replica, long pixel);
/* Share of the total brightness that the brightest `share` of the splats hold; NAN
 * without splats. */
double replicas_top(const struct replicas *r, double share);
/* Forgets all splats. */
void replicas_clear(struct replicas *r);
/* Multiplies the sums of a replica (-1: of all), which are in the first lane, as after
 * reading. */
void replicas_scale(struct replicas *r, int replica, double factor);
/* To or from a checkpoint (base/pack.h); after reading, all sums are in the first lane.
 */
void replicas_pack(struct pack *pack, struct replicas *r);

#endif

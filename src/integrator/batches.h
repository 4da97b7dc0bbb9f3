#ifndef ETALON_INTEGRATOR_BATCHES_H
#define ETALON_INTEGRATOR_BATCHES_H

/* A run's replicas in time: brightness of the tiles of the film by replica and span of
 * the run. When BATCHES_MOST spans are full, neighbours are joined and spans to come are
 * twice as long: at any length of a run between half of that and all of it. */

#include "base/pack.h"
#include "image/replicas.h"

#define BATCHES_MOST 16
#define TILES_MOST   1024
#define TILE_LEAST   16 /* pixels each way */

struct batches {
    int tile, columns, rows, tiles; /* pixels each way, and how many */
    int replicas, count;
    double lengths[BATCHES_MOST]; /* of a span: passes, or all its brightness */
    double *sums;                 /* [BATCHES_MOST][tiles][replicas] */
    double *whole;                /* [tiles][replicas], from the beginning */
    double done, due, length;     /* last end; next end, span */
    const struct replicas *from;  /* of the scan that runs */
};

/* Pixels each way, at least `least`, of tiles of which the film has at most `most`. */
int batches_tile(int width, int height, int least, int most);
/* length: of the first spans. */
void batches_init(struct batches *b, const struct replicas *r, double length);
void batches_deinit(struct batches *b);
/* What one for so many replicas takes. */
double batches_bytes(int width, int height, int replicas);
/* To or from a checkpoint, after batches_init. */
void batches_pack(struct pack *pack, struct batches *b);
/* To be called now and then, with the length of the run so far: takes a batch if one is
 * due. own: a span's sums are told per all brightness of the span, the mean over the
 * replicas, not per length: where b is refined meanwhile, all replicas follow it alike,
 * and it is no part of theirs that changes. Not concurrent with splats. */
void batches_take(struct batches *b, const struct replicas *r, double done, bool own,
                  int threads);
/* Brightness of a tile, or of all of them (tile -1), per length or all brightness:
 * out[replicas][count]. */
void batches_sequences(const struct batches *b, int tile, double *out);

#endif

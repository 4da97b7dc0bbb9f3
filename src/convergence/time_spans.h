#ifndef ETALON_CONVERGENCE_TIME_SPANS_H
#define ETALON_CONVERGENCE_TIME_SPANS_H

/* A run's replicas in time: brightness of the tiles of the film by replica and span of
 * the run. When TIME_SPANS_MOST spans are full, neighbours are joined and spans to come
 * are twice as long: at any length of a run between half of that and all of it. */

#include "base/pack.h"
#include "convergence/replicas.h"

#define TIME_SPANS_MOST 16
#define TILES_MOST      1024
#define TILE_LEAST      16 /* pixels each way */

struct time_spans {
    int tile, columns, rows, tiles; /* pixels each way, and how many */
    int replicas, count;
    double lengths[TIME_SPANS_MOST]; /* of a span: passes, or all its brightness */
    double *sums;                    /* [TIME_SPANS_MOST][tiles][replicas] */
    double *whole;                   /* [tiles][replicas], from the beginning */
    double done, due, length;        /* last end; next end, span */
    const struct replicas *from;     /* of the scan that runs */
};

/* Pixels each way, at least `least`, of tiles of which the film has at most `most`. */
int time_spans_tile(int width, int height, int least, int most);
/* length: of the first spans. */
void time_spans_init(struct time_spans *spans, const struct replicas *r, double length);
void time_spans_deinit(struct time_spans *spans);
/* What one for so many replicas takes. */
double time_spans_bytes(int width, int height, int replicas);
/* To or from a checkpoint, after time_spans_init. */
void time_spans_pack(struct pack *pack, struct time_spans *spans);
/* To be called now and then, with the length of the run so far: takes a batch if one is
 * due. own: a span's sums are told per all brightness of the span, the mean over the
 * replicas, not per length: where b is refined meanwhile, all replicas follow it alike,
 * and it is no part of theirs that changes. Not concurrent with splats. */
void time_spans_take(struct time_spans *spans, const struct replicas *r, double done,
                     bool own, int threads);
/* Brightness of a tile, or of all of them (tile -1), per length or all brightness:
 * out[replicas][count]. */
void time_spans_sequences(const struct time_spans *spans, int tile, double *out);

#endif

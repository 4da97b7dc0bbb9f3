#ifndef ETALON_CONVERGENCE_TIME_SPANS_H
#define ETALON_CONVERGENCE_TIME_SPANS_H

/* The replicas of a run over time: brightness of each tile of the film, by replica and
 * span of time, as the sequences that R-hat compares. When TIME_SPANS_MOST spans are
 * full, neighbours are joined in pairs and later spans are twice as long; so at any time
 * there are between half of TIME_SPANS_MOST and all of them. */

#include "base/pack.h"
#include "convergence/replicas.h"

#define TIME_SPANS_MOST 16
#define TILES_MOST      1024
#define TILE_LEAST      16 /* pixels each way */

struct time_spans {
    int tile, columns, rows, tiles; /* side of a tile in pixels; numbers of tiles */
    int replicas, count;
    /* Sums since the beginning of the run, at the end of each span: integers, so those of
     * the parts of a run (base/part.h) can be added. */
    int64_t *ends;                /* [TIME_SPANS_MOST][tiles][replicas] */
    double done[TIME_SPANS_MOST]; /* length of the run at the end of each span */
    /* Divisor of each span's sums: its length, or (own) its mean brightness. */
    double lengths[TIME_SPANS_MOST];
    bool own;
    double due, length;          /* end of the next span; length of a span */
    const struct replicas *from; /* replicas being read by time_spans_take */
    bool added;                  /* spans of a part were added */
};

/* Tiles that cover so many pixels, or blocks of tiles so many tiles. */
int time_spans_across(int pixels, int tile);
/* Least tile side in pixels, not below `least`, such that the film has at most `most`
 * tiles. */
int time_spans_tile(int width, int height, int least, int most);
/* length: of the first spans, in the caller's unit. */
void time_spans_init(struct time_spans *spans, const struct replicas *r, double length);
void time_spans_deinit(struct time_spans *spans);
/* Memory in bytes. */
double time_spans_bytes(int width, int height, int replicas);
/* To or from a checkpoint, after time_spans_init. */
void time_spans_pack(struct pack *pack, struct time_spans *spans);
/* Adds the spans of a part of the run to those of other parts; where that ended earlier
 * or later (under a time budget), spans are joined and dropped until both have the same.
 */
void time_spans_add(struct time_spans *spans, struct time_spans *part);
/* Forgets the sums, but not when the spans end. */
void time_spans_clear(struct time_spans *spans);
/* Multiplies the sums of a replica (-1: of all). */
void time_spans_scale(struct time_spans *spans, int replica, double factor);
/* Called regularly with the current length `done` of the run; adds a span if one is due.
 * own: divides a span's sums by the mean brightness of that span over the replicas, not
 * by its length. For chains whose path lengths are weighted by an estimate of their
 * brightness: where that changes, it moves all replicas alike and must not look like slow
 * mixing. Must not run while splats are added. */
void time_spans_take(struct time_spans *spans, const struct replicas *r, double done,
                     bool own, int threads);
/* Brightness of a tile (-1: of the film) in each span, divided as above:
 * out[replicas][count]. */
void time_spans_sequences(const struct time_spans *spans, int tile, double *out);

#endif

#ifndef ETALON_INTEGRATOR_PASSES_STATE_H
#define ETALON_INTEGRATOR_PASSES_STATE_H

/* The internals of passes; included by passes*.c only. */

#include "base/mem.h"
#include "image/film.h"
#include "convergence/time_spans.h"
#include "integrator/light_classes.h"
#include "integrator/passes.h"
#include "math/exact_sum.h"

#include <signal.h>

/* Random numbers of one pixel's sample: the film position is drawn within the pixel. */
struct pixel_stream {
    struct ustream stream; /* must be first */
    struct ustream_random inner;
    double x, y, inverse_width, inverse_height;
    double film[2];
    /* Where events are counted: they, and how `inner` gives its numbers. */
    long events;
    const double *(*free)(struct ustream *, int place, int count);
};

struct worker {
    _Alignas(MEM_APART) struct subpaths paths;
    struct contrib contrib;
    double whole; /* target of the last sample before it was split */
    struct pixel_stream numbers;
    struct rng rng;
};

/* A row of pixels. In the incomplete pass pixels x < done have their sample. */
struct pass_row {
    uint32_t done;
    double targets; /* sum of the whole targets of these pixels */
};

/* Sums of one row over its complete passes, of T, the mean of its targets in the scale of
 * `sums`, and of T^2 / 2^20. Exact, so that those of parts of a run can be added. */
struct row_sums {
    exact_sum targets, squares;
    int64_t passes;
};

#define ROW_SQUARES 0x1p-20

struct passes {
    const struct scene *scene;
    const struct settings *settings;
    estimate_function estimate;
    const struct split *split; /* or NULL */
    int threads, width, height;
    struct worker *workers; /* [threads] */
    struct run_part part;   /* samples that are traced, see base/part.h */
    /* Camera samples, [height][width][3], in units of `scale`, a power of two. */
    exact_sum *sums;
    double scale;
    uint32_t *counts; /* [height][width], samples */
    /* Layers: light by class, and without MIS weights, [classes.count] or NULL, in
     * `unit`; of samples by pixel: r those that carry nothing, g all, b their work. */
    struct light_classes classes;
    struct film **class_films, **unweighted;
    struct film *samples;
    struct film *light;         /* NULL without a light image; in units of `unit` */
    double unit;                /* 0 until the pilot has found it */
    struct row_sums *rows;      /* [height] */
    struct pass_row *under_way; /* [height] */
    long clamped;               /* samples beyond the range of `sums` */
    long turn, stride; /* rows are traced in the order turn * stride modulo height */
    /* Passes are assigned in turn; NULL: no replicas and no spans of time. In `unit`. */
    struct replicas *replicas;
    struct replicas
        *pending; /* with `replicas`: splats of the incomplete pass, one replica */
    uint32_t *replica_rows; /* [replicas][height], complete rows in each replica */
    struct time_spans spans;
    long pass, budget;                 /* whole passes done, and budget; 0: time budget */
    double until;                      /* clock_wall() at which the current round ends */
    const volatile sig_atomic_t *stop; /* NULL, or non-zero ends it at once */
};

/* passes.c: sets the scale that goes with the unit. */
void passes_set_scale(struct passes *p);
/* passes.c: points the lanes of `pending` to the replica of the incomplete pass. */
void passes_assign_replica(struct passes *p);

static inline double passes_pixels(const struct passes *p)
{
    return (double)p->width * p->height;
}

#endif

#ifndef ETALON_INTEGRATOR_PASSES_STATE_H
#define ETALON_INTEGRATOR_PASSES_STATE_H

/* The internals of passes; included by passes*.c only. */

#include "base/mem.h"
#include "image/film.h"
#include "convergence/time_spans.h"
#include "integrator/passes.h"
#include "math/accum.h"

#include <signal.h>

/* Random numbers of one pixel's sample: the film position is drawn within the pixel. */
struct pixel_stream {
    struct ustream stream; /* must be first */
    struct ustream_random inner;
    double x, y, inverse_width, inverse_height;
    double film[2];
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

struct passes {
    const struct scene *scene;
    const struct settings *settings;
    estimate_function estimate;
    const struct split *split; /* or NULL */
    int threads, width, height;
    struct worker *workers; /* [threads] */
    double *sums;           /* [height][width][3] */
    struct film *light;     /* NULL without a light image; in units of `unit` */
    double unit;            /* 0 until the pilot has found it */
    struct welford *rows;   /* [height]: sum of the row's whole targets, over passes */
    struct pass_row *under_way; /* [height] */
    long turn, stride; /* rows are traced in the order turn * stride modulo height */
    /* Passes are assigned in turn; NULL: no replicas and no spans of time. In `unit`. */
    struct replicas *replicas;
    struct replicas
        *pending; /* with `replicas`: splats of the incomplete pass, one replica */
    struct time_spans spans;
    long pass, budget;                 /* whole passes done, and budget; 0: time budget */
    double until;                      /* clock_wall() at which the current round ends */
    const volatile sig_atomic_t *stop; /* NULL, or non-zero ends it at once */
};

/* Number of samples of pixel (x, y). */
static inline long passes_samples(const struct passes *p, int x, int y)
{
    return p->pass + ((uint32_t)x < p->under_way[y].done);
}

/* passes.c: points the lanes of `pending` to the replica of the incomplete pass. */
void passes_assign_replica(struct passes *p);

static inline double passes_pixels(const struct passes *p)
{
    return (double)p->width * p->height;
}

#endif

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

/* What a run keeps beside the picture, a film each. */
struct pass_layers {
    struct light_classes classes;
    /* [count]: light by class, in `unit`, and where it is asked for the same without MIS
     * weights, one after the other; then `samples`. */
    struct film **films;
    int count, each;      /* each: films of a class, 1 or 2 */
    struct film *samples; /* or NULL. By pixel: r samples that carry nothing, g all, b
                           * their work */
};

/* Adaptive film sampling (passes_adaptive.c): a measured start of passes of one sample a
 * pixel, then passes in which each pixel has its own number. */
struct adaptive {
    bool measuring;
    long planned;      /* passes of the start; 0: under a time budget */
    double time_began; /* clock_wall() at which the run would have begun without breaks */
    /* [height][width], measuring: sums of squared camera luminance, and of work. */
    double *squares, *work;
    struct film *light; /* measuring: splats on pixels of the colour of their sample's */
    /* Afterwards. */
    uint32_t *each;      /* [height][width], samples in a pass; NULL: one */
    long start;          /* passes before */
    double start_b;      /* brightness then, in emission units */
    double total;        /* samples in a pass */
    double light_weight; /* of light splats beside those of one sample for each pixel */
    double
        predicted; /* relMSE times work over that of uniform samples; NAN: not adapted */
    struct run_part part; /* to be set once the start is over */
};

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
    struct pass_layers layers;
    struct adaptive adaptive;
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

/* passes_trace.c: sets the scale that goes with the unit. */
void passes_set_scale(struct passes *p);
/* passes_trace.c: points the lanes of `pending` to the replica of the incomplete pass. */
void passes_assign_replica(struct passes *p);

/* passes_adaptive.c: after all else of p is there; _measure adds a sample of the start;
 * _end_pass may end the start. */
void passes_adaptive_init(struct passes *p, const struct passes_plan *plan);
void passes_adaptive_deinit(struct passes *p);
void passes_adaptive_memory(const struct scene *scene, const struct settings *settings,
                            const struct passes_plan *plan, struct run_memory *out);
void passes_measure(struct passes *p, int x, int y, int thread);
void passes_adaptive_end_pass(struct passes *p);
void passes_adaptive_pack(struct passes *p, struct pack *pack);

/* passes_result.c: mean of the film and its standard error, in emission units. */
void passes_brightness(const struct passes *p, double *b, double *b_se);

/* passes_worker.c */
void passes_worker_init(struct worker *w, const struct passes *p,
                        const struct passes_plan *plan);
double passes_worker_bytes(const struct scene *scene, const struct settings *settings,
                           const struct passes_plan *plan);
/* Whether w->numbers.events counts random events. */
void passes_worker_count(struct worker *w, bool count);
/* Leaves a sample of a pixel in w->contrib, what a split leaves of it. */
void passes_sample(const struct passes *p, struct worker *w, int x, int y,
                   enum rng_purpose purpose, long number);

/* passes_layers.c. `estimate` is replaced by one that keeps techniques apart where
 * classes of light are kept. */
void pass_layers_create(struct pass_layers *layers, const struct scene *scene,
                        const struct settings *settings, int depth,
                        estimate_function *estimate);
void pass_layers_destroy(struct pass_layers *layers);
void pass_layers_memory(const struct scene *scene, const struct settings *settings,
                        int depth, struct run_memory *out);
/* Whether settings ask for layers by class of light. */
bool pass_layers_of_classes(const struct settings *settings);
/* Adds the sample of a pixel; unit: of the films of light. Work is that of struct
 * state_type: random events and connections. */
void pass_layers_add(const struct pass_layers *layers, struct worker *w, int pixel,
                     double unit);
void pass_layers_clear(struct pass_layers *layers);
void pass_layers_pack(struct pass_layers *layers, struct pack *pack);

/* Samples that are there, without those of missing parts. */
double passes_traced(const struct passes *p);

/* Samples of a pixel in a pass. */
static inline long passes_each(const struct passes *p, long pixel)
{
    return p->adaptive.each ? (long)p->adaptive.each[pixel] : 1;
}

/* Whole passes that are alike: those after a measured start. */
static inline long passes_alike(const struct passes *p)
{
    return p->pass - p->adaptive.start;
}

static inline double passes_pixels(const struct passes *p)
{
    return (double)p->width * p->height;
}

#endif

#ifndef ETALON_TESTS_SUPPORT_TOY_TARGET_H
#define ETALON_TESTS_SUPPORT_TOY_TARGET_H

/* A density in [0,1)^d of which everything is known, as a target of chains: steps in x0
 * (some zero, neighbours up to 20 to 1) times 1 + 0.8 cos(2 pi S), S the fractional part
 * of the sum of all numbers. Given x0, S is uniform under uniform numbers if d >= 2. Cell
 * i of x0 is pixel i. */

#include "support/film_sinks.h"

#include <string.h>

#define TOY_CELLS 16
#define TOY_MAX   8
#define TOY_SWING 0.8
#define TOY_PI    3.14159265358979323846

struct toy {
    int dims;
};

static const double toy_steps[TOY_CELLS] = {0, 0, 1, 20, 3, 0, .05, .05,
                                            8, 8, 2, 0,  5, 1, .3,  4};

/* Red and blue cells in turn, so that colour over luminance varies. */
static inline struct rgb toy_color(int cell, double f)
{
    return cell % 2 ? (struct rgb){f, 0.25 * f, 0.125 * f}
                    : (struct rgb){0.125 * f, 0.5 * f, 2.0 * f};
}

/* The target of cell i, averaged over all other numbers. */
static inline double toy_cell(int cell)
{
    return rgb_luminance(toy_color(cell, toy_steps[cell]));
}

/* b: the integral of the target. */
static inline double toy_integral(void)
{
    double sum = 0.0;
    for (int i = 0; i < TOY_CELLS; i++)
        sum += toy_cell(i) / TOY_CELLS;
    return sum;
}

static inline double toy_sum(const struct toy *toy, const double *x)
{
    double sum = 0.0;
    for (int i = 0; i < toy->dims; i++)
        sum += x[i];
    return sum - floor(sum);
}

static inline void toy_fill(const struct toy *toy, const double *x, struct contrib *out)
{
    int cell = (int)(TOY_CELLS * x[0]);
    double swing = toy->dims > 1 ? 1.0 + TOY_SWING * cos(2.0 * TOY_PI * toy_sum(toy, x))
                                 : 1.0;
    contrib_clear(out);
    contrib_add(out, cell, toy_color(cell, toy_steps[cell] * swing), 0, 0);
}

/* Where number i lives: two in the camera stream, three in the light stream, the rest in
 * the connect stream, one event each. */
static inline void toy_eval(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    const struct toy *toy = ctx;
    struct ustream *streams[] = {numbers->connect, numbers->camera, numbers->light};
    const int begins[] = {5, 0, 2}, ends[] = {TOY_MAX, 2, 5};
    double x[TOY_MAX] = {0};
    for (int e = 0; e < 3; e++) {
        int end = toy->dims < ends[e] ? toy->dims : ends[e], count = end - begins[e];
        if (count <= 0)
            continue;
        memcpy(x + begins[e], ustream_take(streams[e], 0, count),
               (size_t)count * sizeof *x);
    }
    toy_fill(toy, x, out);
}

static inline double *toy_number(struct pss *pss, int i, int64_t **stamp)
{
    struct pss_stream *s = &pss->streams[i < 2   ? PSS_CAMERA
                                         : i < 5 ? PSS_LIGHT
                                                 : PSS_CONNECT];
    int place = i < 2 ? i : i < 5 ? i - 2 : i - 5;
    *stamp = &s->stamp[place];
    return &s->current[place];
}

/* One exact sample of the normalised target. */
static inline void toy_sample(const struct toy *toy, struct rng *rng, double *x)
{
    double u = rng_double(rng) * toy_integral() * TOY_CELLS, s;
    int cell = 0;
    while (u >= toy_cell(cell))
        u -= toy_cell(cell++);
    x[0] = (cell + rng_double(rng)) / TOY_CELLS;
    if (toy->dims == 1)
        return;
    do
        s = rng_double(rng);
    while (rng_double(rng) * (1.0 + TOY_SWING) >=
           1.0 + TOY_SWING * cos(2.0 * TOY_PI * s));
    for (int i = 1; i < toy->dims - 1; i++)
        x[i] = rng_double(rng);
    x[toy->dims - 1] = 0.0;
    s -= toy_sum(toy, x);
    x[toy->dims - 1] = s < 0.0 ? s + 1.0 : s;
}

static inline void toy_chain_init(struct chain *chain, const struct kernel_type *type)
{
    const int capacity[PSS_STREAMS] = {2, 3, 3};
    struct kernel kernel;
    kernel_init(&kernel, type, 0.0, 0.0, 0.0);
    pss_chain_init(chain, capacity, 1, &kernel);
}

/* Puts the chain at an exact sample of its target, with streams of their own. */
static inline void toy_start(struct chain *chain, const struct toy *toy, uint64_t seed,
                             uint64_t index)
{
    double x[TOY_MAX];
    rng_init(&chain->rng, seed, RNG_TEST, index);
    toy_sample(toy, &chain->rng, x);
    pss_reset(pss_of(chain));
    for (int i = 0; i < toy->dims; i++) {
        int64_t *stamp;
        *toy_number(pss_of(chain), i, &stamp) = x[i];
        *stamp = 0;
    }
    toy_fill(toy, x, chain->current);
    chain->tally = (struct tally){0};
    chain->pending_weight = 0.0;
}

static inline void toy_state(struct chain *chain, const struct toy *toy, double *x)
{
    int64_t *stamp;
    for (int i = 0; i < toy->dims; i++)
        x[i] = *toy_number(pss_of(chain), i, &stamp);
}

#endif

#ifndef ETALON_TESTS_SUPPORT_PF_TOY_H
#define ETALON_TESTS_SUPPORT_PF_TOY_H

/* Densities in [0,1)^d that are 0 in places, with exact formulas for Z, the probability
 * that a proposal does not fail. f is a product of factors, factor i a function of the
 * numbers 0..i; a path asks for its numbers event by event and ends at the first factor
 * 0.
 *
 * islands: one number; heights of cells, some 0.
 * penumbra: pixel x light; pixel j sees the light from u = edge_j up.
 * box: every number must stay below PF_BOX, so the path may end after any event. */

#include "support/film_sinks.h"

#include <math.h>
#include <stddef.h>

#define PF_MAX_DIMS 40
#define PF_BOX      0.9

struct pf_toy {
    int dims, per_event;
    int pixels;
    const double *table; /* [pixels], heights or edges */
    double sigma;        /* of small steps */
    double (*factor)(const struct pf_toy *toy, const double *x, int i);
    double most; /* no factor is larger */
    /* Probability that a small step from x does not fail, and that a large one does not.
     */
    double (*z_small)(const struct pf_toy *toy, const double *x);
    double eta_0;
};

/* P(a <= x + sigma N < b) on the circle. */
static inline double pf_mass(double x, double sigma, double a, double b)
{
    double sum = 0.0, scale = 1.0 / (sqrt(2.0) * sigma);
    for (int k = -1; k <= 1; k++)
        sum += 0.5 * (erf((b + k - x) * scale) - erf((a + k - x) * scale));
    return sum;
}

static inline int pf_pixel(const struct pf_toy *toy, double x)
{
    return (int)(toy->pixels * x);
}

static inline double pf_density(const struct pf_toy *toy, const double *x)
{
    double f = 1.0;
    for (int i = 0; i < toy->dims && f > 0.0; i++)
        f *= toy->factor(toy, x, i);
    return f;
}

static inline double pf_z(const struct pf_toy *toy, const double *x, double p_large)
{
    return p_large * toy->eta_0 + (1.0 - p_large) * toy->z_small(toy, x);
}

/* --- the three ---------------------------------------------------------------------- */

static inline double pf_islands_factor(const struct pf_toy *toy, const double *x, int i)
{
    return toy->table[pf_pixel(toy, x[i])];
}

static inline double pf_islands_z(const struct pf_toy *toy, const double *x)
{
    double sum = 0.0, width = 1.0 / toy->pixels;
    for (int j = 0; j < toy->pixels; j++) {
        if (toy->table[j] > 0.0)
            sum += pf_mass(x[0], toy->sigma, j * width, (j + 1) * width);
    }
    return sum;
}

static inline double pf_penumbra_factor(const struct pf_toy *toy, const double *x, int i)
{
    if (i == 0)
        return 1.0;
    return x[1] >= toy->table[pf_pixel(toy, x[0])] ? 1.0 + x[1] : 0.0;
}

static inline double pf_penumbra_z(const struct pf_toy *toy, const double *x)
{
    double sum = 0.0, width = 1.0 / toy->pixels;
    for (int j = 0; j < toy->pixels; j++) {
        double near = pf_mass(x[0], toy->sigma, j * width, (j + 1) * width);
        if (near > 1e-15)
            sum += near * pf_mass(x[1], toy->sigma, toy->table[j], 1.0);
    }
    return sum;
}

static inline double pf_box_factor(const struct pf_toy *toy, const double *x, int i)
{
    (void)toy;
    return x[i] < PF_BOX ? 1.0 + 2.0 * x[i] : 0.0;
}

static inline double pf_box_z(const struct pf_toy *toy, const double *x)
{
    double product = 1.0;
    for (int i = 0; i < toy->dims; i++)
        product *= pf_mass(x[i], toy->sigma, 0.0, PF_BOX);
    return product;
}

static inline struct pf_toy pf_islands(double sigma, const double *heights, int count)
{
    struct pf_toy toy = {
        1, 1, count, heights, sigma, pf_islands_factor, 0.0, pf_islands_z, 0.0};
    for (int i = 0; i < count; i++) {
        toy.most = fmax(toy.most, heights[i]);
        toy.eta_0 += (heights[i] > 0.0) / (double)count;
    }
    return toy;
}

static inline struct pf_toy pf_penumbra(double sigma, const double *edges, int count)
{
    struct pf_toy toy = {
        2, 1, count, edges, sigma, pf_penumbra_factor, 2.0, pf_penumbra_z, 0.0};
    for (int i = 0; i < count; i++)
        toy.eta_0 += (1.0 - edges[i]) / count;
    return toy;
}

static inline struct pf_toy pf_box(double sigma, int dims)
{
    return (struct pf_toy){dims,
                           2,
                           1,
                           NULL,
                           sigma,
                           pf_box_factor,
                           1.0 + 2.0 * PF_BOX,
                           pf_box_z,
                           pow(PF_BOX, dims)};
}

/* --- as a target of chains ------------------------------------------------------------
 */

/* Where number i lives: events go round the three streams. */
static inline int pf_place(const struct pf_toy *toy, int i, int *stream)
{
    int event = i / toy->per_event;
    *stream = event % PSS_STREAMS;
    return event / PSS_STREAMS * toy->per_event + i % toy->per_event;
}

static inline void pf_fill(const struct pf_toy *toy, const double *x, double f,
                           struct contrib *out)
{
    contrib_clear(out);
    contrib_add(out, pf_pixel(toy, x[0]), (struct rgb){f, f, f}, 0, 0);
    out->target = f; /* the luminance rounds */
}

/* ctx: a pf_toy. The failure tells in which stream the path ended. */
static inline void pf_eval(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    static const enum failure failures[] = {FAILURE_CAMERA_PATH, FAILURE_LIGHT_PATH,
                                            FAILURE_BLOCKED};
    const struct pf_toy *toy = ctx;
    struct ustream *streams[] = {numbers->camera, numbers->light, numbers->connect};
    double x[PF_MAX_DIMS] = {0}, f = 1.0;
    for (int i = 0; i < toy->dims; i += toy->per_event) {
        int stream, place = pf_place(toy, i, &stream);
        const double *u = ustream_take(streams[stream], place, toy->per_event);
        for (int j = 0; j < toy->per_event; j++) {
            x[i + j] = u[j];
            f *= toy->factor(toy, x, i + j);
        }
        if (!(f > 0.0)) {
            contrib_clear(out);
            out->failure = failures[stream];
            return;
        }
    }
    pf_fill(toy, x, f, out);
}

/* One exact sample of the normalised f. Factors of the box are independent, so that each
 * number can be drawn by itself; of the others, all at once. */
static inline void pf_sample(const struct pf_toy *toy, struct rng *rng, double *x)
{
    bool apart = toy->factor == pf_box_factor;
    double f, most;
    for (int i = 0, from = 0; i < toy->dims; i++) {
        if (!apart && i < toy->dims - 1)
            continue;
        do {
            f = most = 1.0;
            for (int j = from; j <= i; j++) {
                x[j] = rng_double(rng);
                f *= toy->factor(toy, x, j);
                most *= toy->most;
            }
        } while (rng_double(rng) * most >= f);
        from = i + 1;
    }
}

/* One of f Z. */
static inline void pf_sample_biased(const struct pf_toy *toy, double p_large,
                                    struct rng *rng, double *x)
{
    do
        pf_sample(toy, rng, x);
    while (rng_double(rng) >= pf_z(toy, x, p_large));
}

static inline void pf_chain_init(struct chain *chain, const struct pf_toy *toy,
                                 int second_stage)
{
    const int capacity[PSS_STREAMS] = {PF_MAX_DIMS, PF_MAX_DIMS, PF_MAX_DIMS};
    struct kernel kernel;
    kernel_init(&kernel, &kernel_gaussian, toy->sigma, 0.0, 0.0);
    kernel.second_stage = second_stage;
    pss_chain_init(chain, capacity, 1, &kernel);
}

/* Puts the chain at x; its rng goes on where it is. */
static inline void pf_start(struct chain *chain, const struct pf_toy *toy,
                            const double *x)
{
    pss_reset(pss_of(chain));
    for (int i = 0; i < toy->dims; i++) {
        int stream, place = pf_place(toy, i, &stream);
        pss_of(chain)->streams[stream].current[place] = x[i];
        pss_of(chain)->streams[stream].stamp[place] = 0;
    }
    pf_fill(toy, x, pf_density(toy, x), chain->current);
    chain->tally = (struct tally){0};
    chain->pending_weight = 0.0;
}

/* Of a state with f > 0, which has asked for every number. */
static inline void pf_state(const struct chain *chain, const struct pf_toy *toy,
                            double *x)
{
    for (int i = 0; i < toy->dims; i++) {
        int stream, place = pf_place(toy, i, &stream);
        x[i] = pss_of(chain)->streams[stream].current[place];
    }
}

#endif

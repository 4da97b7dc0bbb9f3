#ifndef ETALON_IMAGE_CONTRIB_H
#define ETALON_IMAGE_CONTRIB_H

/* The contribution of one path sample: a bounded list of splats. Values are those of
 * sampling the whole film uniformly: the mean over samples of the sum of all splats is
 * the image's mean radiance, and pixel j = number of pixels * mean of the splats that
 * fall on j. */

#include "math/rgb.h"

#include <assert.h>
#include <stdint.h>

struct pack;

struct splat {
    int32_t pixel; /* y * width + x */
    int16_t s, t;  /* technique; 0, 0 if several are summed */
    struct rgb value;
};

/* Why a sample has no contribution [Zeng19, section 5]: a sub-path did not reach its
 * length, the connection is blocked, or the value is zero (or was not finite). */
enum failure {
    FAILURE_NONE,
    FAILURE_CAMERA_PATH,
    FAILURE_LIGHT_PATH,
    FAILURE_BLOCKED,
    FAILURE_ZERO,
    FAILURE_INVERSE, /* of a jump: chain/pss_jump.h */
    FAILURE_CLASS,   /* of a perturbation: path/mutation.h */
    FAILURES
};

struct contrib {
    double target; /* scalar of the chain, >= 0: luminance of the sum, or of a split */
    enum failure failure; /* FAILURE_NONE exactly if there is a splat */
    int count, capacity;  /* capacity: max_depth + 2 unless techniques are kept apart */
    int connections;      /* attempted without a random event of their own */
    long nonfinite;       /* values dropped for being NaN or infinite, since creation */
    struct splat *splats;
    /* With a split (integrator/split.h) in a chain: what is left to independent samples,
     * times the splats. */
    double rest;
    /* NULL, or MIS weights of the splats, [capacity], by an estimator that keeps
     * techniques apart (path/estimate.h). */
    double *weights;
};

void contrib_init(struct contrib *c, int capacity);
void contrib_deinit(struct contrib *c);
void contrib_keep_weights(struct contrib *c); /* allocates `weights` */
/* Memory besides the struct. */
double contrib_bytes(int capacity);
/* To or from a checkpoint (base/pack.h), of a film of so many pixels. */
void contrib_pack(struct pack *pack, struct contrib *c, long pixels);

static inline void contrib_clear(struct contrib *c)
{
    c->count = c->connections = 0;
    c->target = 0.0;
    c->failure = FAILURE_ZERO;
}

/* Adds one splat and its luminance to the target; black ones are skipped, non-finite
 * ones counted. More than capacity is a programmer error. */
static inline void contrib_add(struct contrib *c, int pixel, struct rgb value, int s,
                               int t)
{
    if (rgb_is_black(value))
        return;
    if (!rgb_is_finite(value)) {
        c->nonfinite++;
        return;
    }
    assert(c->count < c->capacity);
    c->target += rgb_luminance(value);
    c->failure = FAILURE_NONE;
    c->splats[c->count++] = (struct splat){pixel, (int16_t)s, (int16_t)t, value};
}

/* The same of one technique, with its MIS weight. */
static inline void contrib_add_technique(struct contrib *c, int pixel, struct rgb value,
                                         int s, int t, double weight)
{
    int before = c->count;
    contrib_add(c, pixel, value, s, t);
    if (c->weights && c->count > before)
        c->weights[before] = weight;
}

#endif

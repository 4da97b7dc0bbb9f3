#ifndef ETALON_INTEGRATOR_MARKOV_PILOT_H
#define ETALON_INTEGRATOR_MARKOV_PILOT_H

/* Independent samples before a run with a split: a guess of the picture, and what
 * independent samples would leave as error. They are no part of the picture. */

#include "chain/target.h"
#include "integrator/split.h"

struct pilot_splat {
    int32_t pixel;
    float luminance;
    uint8_t length; /* edges, where each technique has a splat; else 0 */
    bool camera;    /* on the pixel through which the sample was traced */
};

struct pilot {
    int width, height;
    long count;        /* samples */
    double *luminance; /* [pixels], picture by the samples so far, times their number */
    long kept, most;   /* samples whose splats are kept, and at most */
    long *ends;        /* [kept], end of a sample's splats */
    struct pilot_splat *splats;
    size_t splat_capacity;
    double work; /* sum over samples, in the unit of WORK_EVENT (chain/state.h) */
};

/* Of a pass, the sum over its splats of squares relative to the pixel, mean over samples;
 * and the mean of what falls on the sample's own pixel, by which passes are stratified.
 */
struct pilot_rest {
    double square, mean; /* of the rest, (1-s) F, before it is shared with large steps */
    double by_length[DIMS_MAX_DEPTH + 1]; /* squares, of each length by itself */
};

void pilot_init(struct pilot *pilot, int width, int height, long most);
void pilot_deinit(struct pilot *pilot);
/* Traces `count` samples of [threads] targets, as numbers first and on of their stream
 * (seed, RNG_GUESS). keep: keeps splats while there is room. factor: weight in the
 * guess. */
struct pilot_job {
    const struct target *targets; /* [threads] */
    int threads, max_splats;
    uint64_t seed;
    long first;
    bool keep;
    double factor;
};
void pilot_trace(struct pilot *pilot, const struct pilot_job *job, long count);
/* Sets split->inverse and unit from the samples. guess: by a blurred picture, else the
 * same for all pixels. floor: e^2 of relMSE in squared emission units; in a darker
 * picture e is its mean. False if there was no light. */
bool pilot_guess(struct pilot *pilot, bool guess, double floor, struct split *split);
struct pilot_rest pilot_rest(const struct pilot *pilot, const struct split *split);

#endif

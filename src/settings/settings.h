#ifndef ETALON_SETTINGS_SETTINGS_H
#define ETALON_SETTINGS_SETTINGS_H

/* The settings of a run, as algorithms read them. Each field has a row in
 * settings_table.c, from which parsing, defaults, help, the document, the identity of
 * checkpoints and the columns of statistics follow. */

#include "base/err.h"
#include "chain/estimator.h"
#include "chain/kernel.h"
#include "scene/scene.h"

#include <stddef.h>

/* Automatic p_l: one for all path lengths, or one for each (mmlt, pfmlt,
 * rjmlt). */
enum plarge_per { PER_ALL, PER_LENGTH };

/* By what chains are allocated to path lengths (mmlt, pfmlt, rjmlt). */
enum allocation { ALLOCATION_ERROR, ALLOCATION_BRIGHTNESS };

/* Whether chains (joint) or plain samples (separate) render path lengths 1 and 2.
 * Default: separate if the budget allows two passes of plain samples within a quarter of
 * all paths. */
enum direct { DIRECT_DEFAULT, DIRECT_JOINT, DIRECT_SEPARATE };

/* pt, bdpt: samples of a pixel, the same number for all or by the pixel's error. Default:
 * uniform; adaptive where auto has chosen. */
enum film_sampling {
    FILM_SAMPLING_DEFAULT,
    FILM_SAMPLING_UNIFORM,
    FILM_SAMPLING_ADAPTIVE
};

/* mlt: by what the bidirectional mutation chooses the vertices that it deletes:
 * uniformly, or by the density with which they would be added again (w_{l,m} of [CMU17]).
 */
enum deletion { DELETION_UNIFORM, DELETION_WEIGHTED };
enum mutation_weights { WEIGHTS_GIVEN, WEIGHTS_MEASURED };

/* Layers of a run beside its picture (docs/layers.md), in settings.layers. */
enum {
    LAYER_ACCEPTANCE = 1, /* of small and of large steps, where the chain is */
    LAYER_FAILURES = 2,   /* share of proposals, or samples, that carry nothing */
    LAYER_WORK = 4,       /* cost of proposals, or samples */
    LAYER_VISITS = 8,     /* where chains are */
    LAYER_LENGTHS = 16,   /* light by path length */
    LAYER_TECHNIQUES = 32,
    LAYER_UNWEIGHTED = 64, /* the same without MIS weights */
    LAYER_FEATURES = 128,  /* albedo, normal, depth: path/features.h */
};

struct settings {
    const char *integrator; /* name in the registry */
    double p_large;         /* NAN = auto */
    const char *rule;       /* of an automatic p_l; NULL: as settings_rule says */
    enum plarge_per per;
    enum allocation allocation;
    const char *mode;      /* NULL: the integrator's own, as settings_mode says */
    double jump;           /* rjmlt: share of jumps among mutations that are not large */
    const char *kernel;    /* NULL: the integrator's own, as settings_kernel says */
    const char *estimator; /* NULL: the integrator's own, as settings_estimator says */
    double sigma, s1, s2;  /* sigma, s2: 0 as settings_sigma and settings_s2 say */
    const char *builder;   /* paths of pssmlt: bdpt or pt */
    enum film_sampling film_sampling;
    double shadow_rays; /* bdpt's: path/estimate_roulette.h; 0: a ray a connection */
    /* mlt: least distance on the film in pixels, and share of it that a disk of the
     * greatest has; least and greatest angle, degrees; weights of the mutations. */
    double lens_radius, lens_area;
    double angle_least, angle_most;
    double weight_lens, weight_caustic, weight_multichain, weight_bidirectional;
    double weight_lens_subpath, weight_numbers;
    enum mutation_weights mutation_weights;
    enum deletion deletion;
    /* smlt: whose chains take their share of the light, pssmlt's or mmlt's; the floor c
     * of the share and the share of the passes in all paths, NAN: auto. */
    const char *metropolis;
    double share_floor, passes_share;
    double ceiling; /* W; 0: the integrator's own, as settings_ceiling says */
    bool two_stage; /* targets relative to a guess of the picture */
    long chains;
    long bootstrap;   /* independent paths before the chains */
    double start;     /* length of the measured start, share of the budget */
    double start_cap; /* upper limit of the start after doublings, share of the budget */
    long start_mutations; /* least mutations of a chain in the start, within the cap */
    long max_depth;       /* edges; 0 = the file's own, else 12 */
    double seconds;       /* budget in seconds; 0: mutations_per_pixel is the budget */
    double mutations_per_pixel;
    /* Ends the run once relMSE is below this by its error bars, see until.h; 0: off. */
    double until_relmse;
    enum direct direct;         /* of the same: what renders path lengths 1 and 2 */
    enum accel_compact compact; /* kind of the BVH */
    long width, height;         /* 0 = the file's own */
    long seed;
    long threads;  /* 0 = all */
    long replicas; /* independent parts for error bars and a verdict; 1: neither */
    long layers;   /* LAYER_..., those that the integrator has */
    /* Bytes above which path lengths share films (markov_films.c) and tiles of large
     * steps become larger (markov_missed.c); 0: the constants there. For tests; it has no
     * key. */
    double memory_limit;
    bool until_converged; /* ends the run once the verdict is "converged" */
    bool allow_zero;      /* allows p_large = 0, with which the chain is not ergodic */
    bool keep_all;
};

#define SETTINGS_DEFAULT_DEPTH 12
#define SETTINGS_MAX_DEPTH     64 /* limit of path/dims.h */

/* The defaults of the table. */
void settings_init(struct settings *settings);

/* Sets one key from its text. An unknown key or an invalid value fails with the valid
 * ones. "budget" takes "seconds=S" or "mutations_per_pixel=N"; these are keys too. */
bool settings_set(struct settings *settings, const char *key, const char *value,
                  const struct place *at, struct err *err);

/* After all are set: rejects combinations that are impossible. */
bool settings_check(const struct settings *settings, struct err *err);

/* The depth limit in edges for this scene. */
int settings_depth(const struct settings *settings, const struct scene *scene);
/* The same before the scene is built: file_depth is that of its file, 0 if none. */
int settings_depth_of(const struct settings *settings, int file_depth);

/* The value given, or the integrator's default: rule zsolnai2013 for mode paper, else
 * tours; mode exact for pfmlt, counted for rjmlt; kernel gaussian for pfmlt and for rjmlt
 * in other modes than counted, else exponential; estimator plain for mode paper, else
 * kelemen. */
const char *settings_rule(const struct settings *settings);
const char *settings_mode(const struct settings *settings);
const struct kernel_type *settings_kernel(const struct settings *settings);
/* Widths of small steps as given; else 1/64 and .01 by rule zsolnai2013 [Kelemen02], and
 * by tours what moves a path about four pixels far at most, within 1/256 and 1/8 (s2). */
double settings_sigma(const struct settings *settings, double pixels);
double settings_s2(const struct settings *settings, double pixels);
enum estimator settings_estimator(const struct settings *settings);
enum film_sampling settings_film_sampling(const struct settings *settings);
/* NAN: auto, INFINITY: none; smlt: auto if not given, else none. */
double settings_ceiling(const struct settings *settings);
/* Whether chains take a share of the light only, or a target other than luminance. */
bool settings_splits(const struct settings *settings);
/* Whether chains of smlt sample one technique at a time, by mmlt. */
bool settings_multiplexed(const struct settings *settings);
/* Number of path lengths, from 1 on, that plain samples render; 0 if `direct` is joint.
 */
int settings_plain_lengths(const struct settings *settings, int max_depth);

/* The settings with all open values replaced by those of a run in this scene: rule,
 * kernel and widths, estimator, direct (DIRECT_DEFAULT if the integrator does not read
 * it), depth, size and kind of BVH. */
struct settings settings_resolve(const struct settings *settings,
                                 const struct scene *scene);

/* Threads of the run: 0 is all. */
int settings_threads(const struct settings *settings);

/* Those of the layers asked for that the integrator does not have, as a sum of LAYER_...;
 * 0 for auto: it depends on its choice. */
long settings_layers_lacking(const struct settings *settings);

/* Whether the chosen integrator reads this key; false for an unknown key. */
bool settings_uses(const struct settings *settings, const char *key);

/* Whether the run has a condition for an early end. */
static inline bool settings_until(const struct settings *settings)
{
    return settings->until_converged || settings->until_relmse > 0.0;
}

static inline bool settings_auto(const struct settings *settings)
{
    return isnan(settings->p_large);
}

#endif

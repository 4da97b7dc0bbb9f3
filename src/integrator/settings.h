#ifndef ETALON_INTEGRATOR_SETTINGS_H
#define ETALON_INTEGRATOR_SETTINGS_H

/* What a user may set, with one spelling in scene files, experiments and --set. */

#include "base/err.h"
#include "chain/chain.h"
#include "chain/kernel.h"
#include "path/dims.h"
#include "scene/scene.h"

#include <stddef.h>

/* By default separate where the budget lets plain samples have two passes at a quarter of
 * all paths, else joint. */
enum direct { DIRECT_DEFAULT, DIRECT_JOINT, DIRECT_SEPARATE };

struct settings {
    const char *integrator; /* name in the registry */
    double p_large;         /* NAN = auto */
    const char *rule;       /* how auto is decided */
    bool per_length;        /* auto: a p_l for each path length (mmlt, pfmlt) */
    bool allow_zero;        /* p_large = 0 is let through: the chain is not ergodic */
    bool by_brightness;     /* mmlt, pfmlt: chains of a length in proportion to its b */
    bool estimator_given;   /* else the integrator's own estimator */
    enum estimator estimator;
    const char *mode;                 /* pfmlt: exact, counted, paper */
    const struct kernel_type *kernel; /* NULL: the integrator's own */
    double sigma, s1, s2;
    const char *builder; /* paths of pssmlt: bdpt or pt */
    long chains;
    long bootstrap;       /* independent paths before the chains */
    double start;         /* share of the budget that is measured first */
    double start_cap;     /* the most that doubling may make of it */
    long start_mutations; /* a chain, at least (within the cap) */
    long max_depth;       /* edges; 0 = the file's own, else 12 */
    double seconds;       /* budget; 0 = mutations_per_pixel decides */
    double mutations_per_pixel;
    double until_relmse;  /* ends before its budget once relMSE is below this by its error
                           * bars, see until.h; 0: no matter */
    bool until_converged; /* or once the verdict says so */
    bool keep_all;
    enum direct direct; /* mmlt, pfmlt: who does the path lengths 1 and 2 */
    long width, height; /* 0 = the file's own */
    long seed;
    long threads;  /* 0 = all */
    long replicas; /* independent parts for error bars and a verdict; 1: neither */
    enum accel_compact compact; /* the hierarchy that rays go through */
    /* Bytes beyond which path lengths share films (markov_films.c) and tiles of large
     * steps are larger (markov_missed.c); 0: what stands there. It has no key: for tests.
     */
    double memory_limit;
};

#define SETTINGS_DEFAULT_DEPTH 12
#define SETTINGS_MAX_DEPTH     DIMS_MAX_DEPTH

void settings_init(struct settings *settings);

/* Sets one key from its text; an unknown key or a value out of range fails with what
 * would be right. "budget" takes "seconds=S" or "mutations_per_pixel=N"; so do these
 * keys. */
bool settings_set(struct settings *settings, const char *key, const char *value,
                  const struct place *at, struct err *err);

/* After all are set: combinations that cannot be. */
bool settings_check(const struct settings *settings, struct err *err);

/* The depth limit in edges for this scene. */
int settings_depth(const struct settings *settings, const struct scene *scene);
/* The same for a scene that is not built: file_depth is what its file says, 0 nothing. */
int settings_depth_of(const struct settings *settings, int file_depth);

/* What was given, or the integrator's own: gaussian for pfmlt, else exponential; plain
 * for mode paper, else kelemen. */
const struct kernel_type *settings_kernel(const struct settings *settings);
enum estimator settings_estimator(const struct settings *settings);
/* How many path lengths, from 1 on, are left to plain samples: 0 where direct is joint.
 */
int settings_plain_lengths(const struct settings *settings, int max_depth);

/* Threads of the run: 0 is all. */
int settings_threads(const struct settings *settings);

/* Whether the run may end before its budget does. */
static inline bool settings_until(const struct settings *settings)
{
    return settings->until_converged || settings->until_relmse > 0.0;
}

static inline bool settings_auto(const struct settings *settings)
{
    return isnan(settings->p_large);
}

/* The index-th key and the values it takes; false past the end. */
bool settings_help(int index, const char **name, const char **help);

#endif

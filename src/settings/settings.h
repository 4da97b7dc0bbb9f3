#ifndef ETALON_SETTINGS_SETTINGS_H
#define ETALON_SETTINGS_SETTINGS_H

/* What a user may set, as algorithms read it. Each field has a row in settings_table.c,
 * from which parsing, defaults, help, the document, the identity of checkpoints and the
 * columns of statistics follow. */

#include "base/err.h"
#include "chain/chain.h"
#include "chain/kernel.h"
#include "scene/scene.h"

#include <stddef.h>

/* Auto: one p_l for all path lengths, or one for each (mmlt, pfmlt). */
enum plarge_per { PER_ALL, PER_LENGTH };

/* What chains are shared out among path lengths by (mmlt, pfmlt). */
enum allocation { ALLOCATION_ERROR, ALLOCATION_BRIGHTNESS };

/* By default separate where the budget lets plain samples have two passes at a quarter of
 * all paths, else joint. */
enum direct { DIRECT_DEFAULT, DIRECT_JOINT, DIRECT_SEPARATE };

struct settings {
    const char *integrator; /* name in the registry */
    double p_large;         /* NAN = auto */
    const char *rule;       /* how auto is decided */
    enum plarge_per per;
    enum allocation allocation;
    const char *mode;      /* pfmlt: exact, counted, paper */
    const char *kernel;    /* NULL: the integrator's own, as settings_kernel says */
    const char *estimator; /* NULL: the integrator's own, as settings_estimator says */
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
    double until_relmse; /* ends before its budget once relMSE is below this by its error
                          * bars, see until.h; 0: no matter */
    enum direct direct;  /* mmlt, pfmlt: who does the path lengths 1 and 2 */
    enum accel_compact compact; /* the hierarchy that rays go through */
    long width, height;         /* 0 = the file's own */
    long seed;
    long threads;  /* 0 = all */
    long replicas; /* independent parts for error bars and a verdict; 1: neither */
    /* Bytes beyond which path lengths share films (markov_films.c) and tiles of large
     * steps are larger (markov_missed.c); 0: what stands there. It has no key: for tests.
     */
    double memory_limit;
    bool until_converged; /* ends before its budget once the verdict says so */
    bool allow_zero;      /* p_large = 0 is let through: the chain is not ergodic */
    bool keep_all;
};

#define SETTINGS_DEFAULT_DEPTH 12
#define SETTINGS_MAX_DEPTH     64 /* what path/dims.h has places for */

/* The defaults of the table. */
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

/* The same with what a run in this scene takes in the place of what was left open:
 * kernel, estimator, direct (DIRECT_DEFAULT where the integrator does not read it),
 * depth, size and the kind of hierarchy. */
struct settings settings_resolve(const struct settings *settings,
                                 const struct scene *scene);

/* Threads of the run: 0 is all. */
int settings_threads(const struct settings *settings);

/* Whether the chosen integrator reads this key; false for a key that there is not. */
bool settings_uses(const struct settings *settings, const char *key);

/* Whether the run may end before its budget does. */
static inline bool settings_until(const struct settings *settings)
{
    return settings->until_converged || settings->until_relmse > 0.0;
}

static inline bool settings_auto(const struct settings *settings)
{
    return isnan(settings->p_large);
}

#endif

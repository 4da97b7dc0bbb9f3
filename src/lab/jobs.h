#ifndef ETALON_LAB_JOBS_H
#define ETALON_LAB_JOBS_H

/* The jobs of an experiment: the product of its seeds, scenes, integrators and settings,
 * with the seed outermost, then the scene, then settings (size first). So a disturbance
 * of the machine affects all cells, not one. */

#include "base/hash.h"
#include "lab/experiment.h"
#include "settings/settings.h"

struct job {
    /* Hash of everything that determines the outcome except the program: the scene's path
     * and the contents of its files, the settings (sorted by key, numbers by value), the
     * seed, and the reference. */
    char id[HASH_DIGITS + 1];
    char cell[HASH_DIGITS + 1]; /* the same without seed and path */
    char *name;  /* "SCENE LABEL BUDGET seed=N": unique in the experiment */
    char *label; /* integrator and settings, without scene, budget and seed */
    const struct experiment_scene *scene;
    const struct reference_spec *reference;
    uint64_t scene_fingerprint;
    struct choice *choices; /* sorted by key; one a key */
    size_t choice_count;
    long seed;
};

struct jobs {
    struct job *items;
    size_t count, capacity;
};

#define JOBS_MAX 100000

/* Reads the files of scenes and references for the ids. Two equal jobs or names are an
 * error, and so are more than JOBS_MAX jobs. */
bool jobs_make(const struct experiment *experiment, struct jobs *jobs, struct err *err);
void jobs_deinit(struct jobs *jobs);

/* Applies the job's settings to *settings, which hold those of the scene file, and checks
 * the combination. */
bool job_settings(const struct job *job, struct settings *settings, struct err *err);

/* The value of one of its settings; NULL if not given. */
const char *job_value(const struct job *job, const char *key);

/* Whether pattern is a part of the name or, with one of *?[ in it, a shell pattern for
 * the whole name. */
bool job_matches(const struct job *job, const char *pattern);

#endif

#ifndef ETALON_LAB_JOBS_H
#define ETALON_LAB_JOBS_H

/* The jobs of an experiment: the product of its seeds, scenes, integrators and settings,
 * interleaved: seed outermost, then scene, then settings (size outermost among them), so
 * that a noisy minute of the machine hits all alike. */

#include "base/hash.h"
#include "lab/experiment.h"
#include "settings/settings.h"

struct job {
    /* Of all that matters to the outcome but the program itself: spelling of the scene's
     * path, contents of its files, settings (by key, so their order does not count;
     * numbers by value), seed, and what it is measured against. */
    char id[HASH_DIGITS + 1];
    char cell[HASH_DIGITS + 1]; /* the same without the seed and the path's spelling */
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

/* Reads the files that scenes and references are made of, for the ids. Two jobs that are
 * the same, or of the same name, are an error, and so are more than JOBS_MAX. */
bool jobs_make(const struct experiment *experiment, struct jobs *jobs, struct err *err);
void jobs_deinit(struct jobs *jobs);

/* Applies the job's settings to *settings, which hold what the scene file says, and
 * checks the whole. */
bool job_settings(const struct job *job, struct settings *settings, struct err *err);

/* The value of one of its settings, NULL if it does not say. */
const char *job_value(const struct job *job, const char *key);

/* Whether pattern is a part of the name or, with one of *?[ in it, a shell pattern for
 * the whole name. */
bool job_matches(const struct job *job, const char *pattern);

#endif

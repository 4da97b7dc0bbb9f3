#ifndef ETALON_LAB_EXPERIMENT_H
#define ETALON_LAB_EXPERIMENT_H

/* An experiment file, read and checked. Of several values of a setting
 * the last one counts, in this order: the scene file, the experiment, the entry of
 * `scenes`, the entry of `integrators`. lab/jobs.h makes the product. */

#include "lab/axes.h"

enum reference_kind {
    REFERENCE_UNSET, /* not given: the experiment's reference counts, if there is one */
    REFERENCE_NONE,
    REFERENCE_FILE,
    REFERENCE_RENDERED, /* as two halves of different seeds, lab/reference.h */
};

struct reference_spec {
    enum reference_kind kind;
    char *file;        /* path to open; owned */
    const char *given; /* the same as the experiment spells it */
    struct axes
        settings; /* of the rendering, one choice each; its budget is both halves' */
    struct place at;
};

struct experiment_scene {
    char *path;        /* to open; owned */
    const char *given; /* the same as the experiment spells it */
    char *label;       /* unique; owned */
    struct axes axes;
    struct reference_spec reference;
    struct place at;
};

/* An entry of `integrators`: the integrator and settings that belong to it. */
struct experiment_variant {
    const char *label; /* NULL: made from the settings */
    struct axes axes;  /* "integrator" is one of them */
};

struct experiment {
    struct doc *doc; /* texts live here */
    const char *name;
    struct place at;
    struct experiment_scene *scenes;
    struct experiment_variant *variants;
    size_t scene_count, variant_count;
    long *seeds;
    size_t seed_count;
    struct axes axes;
    struct reference_spec reference;
};

/* NULL on failure, with file:line:col. Scenes and references are not opened. */
struct experiment *experiment_load(const char *path, struct err *err);
void experiment_destroy(struct experiment *experiment);

#endif

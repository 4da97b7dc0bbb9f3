#ifndef ETALON_RUN_CHECKPOINT_H
#define ETALON_RUN_CHECKPOINT_H

/* The head of a checkpoint, which identifies its run. The integrator's pack function adds
 * the state (run_pack.c). */

#include "base/pack.h"
#include "settings/settings.h"

/* To be raised when what a checkpoint holds changes. */
#define CHECKPOINT_LAYOUT 23

/* Names and values of everything that determines the bits of a run (program, scene,
 * settings), except its budget; filled in by lab/identity. */
struct identity {
    struct identity_entry {
        const char *name;
        char *value;
    } * entries;
    size_t capacity;
    int count;
};

/* Name of the entry that holds the definitions for the scene's file, or "none". */
#define IDENTITY_DEFINITIONS "definitions for the scene (-D)"

void identity_add(struct identity *identity, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void identity_deinit(struct identity *identity);
/* The value of a name, or NULL. */
const char *identity_find(const struct identity *identity, const char *name);

struct checkpoint_head {
    double budget_seconds, budget_mutations; /* one of them is 0; per pixel */
    double seconds, mutations; /* work done: rendering time; mutations per pixel */
    bool started;              /* the measured start is over */
    bool finished;             /* the budget is used up */
    struct run_part part;      /* whose state it is */
};

/* Where a run writes checkpoints. */
struct checkpoint_options {
    const char *path;
    double every; /* seconds of wall time */
    const struct identity *identity;
    const char *scene; /* path of the scene, for who reads the file; or NULL */
};

/* Creates the file and writes its head; the state follows. NULL on failure. */
struct pack *checkpoint_create(const struct checkpoint_options *options,
                               const struct checkpoint_head *head, struct err *err);

/* A checkpoint of which the head was read. */
struct checkpoint {
    struct checkpoint_head head;
    struct pack *pack;
    bool other_budget; /* its budget differs from that of this run */
};

/* False, with every difference by name, if it is not of this run. The budget may differ
 * if the measured start, whose length is a share of the budget, is over, and if it
 * exceeds the work done. part: what the run computes; a part begins from its own state or
 * from that of a whole run whose measured start is over. pack is the caller's to destroy,
 * or run_render takes it. */
bool checkpoint_open(struct checkpoint *checkpoint, const char *path,
                     const struct identity *identity, const struct settings *settings,
                     struct run_part part, struct err *err);

/* What a checkpoint says of its run. */
struct checkpoint_label {
    struct identity identity; /* its names are owned too */
    struct checkpoint_head head;
    char *scene; /* path */
};

bool checkpoint_label_read(struct checkpoint_label *label, const char *path,
                           struct err *err);
void checkpoint_label_deinit(struct checkpoint_label *label);

#endif

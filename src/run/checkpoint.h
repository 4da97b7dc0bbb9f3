#ifndef ETALON_RUN_CHECKPOINT_H
#define ETALON_RUN_CHECKPOINT_H

/* The head of a checkpoint: which run it is of. The state itself is what the integrator's
 * pack function says (run.c). */

#include "base/pack.h"
#include "settings/settings.h"

/* To be raised when what a checkpoint holds changes. */
#define CHECKPOINT_LAYOUT 9

/* Names and values of all that decides the bits of a run (program, scene, settings), but
 * for its budget; filled by lab/identity. */
struct identity {
    struct identity_entry {
        const char *name;
        char *value;
    } entries[48];
    int count;
};

void identity_add(struct identity *identity, const char *name, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void identity_deinit(struct identity *identity);

struct checkpoint_head {
    double budget_seconds, budget_mutations; /* of which one is 0; per pixel */
    double seconds, mutations;               /* done: of rendering; per pixel */
    bool started;                            /* the measured start is over */
};

/* Where a run writes checkpoints. */
struct checkpoint_options {
    const char *path;
    double every; /* seconds of wall time */
    const struct identity *identity;
};

/* A file whose head is written; the state follows. NULL on failure. */
struct pack *checkpoint_create(const struct checkpoint_options *options,
                               const struct checkpoint_head *head, struct err *err);

/* A checkpoint whose head was read. */
struct checkpoint {
    struct checkpoint_head head;
    struct pack *pack;
    bool other_budget; /* than the run that goes on has */
};

/* False, and every difference by its name, if it does not fit this run. Another budget
 * will do once the measured start, a share of the budget, is over, and if not more than
 * it is done. pack is the caller's to destroy, or run_render's to take. */
bool checkpoint_open(struct checkpoint *checkpoint, const char *path,
                     const struct identity *identity, const struct settings *settings,
                     struct err *err);

#endif

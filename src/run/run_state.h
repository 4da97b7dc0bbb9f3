#ifndef ETALON_RUN_RUN_STATE_H
#define ETALON_RUN_RUN_STATE_H

/* The inside of a run: only the files of this room include this. */

#include "convergence/past_snapshots.h"
#include "run/run.h"

struct run {
    const struct run_options *options;
    const struct integrator_type *type;
    void *integrator;
    struct image *picture;
    struct past_snapshots past;
    struct until until;
    double wall, cpu; /* s, of rendering only */
    double next_snapshot, next_progress;
    double last_row;        /* `wall` at the last row, -1 before the first */
    long edges_cut;         /* of the scene, before the run */
    bool more;              /* the integrator's budget is not used up */
    double next_checkpoint; /* by the clock, including time that is not rendering */
    struct error_row *rows; /* all rows so far, if there are checkpoints */
    size_t row_count, row_capacity;
};

static inline double run_pixels(const struct run *run)
{
    return (double)run->picture->width * (double)run->picture->height;
}

#endif

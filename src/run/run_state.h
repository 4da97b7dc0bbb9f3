#ifndef ETALON_RUN_RUN_STATE_H
#define ETALON_RUN_RUN_STATE_H

/* The inside of a run: only the files of this room include this. */

#include "convergence/past_snapshots.h"
#include "run/run.h"

/* Looks at a run by its viewers (run_view.h). */
enum view_kind { VIEW_PICTURE, VIEW_VERDICT, VIEWS };

/* Looks of one kind. Seconds of CPU time, or for which CPUs wait. */
struct view_account {
    long looks;
    double taken, last; /* by all, by the last one */
};

struct view {
    struct view_account accounts[VIEWS];
    enum view_kind kind; /* of the last look */
    double begun;        /* CPU time of the thread at that */
    double viewers_cpu;  /* of viewers, as far as it is charged */
    double next;         /* by the clock: no look before */
    double verdict_at;   /* `wall` of the run at the last verdict */
    double resumed_cpu;  /* `cpu` of the run at its beginning in this process */
};

struct run {
    const struct run_options *options;
    const struct integrator_type *type;
    void *integrator;
    struct image *picture;
    bool parts; /* its state is a part's, or is added up from such */
    struct past_snapshots past;
    struct until until;
    bool ranks;       /* several processes compute the parts */
    unsigned due;     /* RANKS_... of the last round */
    double wall, cpu; /* s, of rendering only */
    double next_snapshot, next_progress;
    struct view view;
    double last_row;        /* `wall` at the last row, -1 before the first */
    bool more;              /* the integrator's budget is not used up */
    double next_checkpoint; /* by the clock, including time that is not rendering */
    struct error_row *rows; /* all rows so far, if there are checkpoints */
    size_t row_count, row_capacity;
};

/* Allocates what a run needs; counts the scene's cut edges (path/passage.h) from 0.
 * False, with nothing to free, if it does not fit. */
bool run_begin(struct run *run, struct run_result *result, struct err *err);
/* The results so far, but for layers; the picture is the run's. verdict: find it, too. */
void run_take_results(struct run *run, bool verdict, struct run_result *result);
/* Takes the results, after which only run_end is legal. */
void run_conclude(struct run *run, struct run_result *result);
void run_end(struct run *run);

/* run_ranks.c. What is due after a round, agreed upon by all ranks. */
enum {
    RANKS_STOP = 1,
    RANKS_OVER = 2,
    RANKS_ROW = 4,
    RANKS_CHECKPOINT = 8,
    RANKS_VIEW = 16
};

static inline double run_pixels(const struct run *run)
{
    return (double)run->picture->width * (double)run->picture->height;
}

#endif

#ifndef ETALON_RUN_RUN_H
#define ETALON_RUN_RUN_H

/* One run: rounds until the budget is used up or the run is stopped. Between rounds the
 * clock is read, and progress, snapshots, the error log and checkpoints are served; the
 * time of these does not count as rendering. */

#include "image/metric.h"
#include "run/checkpoint.h"
#include "integrator/integrator.h"
#include "convergence/until.h"

#include <signal.h>

/* One row of the error log. */
struct error_row {
    double wall_s, cpu_s; /* of rendering, including the start */
    double paths, mutations_per_pixel;
    struct metric metric;
    /* Figures of the run so far, as in struct run_statistics; NAN if absent. */
    double b, b_se, eta_s, eta_l, eta_0, acceptance, failure_rate;
    double nonfinite, saturated;
};

struct run_progress {
    double share; /* of the budget, 0..1 */
    double wall_s, cpu_s;
    double paths, acceptance, p_large;
    bool started; /* p_l is decided */
};

/* What ended a run. */
enum run_end {
    RUN_BUDGET,
    RUN_START,       /* startup_only: p_l is decided */
    RUN_UNTIL,       /* a condition until_... is met */
    RUN_INTERRUPTED, /* by a signal or a hook */
    RUN_MEMORY,      /* an allocation failed */
    RUN_GOING,       /* nothing yet: these are its results so far */
};
const char *run_end_name(enum run_end end);

/* Whoever looks at a run while it goes. Looks change nothing in it, and are put off until
 * their share of its time is small. */
struct run_result;
struct run_viewer {
    double every; /* s, least time from one look to the next */
    /* Share of the CPU time of rendering that looks may take, of each kind (run_view.h).
     */
    double share;
    bool verdict; /* it is to be found for some looks; for others it is VERDICT_NONE */
    /* Whether a look would be seen now; asked between rounds. */
    bool (*wanted)(void *ctx);
    /* The results so far, without the layers of the integrator; valid during the call. */
    void (*show)(void *ctx, const struct run_result *now);
    double (*cpu)(void *ctx); /* s of CPU time that its own threads took so far */
    void *ctx;
};

struct run_options {
    const struct scene *scene;
    const struct settings *settings;
    const struct image *reference;     /* NULL: no error log */
    bool startup_only;                 /* stop when p_l is decided */
    const volatile sig_atomic_t *stop; /* NULL, or: non-zero ends the run cleanly */
    /* May be NULL. Progress after every round; rows as they are measured, log-spaced in
     * time; a hook that returns false stops the run. */
    void (*on_progress)(void *hook_ctx, const struct run_progress *progress);
    bool (*on_error_row)(void *hook_ctx, const struct error_row *row);
    void *hook_ctx;
    double rows_every; /* s between rows, evenly spaced in time; 0: log-spaced */
    /* NULL, or where checkpoints are written: regularly, and one at the end of the run,
     * however it ends. */
    const struct checkpoint_options *checkpoint;
    const struct run_viewer *viewer; /* NULL, or who looks at the run meanwhile */
    struct run_part part;            /* what is computed; whole: everything */
    /* NULL, or from checkpoint_open: the run takes its pack and continues it; earlier
     * rows of the error log are reported again. */
    struct checkpoint *resume;
};

struct run_result {
    struct image *image; /* NULL if the run could not begin */
    /* Of the integrator; se.Y, rhat.Y, ess.Y of the verdict; A where emitters are hidden
     * (path/coverage.h). */
    struct layers layers;
    struct run_statistics statistics;
    struct verdict verdict;            /* of a whole run; its layers are owned */
    double seconds_total, seconds_cpu; /* of rendering */
    double mutations_per_pixel;
    int max_depth, threads;
    struct run_memory memory;  /* predicted upper bound */
    char blind_to[BLIND_TEXT]; /* path families that it cannot sample, see blind_spots */
    double ranks_bytes; /* that the first of several ranks received to add up all */
    enum run_end end;
    struct until until; /* conditions for an early end, and the looks at them */
    bool interrupted;
};

/* Refuses a run that may take more memory than is available, before allocating. If memory
 * runs out nevertheless, the run ends after the round with ERR_MEMORY; *result then holds
 * the picture and figures so far, as after any failure once rendering has begun. */
bool run_render(const struct run_options *options, struct run_result *result,
                struct err *err);
/* Adds up the parts of a run that are in these files, from checkpoint_open with a `part`
 * of its own each, and concludes as run_render does at the end. Takes their packs. The
 * parts that are missing must be few enough to leave some chains. */
bool run_merge(const struct run_options *options, struct checkpoint *parts, int count,
               struct run_result *result, struct err *err);
/* Predicted memory of a run at most, pictures included; allocates nothing. */
struct run_memory run_memory(const struct scene *scene, const struct settings *settings);
double run_memory_sum(const struct run_memory *memory);
/* Bytes of address space to reserve during a run (mem_reserve), so that the picture can
 * be made and written when no more memory is available. The pages are not touched. */
size_t run_reserve(const struct scene *scene);
/* Whether the prediction fits into the available memory; if not, the error says what to
 * change. */
bool run_check_memory(const struct run_memory *memory, double available,
                      const struct settings *settings, struct err *err);
void run_result_deinit(struct run_result *result);

#endif

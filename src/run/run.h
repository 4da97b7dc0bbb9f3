#ifndef ETALON_RUN_RUN_H
#define ETALON_RUN_RUN_H

/* One run: rounds until the budget is used up or somebody stops it. Between rounds the
 * clock is read, and progress, snapshots, the error log and checkpoints are served; the
 * time of these does not count as rendering. */

#include "image/metric.h"
#include "run/checkpoint.h"
#include "integrator/integrator.h"
#include "convergence/until.h"

#include <signal.h>

/* One row of the error log. */
struct error_row {
    double wall_s, cpu_s; /* of rendering, startup included */
    double paths, mutations_per_pixel;
    struct metric metric;
    /* Of the run so far, as in struct run_statistics; NAN what it does not have. */
    double b, b_se, eta_s, eta_l, eta_0, acceptance, failure_rate;
    double nonfinite, saturated;
};

struct run_progress {
    double share; /* of the budget, 0..1 */
    double wall_s, cpu_s;
    double paths, acceptance, p_large;
    bool started; /* p_l stands */
};

/* What ended a run. */
enum run_end {
    RUN_BUDGET,
    RUN_START,       /* startup_only, and p_l stands */
    RUN_UNTIL,       /* what settings say with until_... is reached */
    RUN_INTERRUPTED, /* or a hook stopped it */
    RUN_MEMORY,      /* an allocation failed */
};
const char *run_end_name(enum run_end end);

struct run_options {
    const struct scene *scene;
    const struct settings *settings;
    const struct image *reference;     /* NULL: no error log */
    bool startup_only;                 /* stop when p_l stands */
    const volatile sig_atomic_t *stop; /* NULL, or: non-zero ends the run cleanly */
    /* May be NULL. Progress after every round; rows as they are made, log-spaced in time;
     * a hook that returns false stops the run. */
    void (*on_progress)(void *hook_ctx, const struct run_progress *progress);
    bool (*on_error_row)(void *hook_ctx, const struct error_row *row);
    void *hook_ctx;
    double rows_every; /* s, for rows evenly spaced in time instead; 0: log-spaced */
    /* NULL, or: a checkpoint now and then, and one at the end, whatever ends the run. */
    const struct checkpoint_options *checkpoint;
    /* NULL, or of checkpoint_open: the run takes its pack and goes on from there; rows of
     * the error log that were made before are made again. */
    struct checkpoint *resume;
};

struct run_result {
    struct image *image;  /* NULL if the run could not begin */
    struct layers layers; /* of the integrator; se.Y, rhat.Y, ess.Y of the verdict */
    struct run_statistics statistics;
    struct verdict verdict;            /* of a whole run; its layers are owned */
    double seconds_total, seconds_cpu; /* of rendering */
    double mutations_per_pixel;
    int max_depth, threads;
    struct run_memory memory;  /* the most that it could take */
    char blind_to[BLIND_TEXT]; /* paths that it could not sample, see blind_spots */
    enum run_end end;
    struct until until; /* looks at the verdict along the way, if there were any */
    bool interrupted;
};

/* Refuses a run that may take more memory than there is, before it takes any. One that
 * runs out of memory all the same ends after the round with ERR_MEMORY; what there is is
 * in *result, as after any failure once it has begun. */
bool run_render(const struct run_options *options, struct run_result *result,
                struct err *err);
/* What a run may take at most, pictures included; takes nothing itself. */
struct run_memory run_memory(const struct scene *scene, const struct settings *settings);
double run_memory_sum(const struct run_memory *memory);
/* What is set aside during a run (mem_reserve), so that its picture can be made and
 * written when there is no more memory. Not touched: it counts where addresses do. */
size_t run_reserve(const struct scene *scene);
/* Whether that fits; the line says how much is wanted and what to change. */
bool run_check_memory(const struct run_memory *memory, double available,
                      const struct settings *settings, struct err *err);
void run_result_deinit(struct run_result *result);

#endif

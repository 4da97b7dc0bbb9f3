#ifndef ETALON_ANALYSIS_RESULTS_H
#define ETALON_ANALYSIS_RESULTS_H

/* The results of an experiment as analyses want them: the rows of runs.csv as cells of
 * runs (analysis/grouping.h), each with its snapshots from curves.csv. Columns are found
 * by name; one that a table lacks reads as NaN or "". */

#include "image/image.h"
#include "lab/csv.h"

enum results_axis { RESULTS_WALL, RESULTS_CPU, RESULTS_MUTATIONS, RESULTS_AXES };
/* All are mean squares (mse is rmse^2), so that the reference's noise adds to them.
 * RESULTS_ESTIMATED is relMSE by the run's own error bars: it needs no reference, and
 * does not see light that the run never found. */
enum results_error {
    RESULTS_RELMSE,
    RESULTS_RELMSE_TRIMMED,
    RESULTS_MSE,
    RESULTS_ESTIMATED,
    RESULTS_ERRORS
};

/* "wall_s" (s), "cpu_s" (s, all threads), "mutations_per_pixel". */
const char *results_axis_name(enum results_axis axis);
/* "relmse", "relmse_trimmed", "mse", "relmse_estimated". */
const char *results_error_name(enum results_error error);

struct results_snapshot {
    double at[RESULTS_AXES];
    double error[RESULTS_ERRORS];
    double mean_ratio;
};

struct results_run {
    size_t row;      /* in results->runs, from 1 on */
    const char *job; /* the picture is FOLDER/images/JOB.exr */
    long seed;
    double p_l; /* that it ran with; NaN without chains */
    /* At its end; NaN without a reference, but for the estimated one. The trimmed one is
     * NaN too if it leaves out another share of the pixels than this program
     * (image/metric.h). */
    double error[RESULTS_ERRORS];
    double estimated_se; /* standard error of the estimated one */
    bool has_trim;       /* this program's share */
    double mean_ratio;
    struct results_snapshot *snapshots; /* by time; NULL without a curve */
    size_t snapshot_count;
};

struct results_cell {
    const char *scene, *label; /* scene is scene_label */
    const char *integrator;
    double budget; /* s, or mutations per pixel */
    bool budget_is_time;
    bool has_chains; /* p_l means something */
    bool is_auto;    /* p_l_source is "auto" */
    double p_l;      /* as set; NaN if auto or without chains */
    double p_l_mean; /* over the runs */
    /* Picture that errors are measured against, path relative to the folder of
     * results; "" if unknown. */
    const char *reference;
    /* The part of each error that is due to the reference's noise: columns
     * reference_relmse, reference_relmse_trimmed, reference_rmse (squared); 0 and false
     * if unknown. Rows of older programs, which weighed it otherwise (image/noise.h),
     * count only if there are no others. */
    double noise[RESULTS_ERRORS];
    bool noise_is_known[RESULTS_ERRORS];
    bool is_biased;           /* the method does not converge to the picture */
    struct results_run *runs; /* by seed, ascending; never two of the same seed */
    size_t run_count;
};

struct results {
    char *folder;
    struct csv *runs, *curves;  /* curves: NULL if there is none */
    struct results_cell *cells; /* in the order of their first rows */
    size_t cell_count;
    size_t superseded; /* rows left out because newer ones are of the same run */
    size_t unreadable; /* rows without job or seed, left out */
    size_t
        other_trim; /* runs whose trimmed errors are left out: another share of pixels */
};

/* NULL on failure: no runs.csv there, or one without the columns job, label, scene_label
 * and seed. A table without finished jobs gives no cells. */
struct results *results_load(const char *folder, struct err *err);
void results_destroy(struct results *results);

/* A column of a run as text or number; "" or NaN if there is none. */
const char *results_text(const struct results *results, const struct results_run *run,
                         const char *column);
double results_number(const struct results *results, const struct results_run *run,
                      const char *column);

/* Its mean over the runs of the cell. */
double results_mean(const struct results *results, const struct results_cell *cell,
                    const char *column);

/* FOLDER/images/JOB.exr; the caller owns it (mem_free). */
char *results_picture(const struct results *results, const struct results_run *run);
/* Reads the pictures of all runs of the cell into pictures[run_count], which the caller
 * destroys, NULL from the first on that cannot be read. */
bool results_read_pictures(const struct results *results, const struct results_cell *cell,
                           struct image **pictures, struct err *err);
/* Whether scene and budget are equal. Two unknown budgets are equal. */
bool results_same_budget(const struct results_cell *a, const struct results_cell *b);
/* The budget in words: "5 s", "64 mutations per pixel". The caller owns it. */
char *results_budget(const struct results_cell *cell);

/* The run of that seed, or NULL. */
const struct results_run *results_find_seed(const struct results_cell *cell, long seed);

#endif

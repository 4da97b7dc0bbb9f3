#ifndef ETALON_ANALYSIS_CELLS_H
#define ETALON_ANALYSIS_CELLS_H

/* The statistics of an experiment, cell by cell (analysis/grouping.h). Lists by path
 * length become a statistic for each length: "b[3]". */

#include "base/log.h"
#include "lab/csv.h"

struct cell_statistic {
    char *name;
    /* A setting, which is the same in all runs; else NULL. "(varies)" if it is not. */
    char *text;
    long count;   /* runs in which it is a finite number */
    long missing; /* runs in which it is not */
    double mean;
    /* Standard error of the mean, from the spread between runs; NAN below two. It has
     * count - 1 degrees of freedom. */
    double se;
    /* Standard error that a run itself states, for cells of one run; NAN if there is
     * none. */
    double se_within;
};

struct cell {
    char *scene, *label;
    char *budget; /* "mpp=64", "5s" */
    /* Hash of the scene's contents, the given settings and the reference (struct job); ""
     * if the table does not state it. */
    char *id;
    char *experiment, *commit; /* "" likewise */
    long runs, seed_first, seed_last;
    struct cell_statistic *statistics;
    size_t count, capacity;
};

/* Zero-initialise. */
struct cells {
    struct cell *items;
    size_t count, capacity;
};

/* How a statistic is compared. */
enum cell_scale {
    CELL_SETTING, /* must be equal */
    CELL_LINEAR,
    CELL_LOG, /* mean and standard error are those of the natural logarithm */
};

/* Summarises a table of runs (lab/store.h). What the table lacks, and runs that are left
 * out, become notes. Fails where grouping_make does. */
bool cells_from_runs(const struct csv *runs, struct cells *cells, struct log *log,
                     struct err *err);
void cells_deinit(struct cells *cells);

/* Adds an empty one; the strings are copied. */
struct cell *cells_add(struct cells *cells, const char *scene, const char *label,
                       const char *budget, const char *id);
struct cell_statistic *cell_add(struct cell *cell, const char *name);

/* By scene, label and budget; NULL if there is none. */
const struct cell *cells_find(const struct cells *cells, const struct cell *like);
const struct cell_statistic *cell_find(const struct cell *cell, const char *name);

/* Whether any run has it: absent values are "" or .nan. */
bool cell_has(const struct cell_statistic *statistic);

/* By the statistic's name, without the "[3]" of a path length. CELL_LINEAR for a name
 * that is not known. */
enum cell_scale cell_scale(const char *name);

#endif

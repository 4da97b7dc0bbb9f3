#ifndef ETALON_ANALYSIS_GROUPING_H
#define ETALON_ANALYSIS_GROUPING_H

/* Which rows of runs.csv are runs of the same thing: a cell is a scene, a label
 * (integrator and settings) and a budget, its runs differ in the seed alone. Of several
 * rows of the same run the last one counts. Of different contents (column 'cell': scene
 * files, settings, reference) those of the last row that states them count. A row that
 * does not state them is grouped by the names. */

#include "lab/csv.h"

struct grouping_run {
    size_t row; /* of the table, from 1 on */
    long seed;
};

struct grouping_cell {
    const char *scene, *label; /* scene is scene_label */
    bool budget_is_time;
    double budget;  /* s, or mutations per pixel; NaN if the table does not state it */
    const char *id; /* of the contents, "" if the table does not state it */
    struct grouping_run *runs; /* by seed, ascending; never two of the same seed */
    size_t run_count;
};

/* Why a row belongs to no cell. */
enum grouping_reason {
    GROUPING_OTHER_CONTENTS, /* than the cell's later rows have */
    GROUPING_SAME_SEED,      /* as a later row of the cell */
    GROUPING_UNREADABLE,     /* no seed, or an empty 'job' */
};

struct grouping_left_out {
    size_t row;
    enum grouping_reason reason;
};

struct grouping {
    struct grouping_cell *cells; /* in the order of their first rows */
    size_t cell_count, cell_capacity;
    struct grouping_left_out *left_out;
    size_t left_out_count, left_out_capacity;
};

/* Borrows from the table. Fails, with nothing to free, if the columns label, scene_label
 * or seed are missing. A cell has at least one run. */
bool grouping_make(const struct csv *runs, struct grouping *grouping, struct err *err);
void grouping_deinit(struct grouping *grouping);

#endif

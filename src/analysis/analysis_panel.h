#ifndef ETALON_ANALYSIS_ANALYSIS_PANEL_H
#define ETALON_ANALYSIS_ANALYSIS_PANEL_H

/* The errors of a family's members at equal time, by seed, for paired comparisons. The
 * time is the earliest end among the runs; errors at that time are interpolated on the
 * runs' curves. A manual value is left out if it has fewer than half of the others' seeds
 * (an unfinished batch), no curves, or curves that begin later than that time. The seeds
 * are those that all remaining cells have. */

#include "analysis/families.h"

struct analysis_panel {
    double x;                          /* NaN if nothing can be compared */
    const struct results_cell **cells; /* the automatic one first, if it exists */
    bool has_auto;
    size_t cell_count, seed_count;
    double *errors;  /* [cell_count][seed_count], raw, all > 0 */
    double noise;    /* of the reference, in each of them */
    size_t left_out; /* manual cells */
    const char *why; /* what is missing, in words; "" if nothing is */
};

/* need_auto: compares nothing without an automatic cell. */
void analysis_panel_make(const struct family *family, enum results_axis axis,
                         enum results_error error, bool need_auto,
                         struct analysis_panel *panel);
void analysis_panel_deinit(struct analysis_panel *panel);

static inline const double *analysis_panel_row(const struct analysis_panel *panel,
                                               size_t cell)
{
    return panel->errors + cell * panel->seed_count;
}

#endif

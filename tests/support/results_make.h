#ifndef ETALON_TESTS_SUPPORT_RESULTS_MAKE_H
#define ETALON_TESTS_SUPPORT_RESULTS_MAKE_H

/* Cells of made-up runs, in memory: what analyses of lab take, with a known truth. */

#include "base/mem.h"
#include "analysis/families.h"
#include "math/rng.h"

#include <math.h>

/* Seeds 1, 2, ...; p_l NAN: automatic. Snapshots are to be filled in. */
static inline struct results_cell results_make_cell(double p_l, size_t seeds,
                                                    size_t snapshots)
{
    struct results_cell cell = {
        .scene = "scene",
        .label = "label",
        .integrator = "pssmlt",
        .budget = 1.0,
        .has_chains = true,
        .is_auto = isnan(p_l),
        .p_l = p_l,
        .p_l_mean = isnan(p_l) ? 0.5 : p_l,
        .reference = "",
        .run_count = seeds,
    };
    cell.runs = mem_alloc(seeds, sizeof *cell.runs);
    for (size_t i = 0; i < seeds; i++) {
        cell.runs[i].seed = (long)i + 1;
        cell.runs[i].job = "job";
        cell.runs[i].snapshot_count = snapshots;
        cell.runs[i].snapshots =
            snapshots ? mem_alloc(snapshots, sizeof *cell.runs[i].snapshots) : NULL;
    }
    return cell;
}

static inline void results_free_cell(struct results_cell *cell)
{
    for (size_t i = 0; i < cell->run_count; i++)
        mem_free(cell->runs[i].snapshots);
    mem_free(cell->runs);
}

/* The same time on all axes, the same error of all kinds; the last one is also what the
 * run ends with. */
static inline void results_set(struct results_run *run, size_t snapshot, double at,
                               double error)
{
    for (int a = 0; a < RESULTS_AXES; a++)
        run->snapshots[snapshot].at[a] = at;
    for (int e = 0; e < RESULTS_ERRORS; e++)
        run->snapshots[snapshot].error[e] = run->error[e] = error;
}

/* A standard normal deviate [BoxMuller58]. */
static inline double results_normal(struct rng *rng)
{
    const double pi = 3.14159265358979323846;
    double u = 1.0 - rng_double(rng), v = rng_double(rng);
    return sqrt(-2.0 * log(u)) * cos(2.0 * pi * v);
}

#endif

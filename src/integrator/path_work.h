#ifndef ETALON_INTEGRATOR_PATH_WORK_H
#define ETALON_INTEGRATOR_PATH_WORK_H

/* Work of a path by any integrator, in the unit of WORK_EVENT (chain/state.h), so that
 * integrators can be compared without a clock. Measured on a few independent samples. */

#include "chain/target.h"
#include "integrator/integrator.h"

#define PATH_WORK_SAMPLES 1024 /* for which path_work traces, at least */

struct sample_work {
    double all;    /* mean over samples */
    double states; /* the same weighted by targets, as the states of a chain are */
};

struct sample_work path_work_of_samples(const struct target *target, int max_splats,
                                        uint64_t seed, long count);

/* Mean work of a path of pt, bdpt, or chains in primary sample space with a given p_l;
 * statistics: of a run of it, which tell the numbers of chains and of plain samples;
 * NULL: the same number of chains for all lengths. */
double path_work(const struct integrator_type *type, const struct scene *scene,
                 const struct settings *settings,
                 const struct run_statistics *statistics);

#endif

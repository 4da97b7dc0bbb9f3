#ifndef ETALON_INTEGRATOR_PASSES_H
#define ETALON_INTEGRATOR_PASSES_H

/* Independent samples, one a pixel and pass: what pt and bdpt share. All sums are of
 * integers: the same bits for any number of threads, and for any division of the run into
 * parts. Without a time budget a round is a pass. Under one it ends within a few
 * samples, or those of a pixel, of its time and leaves a pass incomplete: the picture and
 * b include it, but replicas and spans of time, and so the error bars, do not until it is
 * complete. */

#include "base/part.h"
#include "integrator/integrator.h"
#include "integrator/split.h"
#include "path/estimate.h"

struct passes;

typedef void (*estimate_function)(struct subpaths *paths, const struct numbers *numbers,
                                  struct contrib *out);

struct passes_integrator {
    struct integrator_type type;
    estimate_function estimate;
    bool light_image; /* the estimator also splats on pixels other than its own */
};

extern const struct integrator_methods passes_methods;
extern const struct passes_integrator integrator_pt, integrator_bdpt;

/* What passes trace: paths of at most `depth` edges. */
struct passes_plan {
    int depth;
    estimate_function estimate;
    bool light_image; /* as above */
    bool may_adapt;   /* numbers of samples by pixel, where settings ask for it */
    /* NULL, or: passes render what the split leaves to them, and b is the brightness of
     * whole samples. */
    const struct split *split;
};

struct passes *passes_create(const struct scene *scene, const struct settings *settings,
                             const struct passes_plan *plan);
void passes_destroy(void *self);
/* Adds the memory of passes_create with these arguments. */
void passes_memory(const struct scene *scene, const struct settings *settings,
                   const struct passes_plan *plan, struct run_memory *out);

/* From here on traces the samples of a part only. What was traced before, by all parts
 * alike, is kept by the first one. */
void passes_set_part(struct passes *p, struct run_part part);
/* Traces about `paths` more paths at most, rounded up to rows and to the end of an
 * incomplete pass; ends when clock_wall() reaches `until` (INFINITY: never) or *stop is
 * set (NULL: never). */
void passes_trace(struct passes *p, double paths, double until,
                  const volatile sig_atomic_t *stop);
/* Paths and whole passes so far, those of the other parts included. */
double passes_paths(const struct passes *p);
long passes_whole(const struct passes *p);

/* The methods of struct integrator_methods that the chains' integrators use too. */
void passes_picture(void *self, struct image *out);
void passes_layers(void *self, struct layers *out);
/* Adds the layers by class of light alone. */
void passes_light_layers(const struct passes *p, struct layers *out);
void passes_statistics(const void *self, struct run_statistics *out);
void passes_counts(const void *self, struct run_counts *out);
void passes_pack(void *self, struct pack *pack);
void passes_evidence(void *self, struct evidence *out);

void passes_fixed_picture(void *self, struct fixed_picture *out);
/* Adds the sums of a pixel of that picture. */
void passes_add_fixed(const struct passes *p, long pixel, exact_sum sums[3]);
/* Number of replicas that have a pass. */
int passes_replicas_with_pass(const struct passes *p, int replicas);
/* Adds the deviations of the replicas (struct evidence) to out[replicas]. */
void passes_add_deviations(const struct passes *p, long pixel, int replicas, double *out);

#endif

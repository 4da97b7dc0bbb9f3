#ifndef ETALON_INTEGRATOR_PASSES_H
#define ETALON_INTEGRATOR_PASSES_H

/* Independent samples, one a pixel and round: what pt and bdpt share. Camera pixels are
 * summed in the order of passes, light images in integers: the same bits for any number
 * of threads. */

#include "integrator/integrator.h"
#include "path/estimate.h"

struct passes;

typedef void (*estimate_function)(struct subpaths *paths, const struct numbers *numbers,
                                  struct contrib *out);

/* Paths of at most `depth` edges. light_image: the estimator splats on other pixels than
 * its own. */
struct passes *passes_create(const struct scene *scene, const struct settings *settings,
                             int depth, estimate_function estimate, bool light_image);
void passes_destroy(void *self);
/* Adds what one with these arguments will take at most. */
void passes_memory(const struct scene *scene, const struct settings *settings, int depth,
                   bool light_image, struct run_memory *out);

/* The functions of integrator_type on a struct passes. */
bool passes_advance(void *self, const struct round_limits *limits);
bool passes_started(const void *self);
void passes_picture(void *self, struct image *out);
void passes_statistics(const void *self, struct run_statistics *out);
double passes_progress(const void *self);
void passes_pack(void *self, struct pack *pack);
void passes_evidence(void *self, struct evidence *out);

/* Replicas that have a pass. */
int passes_units(const struct passes *p, int replicas);
/* Adds the deviations of struct evidence to out[replicas], as many as p has. */
void passes_add_deviations(const struct passes *p, long pixel, int replicas, double *out);

#endif

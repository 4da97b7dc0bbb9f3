#ifndef ETALON_REPORT_REPORT_REFERENCE_H
#define ETALON_REPORT_REPORT_REFERENCE_H

/* Finds the reference that the errors of a run were measured against. */

#include "analysis/results.h"

#include "image/image.h"

/* The path of the reference of the run whose picture is `image`: what its column says, as
 * it stands or from the results' folder; without such a column, of the references
 * FOLDER/SCENE-KEY/mean.exr the one against which the picture has the very error that its
 * row states. NULL if there is none. The caller owns it (mem_free). */
char *report_reference_find(const struct results *results,
                            const struct results_cell *cell,
                            const struct results_run *run, const struct image *image,
                            const char *folder);

/* The part of each error that is due to the reference's noise (lab/reference_noise.h);
 * false, with nothing of use in `noise`, if it is not known. */
bool report_reference_noise(const char *path, double noise[RESULTS_ESTIMATED]);

#endif

#ifndef ETALON_LAB_REFERENCE_CHECK_H
#define ETALON_LAB_REFERENCE_CHECK_H

/* Rejects references that would hide errors or measure something else: rendered by the
 * method under test (its bias would not show), with the seed of the job (correlated
 * errors), to another depth (another picture), or by a method that cannot sample all
 * light of the scene (run/blind_spots.h). The facts come from the picture's attributes
 * etalon:..., for a mean from those of its halves beside it; a fact that the file does
 * not state is not checked. */

#include "lab/reference.h"

/* How a reference was made, as far as its file states it. Zero-initialise. */
struct provenance {
    char *integrator, *estimator; /* NULL: not stated; estimator "" without chains */
    char *builder;                /* of pssmlt; NULL or "": not stated */
    long max_depth;               /* edges; 0: not stated */
    long seeds[REFERENCE_HALVES];
    int seed_count;
};

void provenance_deinit(struct provenance *provenance);
void provenance_of_file(const char *path, struct provenance *provenance);
void provenance_of_request(const struct reference_request *request,
                           struct provenance *provenance);

/* settings: all settings of the job; max_depth: as resolved, edges; desc: its scene;
 * own_method: one by the method under test passes. False with one line at the reference's
 * place in the experiment file. */
bool reference_check(const struct job *job, const struct settings *settings,
                     int max_depth, const struct scene_desc *desc,
                     const struct provenance *provenance, bool own_method,
                     struct err *err);

#endif

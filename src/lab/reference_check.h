#ifndef ETALON_LAB_REFERENCE_CHECK_H
#define ETALON_LAB_REFERENCE_CHECK_H

/* References that would flatter a job or measure something else: made by the method under
 * test (an error of the method would not show), with the job's seed (their errors may
 * hang together), to another depth (another picture), or by a method that cannot sample
 * all light of the scene (run/blind_spots.h). A file tells by its attributes
 * etalon:..., a mean by those of its halves beside it; what a file does not tell is not
 * held against it. */

#include "lab/reference.h"

/* What a reference says of itself. Zero-initialise. */
struct provenance {
    char *integrator, *estimator; /* NULL: it does not say; estimator "" without chains */
    char *builder;                /* of pssmlt; NULL or "": it does not say */
    long max_depth;               /* edges; 0: it does not say */
    long seeds[REFERENCE_HALVES];
    int seed_count;
};

void provenance_deinit(struct provenance *provenance);
void provenance_of_file(const char *path, struct provenance *provenance);
void provenance_of_request(const struct reference_request *request,
                           struct provenance *provenance);

/* settings: all that hold for the job; max_depth: as resolved, edges; desc: its scene.
 * False with one line at the experiment's place of the reference. */
bool reference_check(const struct job *job, const struct settings *settings,
                     int max_depth, const struct scene_desc *desc,
                     const struct provenance *provenance, struct err *err);

#endif

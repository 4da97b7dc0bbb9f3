#ifndef ETALON_LAB_REFERENCE_H
#define ETALON_LAB_REFERENCE_H

/* Reference pictures that are rendered once and used again: the mean of two halves of
 * different seeds, A and B, so that the reference's own noise is known too:
 * E[((A-B)/2)^2] is the variance of (A+B)/2, and A - (A+B)/2 is (A-B)/2. Kept in
 *
 *   FOLDER/LABEL-KEY/half1.exr, half2.exr, mean.exr, noise.yaml
 *
 * KEY stands for the scene's contents, size, depth, integrator, settings and budget, not
 * for the program. noise.yaml, which is written last, holds the errors of half1.exr
 * against mean.exr: those of mean.exr against the truth. */

#include "base/hash.h"
#include "integrator/run.h"
#include "lab/experiment.h"

struct reference_request {
    const struct reference_spec *spec; /* of kind REFERENCE_RENDERED */
    const struct scene *scene;         /* built in the size that is asked for */
    struct settings settings;          /* the scene file's and, of the job's, max_depth,
                                        * size, keep_all and threads */
    uint64_t scene_fingerprint;
    const char *label;                 /* of the scene */
    const char *folder;                /* of all references; made if there is none */
    const volatile sig_atomic_t *stop; /* as in struct run_options */
    /* Before each half that is rendered, and while; may be NULL. */
    void (*on_half)(void *hook_ctx, const char *folder, int half);
    void (*on_progress)(void *hook_ctx, const struct run_progress *progress);
    void *hook_ctx;
};

/* The picture, or NULL: on failure, or, with err->code ERR_NONE, if it was stopped. Of
 * two processes that want the same reference the later one waits for the other's. */
struct image *reference_obtain(const struct reference_request *request, struct err *err);

#endif

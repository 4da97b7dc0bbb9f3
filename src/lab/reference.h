#ifndef ETALON_LAB_REFERENCE_H
#define ETALON_LAB_REFERENCE_H

/* Reference pictures and their own noise. Those that are rendered are made once and used
 * again: the mean of two halves of different seeds, A and B, so that the noise is known:
 * E[((A-B)/2)^2] is the variance of (A+B)/2, and A - (A+B)/2 is (A-B)/2. Kept in
 *
 *   FOLDER/LABEL-KEY/half1.exr, half2.exr, mean.exr, noise.yaml
 *
 * KEY stands for the scene's contents, size, depth, integrator, settings and budget, not
 * for the program. noise.yaml, which is written last, holds the errors of half1.exr
 * against mean.exr: those of mean.exr against the truth. */

#include "run/run.h"
#include "lab/jobs.h"

/* Far from the seeds of jobs: a half would hang together with a run of its own seed. */
#define REFERENCE_SEED   1000000001L /* of the first half; the second has the next one */
#define REFERENCE_HALVES 2

/* Zero-initialise. */
struct reference {
    struct image *picture; /* NULL: there is none */
    char *path;            /* of the picture */
    double rmse, relmse;   /* of the picture against the truth; NAN: not known */
};

void reference_deinit(struct reference *reference);

/* Of one that is rendered. */
struct reference_request {
    const struct reference_spec *spec;
    struct settings settings; /* of the whole, but for the seed */
    uint64_t scene_fingerprint;
    int width, height, max_depth;
    const char *label;  /* of the scene */
    const char *folder; /* of all references; made if there is none */
    const struct scene
        *scene; /* built in that size; not needed to ask whether it is made */
    const volatile sig_atomic_t *stop; /* as in struct run_options */
    /* Before each half that is rendered, and while; may be NULL. */
    void (*on_half)(void *hook_ctx, const char *folder, int half);
    void (*on_progress)(void *hook_ctx, const struct run_progress *progress);
    void *hook_ctx;
};

/* For this job: file are the settings of its scene file, own all that hold for the job;
 * the size, the depth, the scene, the folder and the hooks remain to be filled in, and
 * the threads if they are 0. Fails if the settings of the reference do not go together.
 */
bool reference_request_init(struct reference_request *request, const struct job *job,
                            const struct settings *file, const struct settings *own,
                            struct err *err);

/* FOLDER/LABEL-KEY; the caller owns it (mem_free). */
char *reference_folder(const struct reference_request *request);
bool reference_is_made(const struct reference_request *request);

/* Reads it, and makes it before if need be. False on failure, or, with err->code
 * ERR_NONE, if it was stopped. Of two processes that want the same reference the later
 * one waits for the other's. */
bool reference_obtain(const struct reference_request *request,
                      struct reference *reference, struct err *err);

/* A picture of the user's. Its noise is known if it is a mean.exr with its noise.yaml. */
bool reference_read(const struct reference_spec *spec, struct reference *reference,
                    struct err *err);

/* How results in `folder` call the picture: relative to it if it lies below the folder
 * that holds it, so that both can be moved together; else absolute. To be freed. */
char *reference_path_from(const struct reference *reference, const char *folder);

#endif

#ifndef ETALON_LAB_REFERENCE_H
#define ETALON_LAB_REFERENCE_H

/* Reference pictures and their own noise. A rendered reference is made once and reused.
 * It is the mean of two halves A and B with different seeds, so that its noise can be
 * measured: E[((A-B)/2)^2] is the variance of (A+B)/2 (image/noise.h). Files:
 *
 *   FOLDER/LABEL-KEY/half1.exr, half2.exr, mean.exr, noise.yaml
 *
 * KEY is a hash of the scene's contents, size, depth, integrator, settings and budget,
 * but not of the program. noise.yaml (lab/reference_noise.h) is written last. */

#include "image/noise.h"
#include "run/run.h"
#include "lab/jobs.h"

/* Seed of the first half; the second has the next one. Far from the seeds of jobs, as
 * pictures of one seed have correlated errors. */
#define REFERENCE_SEED   1000000001L /* the second half has the next one */
#define REFERENCE_HALVES 2

/* Zero-initialise. */
struct reference {
    struct image *picture; /* NULL: there is none */
    char *path;            /* of the picture */
    struct noise noise;    /* of the picture against the truth; NAN: not known */
};

void reference_deinit(struct reference *reference);

/* A reference that is to be rendered. */
struct reference_request {
    const struct reference_spec *spec;
    struct settings settings; /* of both halves, except for the seed */
    uint64_t scene_fingerprint;
    int width, height, max_depth;
    const char *label;         /* of the scene */
    const char *folder;        /* of all references; created if it does not exist */
    const struct scene *scene; /* built in that size; not needed by reference_is_made */
    const volatile sig_atomic_t *stop; /* as in struct run_options */
    /* Called before each half that is rendered, and during rendering; may be NULL. */
    void (*on_half)(void *hook_ctx, const char *folder, int half);
    void (*on_progress)(void *hook_ctx, const struct run_progress *progress);
    void *hook_ctx;
};

/* Sets up the request of a job. file: settings of the scene file; own: all settings of
 * the job. The caller fills in size, depth, scene, folder, hooks, and the threads if they
 * are 0. Fails if the settings of the reference are incompatible. */
bool reference_request_init(struct reference_request *request, const struct job *job,
                            const struct settings *file, const struct settings *own,
                            struct err *err);

/* FOLDER/LABEL-KEY; the caller owns it (mem_free). */
char *reference_folder(const struct reference_request *request);
bool reference_is_made(const struct reference_request *request);

/* Reads the reference, and renders it first if it does not exist. False on failure; false
 * with err->code ERR_NONE if it was stopped. If two processes want the same reference,
 * the second waits for the first. */
bool reference_obtain(const struct reference_request *request,
                      struct reference *reference, struct err *err);

/* Reads a picture, for example one that the user gave. Its noise is known if it is a
 * mean.exr with a noise.yaml. at: where the path was given, or NULL. */
bool reference_read(const char *path, const struct place *at, struct reference *reference,
                    struct err *err);

/* The path by which results in `folder` refer to the picture: relative if the picture is
 * below the parent of `folder`, so that both can be moved together; else absolute. To be
 * freed. */
char *reference_path_from(const struct reference *reference, const char *folder);

#endif

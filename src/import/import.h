#ifndef ETALON_IMPORT_IMPORT_H
#define ETALON_IMPORT_IMPORT_H

/* Scene files to scene descriptions; the kind follows from the file name's ending.
 * Warnings are counted in desc->log; errors carry file:line:col. NULL on failure. */

#include "scene/scene_desc.h"

#define IMPORT_ERRORS_MAX 10

/* What a reading that failed leaves behind. */
struct import_failure {
    struct log log; /* notes until then */
    /* All that was found to be wrong, the first included, where a format goes on after an
     * error. */
    struct err errors[IMPORT_ERRORS_MAX];
    int error_count;
};

struct import_options {
    int threads; /* that decode meshes and pictures; the outcome is the same for any */
    /* NULL, or called by one thread with the number of files that are done. */
    void (*progress)(void *ctx, long done, long count);
    void *progress_ctx;
    /* "name=value" for a Mitsuba file's $name, before its <default>; other kinds of file
     * have no parameters, which is an error, as is one that the file does not have. */
    const char *const *definitions;
    int definition_count;
    struct import_failure *failure; /* zero-initialised, or NULL */
};

/* options: NULL for one thread and silence. */
struct scene_desc *import_scene(const char *path, const struct import_options *options,
                                struct err *err); /* by ending */
struct scene_desc *import_yaml(const char *path, const struct import_options *options,
                               struct err *err);
struct scene_desc *import_pbrt(const char *path, const struct import_options *options,
                               struct err *err);
struct scene_desc *import_mitsuba(const char *path, const struct import_options *options,
                                  struct err *err);

/* For readers. An error is added once, *err is the first; whether to go on for more. */
bool import_failure_add(const struct import_options *options, const struct err *failure,
                        struct err *err);
/* Destroys the desc but for its notes; NULL. */
struct scene_desc *import_failure_give_up(const struct import_options *options,
                                          struct scene_desc *desc);
void import_failure_deinit(struct import_failure *failure);

/* A PLY file, also packed (.ply.gz): ascii and both binary orders. Concave polygons are
 * triangulated by ear clipping; faces of fewer than three corners are skipped
 * (mesh->remarks). Strict: any count that exceeds the file's size is an error. `at`:
 * place of the reference to the file. */
struct mesh *import_ply(const char *path, const struct place *at, struct err *err);

/* A Wavefront OBJ file as one mesh, with polygons as in PLY files; groups and materials
 * are ignored. Corners with the same position, texture coordinate and normal are one
 * vertex. v goes upwards, as in the file. */
struct mesh *import_obj(const char *path, const struct place *at, struct err *err);

/* The mesh of that number (from 0) in a file of Mitsuba's .serialized. Strict, as PLY. */
struct import_serialized_flags {
    bool face_normals; /* the file wants no shading normals */
    bool colours;      /* it holds colours, which were passed over */
};
struct mesh *import_serialized(const char *path, int index,
                               struct import_serialized_flags *flags,
                               const struct place *at, struct err *err);

#endif

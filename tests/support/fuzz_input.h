#ifndef ETALON_TESTS_SUPPORT_FUZZ_INPUT_H
#define ETALON_TESTS_SUPPORT_FUZZ_INPUT_H

/* How an input of the fuzzers is read: by them (tests/fuzz) and when what they found is
 * read once more (tests/unit/test_import_replay.c).
 *
 * An input is a file and, behind lines "@@ name", the files that it may name, so that
 * those are damaged too. They are written to a folder of the process's own, read, and
 * removed. Whatever is in them, a reader must end with a result that holds together or
 * with one line of error; else the process aborts. */

#include "base/text.h"
#include "image/exr.h"
#include "import/import.h"
#include "lab/jobs.h"
#include "lab/scene_settings.h"
#include "support/serialized_make.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define FUZZ_FILES 8
#define FUZZ_NAME  24 /* bytes of a file's name, with the zero */

struct fuzz_input {
    char folder[64];
    char names[FUZZ_FILES][FUZZ_NAME];
    int count;
    char path[128]; /* of the first file */
};

#define FUZZ_WANT(condition)                                                        \
    do {                                                                            \
        if (!(condition)) {                                                         \
            fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #condition); \
            abort();                                                                \
        }                                                                           \
    } while (0)

/* --- files ------------------------------------------------------------------------- */

static inline void fuzz_path(const struct fuzz_input *in, const char *name,
                             char path[128])
{
    snprintf(path, 128, "%s/%s", in->folder, name);
}

static inline void fuzz_write(struct fuzz_input *in, const char *name,
                              const uint8_t *data, size_t size)
{
    char path[128];
    fuzz_path(in, name, path);
    FILE *f = fopen(path, "wb");
    FUZZ_WANT(f && fwrite(data, 1, size, f) == size && fclose(f) == 0);
    snprintf(in->names[in->count++], FUZZ_NAME, "%s", name);
}

/* The name in a line "@@ name" at data; its length with the line's end, or 0. */
static inline size_t fuzz_header(const uint8_t *data, size_t size, char name[FUZZ_NAME])
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyz0123456789.";
    size_t length = 0;
    if (size < 5 || memcmp(data, "@@ ", 3) != 0 || data[3] < 'a' || data[3] > 'z')
        return 0;
    for (size_t i = 3; i < size && data[i] && strchr(letters, data[i]); i++)
        if (++length == FUZZ_NAME)
            return 0;
    if (3 + length == size || data[3 + length] != '\n')
        return 0;
    memcpy(name, data + 3, length);
    name[length] = '\0';
    return length + 4;
}

/* Writes the files, the first under `name`. */
static inline void fuzz_open(struct fuzz_input *in, const char *name, const uint8_t *data,
                             size_t size)
{
    char current[FUZZ_NAME], next[FUZZ_NAME];
    const char *directory = getenv("TEST_TMP");
    size_t begin = 0;
    in->count = 0;
    snprintf(in->folder, sizeof in->folder, "%s/fuzz%ld",
             directory                  ? directory
             : access("/dev/shm", W_OK) ? P_tmpdir
                                        : "/dev/shm",
             (long)getpid());
    mkdir(in->folder, 0777);
    fuzz_path(in, name, in->path);
    snprintf(current, sizeof current, "%s", name);
    const uint8_t *found = data;
    while (in->count < FUZZ_FILES - 1 &&
           (found = memmem(found, size - (size_t)(found - data), "\n@@ ", 4))) {
        size_t at = (size_t)(++found - data);
        size_t length = fuzz_header(found, size - at, next);
        if (length == 0)
            continue;
        fuzz_write(in, current, data + begin, at - begin);
        begin = at + length;
        found = data + begin - 1; /* an empty file may follow */
        memcpy(current, next, sizeof current);
    }
    fuzz_write(in, current, data + begin, size - begin);
}

static inline void fuzz_close(const struct fuzz_input *in)
{
    char path[128];
    for (int i = 0; i < in->count; i++) {
        fuzz_path(in, in->names[i], path);
        unlink(path);
    }
    rmdir(in->folder);
}

/* --- what comes out ---------------------------------------------------------------- */

/* A result, or one line that says what is wrong and in which file. */
static inline void fuzz_check_error(bool read, const struct err *err)
{
    char line[1200];
    FUZZ_WANT(read == (err->code == ERR_NONE));
    if (read)
        return;
    err_format(err, line, sizeof line);
    FUZZ_WANT(err->message[0] && err->file[0] && err->line >= 0 && err->col >= 0);
    FUZZ_WANT(!strpbrk(line, "\n\r"));
}

static inline void fuzz_check_mesh(const struct mesh *mesh)
{
    FUZZ_WANT(mesh->vertex_count > 0);
    for (size_t i = 0; i < 3 * (size_t)mesh->triangle_count; i++)
        FUZZ_WANT(mesh->index[i] < mesh->vertex_count);
}

static inline void fuzz_check_scene(const struct scene_desc *desc)
{
    /* Without a camera there is no film either; building the scene says so. */
    FUZZ_WANT(desc->camera.fov == 0.0 || (desc->width > 0 && desc->height > 0));
    FUZZ_WANT(desc->max_depth >= 0);
    for (size_t i = 0; i < desc->shape_count; i++) {
        const struct shape_desc *shape = &desc->shapes[i];
        FUZZ_WANT(shape->material >= 0 && (size_t)shape->material < desc->material_count);
        FUZZ_WANT((shape->kind == SHAPE_MESH) == (shape->mesh != NULL));
        FUZZ_WANT(shape->radiance.r >= 0.0 && shape->radiance.g >= 0.0 &&
                  shape->radiance.b >= 0.0);
        if (shape->mesh)
            fuzz_check_mesh(shape->mesh);
    }
}

/* --- the readers: whether they accepted the input ---------------------------------- */

static inline void fuzz_progress(void *ctx, long done, long count)
{
    (void)ctx;
    FUZZ_WANT(done >= 0 && done <= count);
}

/* Twice: files read ahead (asked for here by the progress) change nothing. */
static inline bool fuzz_scene(const char *name, const uint8_t *data, size_t size)
{
    struct fuzz_input in;
    struct err err = {0}, second = {0};
    struct import_options options = {.threads = 1, .progress = fuzz_progress};
    fuzz_open(&in, name, data, size);
    struct scene_desc *desc = import_scene(in.path, NULL, &err);
    struct scene_desc *ahead = import_scene(in.path, &options, &second);
    fuzz_check_error(desc != NULL, &err);
    FUZZ_WANT((desc != NULL) == (ahead != NULL) && err.line == second.line &&
              err.col == second.col && text_equal(err.message, second.message));
    if (desc) {
        struct settings settings;
        struct err wrong = {0};
        fuzz_check_scene(desc);
        FUZZ_WANT(desc->log.count == ahead->log.count &&
                  desc->shape_count == ahead->shape_count);
        settings_init(&settings);
        fuzz_check_error(scene_settings_apply(desc, &settings, &wrong), &wrong);
    }
    bool read = desc != NULL;
    scene_desc_destroy(desc);
    scene_desc_destroy(ahead);
    fuzz_close(&in);
    return read;
}

static inline bool fuzz_experiment(const uint8_t *data, size_t size)
{
    struct fuzz_input in;
    struct err err = {0};
    struct jobs jobs = {0};
    fuzz_open(&in, "main.yaml", data, size);
    struct experiment *experiment = experiment_load(in.path, &err);
    bool made = false;
    fuzz_check_error(experiment != NULL, &err);
    if (experiment) {
        made = jobs_make(experiment, &jobs, &err);
        fuzz_check_error(made, &err);
        FUZZ_WANT(!made || jobs.count > 0);
        jobs_deinit(&jobs);
    }
    experiment_destroy(experiment);
    fuzz_close(&in);
    return made;
}

static inline bool fuzz_mesh(const char *name, const uint8_t *data, size_t size)
{
    struct fuzz_input in;
    struct err err = {0};
    struct import_serialized_flags flags;
    struct place at = {in.path, 0, 0}; /* who asks */
    struct mesh *mesh;
    fuzz_open(&in, name, data, size);
    if (text_ends_with(name, ".obj"))
        mesh = import_obj(in.path, &at, &err);
    else if (text_ends_with(name, ".serialized"))
        mesh = import_serialized(in.path, 0, &flags, &at, &err);
    else
        mesh = import_ply(in.path, &at, &err);
    fuzz_check_error(mesh != NULL, &err);
    if (mesh)
        fuzz_check_mesh(mesh);
    bool read = mesh != NULL;
    mesh_destroy(mesh);
    fuzz_close(&in);
    return read;
}

static inline bool fuzz_pbrt(const uint8_t *data, size_t size)
{
    bool lux = size > 4 && memcmp(data, "#lux", 4) == 0;
    return fuzz_scene(lux ? "main.lxs" : "main.pbrt", data, size);
}

static inline bool fuzz_mitsuba(const uint8_t *data, size_t size)
{
    return fuzz_scene("main.xml", data, size);
}

/* As either kind of file: the other reader stops at the first key. */
static inline bool fuzz_yaml(const uint8_t *data, size_t size)
{
    bool scene = fuzz_scene("main.yaml", data, size);
    return fuzz_experiment(data, size) || scene;
}

static inline bool fuzz_ply(const uint8_t *data, size_t size)
{
    bool packed = size > 2 && data[0] == 0x1f && data[1] == 0x8b;
    return fuzz_mesh(packed ? "main.ply.gz" : "main.ply", data, size);
}

static inline bool fuzz_obj(const uint8_t *data, size_t size)
{
    return fuzz_mesh("main.obj", data, size);
}

/* What does not begin as a file is the body of a mesh: damage to compressed data is
 * seldom more than that. */
static inline bool fuzz_serialized(const uint8_t *data, size_t size)
{
    struct serialized file = {.size = 0}, body = {.size = size};
    if (size > sizeof body.data / 2)
        return false;
    if (size > 2 && data[0] == 0x1c && data[1] == 0x04)
        return fuzz_mesh("main.serialized", data, size);
    memcpy(body.data, data, size);
    size_t offset = serialized_add(&file, 4, &body);
    serialized_end(&file, 4, &offset, 1);
    return fuzz_mesh("main.serialized", file.data, file.size);
}

static inline bool fuzz_exr(const uint8_t *data, size_t size)
{
    struct fuzz_input in;
    struct err err = {0};
    struct place at = {in.path, 0, 0}; /* who asks */
    fuzz_open(&in, "main.exr", data, size);
    struct image *image = exr_read(in.path, &at, &err);
    fuzz_check_error(image != NULL, &err);
    FUZZ_WANT(!image || (image->width > 0 && image->height > 0));
    bool read = image != NULL;
    image_destroy(image);
    fuzz_close(&in);
    return read;
}

#endif

#ifndef ETALON_TESTS_SUPPORT_TEST_PARTS_H
#define ETALON_TESTS_SUPPORT_TEST_PARTS_H

/* Runs in parts, each to a file of its own, and their merge. */

#include "support/test_file.h"
#include "support/test_run.h"

#include <signal.h>
#include <stdlib.h>

enum { PARTS_TESTED = 8 };

static inline char *file_name(const char *name, int index)
{
    char number[64];
    snprintf(number, sizeof number, "parts.%s%d", name, index);
    return test_file(number);
}

/* --- parts ------------------------------------------------------------------------ */

struct job {
    const struct scene *scene;
    struct settings settings;
    struct identity identity;
    int count;
    const char *start; /* file of the measured start, or NULL */
    int team;          /* threads of the second part; 0: 1 */
    double stop_at;    /* a part is stopped at this share and resumed; 0: never */
};

struct stopper {
    volatile sig_atomic_t stop;
    double at;
};

static inline void stop_late(void *ctx, const struct run_progress *progress)
{
    struct stopper *stopper = ctx;
    stopper->stop = progress->share >= stopper->at;
}

/* From `from` (NULL: the beginning), to the file `to`. */
static inline void run_part(struct job *job, int index, const char *from, const char *to,
                            double stop_at)
{
    struct err err = {0};
    struct run_result r = {0};
    struct checkpoint checkpoint;
    struct run_part part = {index, job->count};
    struct stopper stopper = {0, stop_at};
    struct checkpoint_options writing = {
        .path = to, .every = (double)INFINITY, .identity = &job->identity};
    struct run_options options = {
        .scene = job->scene,
        .settings = &job->settings,
        .part = part,
        .checkpoint = &writing,
        .stop = stop_at > 0.0 ? &stopper.stop : NULL,
        .on_progress = stop_late,
        .hook_ctx = &stopper,
    };
    if (from) {
        if (!checkpoint_open(&checkpoint, from, &job->identity, &job->settings, part,
                             &err))
            test_scene_die(&err);
        options.resume = &checkpoint;
    }
    if (!run_render(&options, &r, &err))
        test_scene_die(&err);
    run_result_deinit(&r);
}

static inline void run_parts(struct job *job, char *files[PARTS_TESTED])
{
    for (int i = 0; i < job->count; i++) {
        files[i] = file_name("part", i);
        job->settings.threads = i == 1 && job->team > 0 ? job->team : 1;
        run_part(job, i, job->start, files[i], job->stop_at);
        if (job->stop_at > 0.0)
            run_part(job, i, files[i], files[i], 0.0);
    }
}

static inline void remove_parts(const struct job *job, char *files[PARTS_TESTED])
{
    for (int i = 0; i < job->count; i++) {
        remove(files[i]);
        mem_free(files[i]);
    }
}

/* missing: a bit for each part that is left out. */
static inline struct run_result merge(struct job *job, char *files[PARTS_TESTED],
                                      unsigned missing)
{
    struct err err = {0};
    struct run_result r = {0};
    struct checkpoint parts[PARTS_TESTED];
    struct run_options options = {.scene = job->scene, .settings = &job->settings};
    int count = 0;
    for (int i = job->count - 1; i >= 0; i--) /* in any order */
        if (!(missing >> i & 1) &&
            !checkpoint_open(&parts[count++], files[i], &job->identity, &job->settings,
                             (struct run_part){i, job->count}, &err))
            test_scene_die(&err);
    if (!run_merge(&options, parts, count, &r, &err))
        test_scene_die(&err);
    return r;
}

static inline struct job job_of(const struct scene *scene, const char *const *words)
{
    struct job job = {.scene = scene, .settings = test_settings(words)};
    identity_add(&job.identity, "name", "%s", "value");
    return job;
}

/* The start of all, as 'etalon startup --save' makes it. */
static inline void save_start(struct job *job, const char *path)
{
    struct err err = {0};
    struct run_result r = {0};
    struct checkpoint_options writing = {
        .path = path, .every = (double)INFINITY, .identity = &job->identity};
    struct run_options options = {.scene = job->scene,
                                  .settings = &job->settings,
                                  .startup_only = true,
                                  .checkpoint = &writing};
    if (!run_render(&options, &r, &err))
        test_scene_die(&err);
    run_result_deinit(&r);
}

#endif

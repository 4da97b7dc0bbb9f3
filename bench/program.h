#ifndef ETALON_BENCH_PROGRAM_H
#define ETALON_BENCH_PROGRAM_H

/* What programs of this folder that render have in common. What fails ends them, with 1.
 */

#include "import/import.h"
#include "run/run.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Ends the program with 1. */
static inline _Noreturn void program_die(const struct err *err)
{
    char text[sizeof err->file + sizeof err->message + 64];
    err_format(err, text, sizeof text);
    fprintf(stderr, "%s: %s\n", program_invocation_short_name, text);
    exit(1);
}

/* word: key=value */
static inline void program_set(struct settings *settings, const char *word)
{
    char key[64];
    const char *equal = strchr(word, '=');
    struct err err = {0};
    snprintf(key, sizeof key, "%.*s", equal ? (int)(equal - word) : 63, word);
    if (!settings_set(settings, key, equal ? equal + 1 : "", NULL, &err))
        program_die(&err);
}

static inline struct scene *program_open_scene(const char *path,
                                               const struct settings *settings)
{
    struct err err = {0};
    struct scene_desc *desc = import_scene(path, NULL, &err);
    struct scene_options options = {.width = (int)settings->width,
                                    .height = (int)settings->height,
                                    .keep_all = settings->keep_all};
    struct scene *scene = desc ? scene_build(desc, &options, &err) : NULL;
    if (scene == NULL)
        program_die(&err);
    return scene;
}

static inline struct run_result program_render(const struct scene *scene,
                                               const struct settings *settings)
{
    struct run_options options = {.scene = scene, .settings = settings};
    struct run_result result = {0};
    struct err err = {0};
    if (!settings_check(settings, &err) || !run_render(&options, &result, &err))
        program_die(&err);
    return result;
}

#endif

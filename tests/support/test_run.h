#ifndef ETALON_TESTS_SUPPORT_TEST_RUN_H
#define ETALON_TESTS_SUPPORT_TEST_RUN_H

/* Whole runs on a test scene. */

#include "run/run.h"
#include "support/test_scene.h"

#include <string.h>

/* Settings from "key=value" words, ended by NULL. */
static inline struct settings test_settings(const char *const *words)
{
    struct settings s;
    struct err err = {0};
    settings_init(&s);
    s.threads = 1; /* a team of threads costs more than such films take */
    for (; *words; words++) {
        char key[64];
        const char *equal = strchr(*words, '=');
        snprintf(key, sizeof key, "%.*s", (int)(equal - *words), *words);
        if (!settings_set(&s, key, equal + 1, NULL, &err))
            test_scene_die(&err);
    }
    if (!settings_check(&s, &err))
        test_scene_die(&err);
    return s;
}

static inline struct run_result test_run(const struct scene *scene,
                                         const struct settings *settings)
{
    struct run_options options = {.scene = scene, .settings = settings};
    struct run_result result = {0};
    struct err err = {0};
    if (!run_render(&options, &result, &err))
        test_scene_die(&err);
    return result;
}

static inline struct rgb test_image_mean(const struct image *image)
{
    struct rgb sum = {0.0, 0.0, 0.0};
    long n = (long)image->width * image->height;
    for (long i = 0; i < n; i++)
        sum = rgb_add(sum,
                      rgb((double)image->pixels[3 * i], (double)image->pixels[3 * i + 1],
                          (double)image->pixels[3 * i + 2]));
    return rgb_scale(sum, 1.0 / (double)n);
}

/* Luminance of the picture's mean over b. Where every mutation weighs 1, and where every
 * sample is in the picture, it is 1: no step is lost, none counted twice. Floats round to
 * 6e-8. */
static inline double test_mean_over_b(const struct run_result *r)
{
    return rgb_luminance(test_image_mean(r->image)) / r->statistics.b;
}

#endif

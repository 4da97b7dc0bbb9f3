/* noise.yaml: figures by today's definition are taken as they stand, others are taken
 * anew from half1.exr or are not known. */
#include "lab/reference.h"
#include "lab/reference_noise.h"

#include "base/mem.h"
#include "base/text.h"
#include "image/exr.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

static int set_up(void **state)
{
    char folder[] = "/tmp/etalon_noise_XXXXXX";
    *state = mkdtemp(folder) ? text_copy(folder) : NULL;
    return *state ? 0 : -1;
}

static int tear_down(void **state)
{
    static const char *const names[] = {"noise.yaml", "half1.exr", "mean.exr"};
    for (int i = 0; i < 3; i++) {
        char *path = text_join(*state, names[i]);
        unlink(path);
        mem_free(path);
    }
    rmdir(*state);
    mem_free(*state);
    return 0;
}

static void write_noise(const char *folder, const char *text)
{
    char *path = text_join(folder, "noise.yaml");
    assert_true(text_write_file(path, text, strlen(text), NULL));
    mem_free(path);
}

/* 10 x 10 pixels of 1; the half is .5 above in one. */
static struct image *picture(bool half)
{
    struct image *image = image_create(10, 10);
    for (int i = 0; i < 300; i++)
        image->pixels[i] = half && i < 3 ? 1.5f : 1.0f;
    return image;
}

static void write_picture(const char *folder, const char *name, bool half)
{
    static const struct exr_attribute mean[] = {{"etalon:mean_of", "half1.exr"}};
    struct image *image = picture(half);
    char *path = text_join(folder, name);
    assert_true(exr_write(path, image, mean, half ? 0 : 1, NULL, NULL));
    image_destroy(image);
    mem_free(path);
}

static const char old[] = "mean_ratio: 1\nrmse: 7\nrelmse: 7\nrelmse_trimmed: 7\n";
static const char others[] = "rmse: 7\nrelmse: 7\nrelmse_se: 7\nrelmse_trimmed: 7\n"
                             "relmse_trim: 0.001\nrelmse_weight: neighbours\n";

static void todays_figures_are_taken(void **state)
{
    struct reference_noise read;
    struct noise noise = {0.5, 0.25, 0.125, 0.0625};
    struct image *mean = picture(false);
    assert_true(reference_noise_write(*state, &noise, NULL));
    write_picture(*state, "half1.exr", true);
    assert_true(reference_noise_read(*state, mean, &read, NULL));
    assert_false(read.from_pictures);
    assert_memory_equal(&read.noise, &noise, sizeof noise);
    image_destroy(mean);
}

static void older_figures_are_not(void **state)
{
    const char *const texts[] = {old, others};
    struct image *mean = picture(false);
    struct reference_noise read;
    for (int i = 0; i < 2; i++) {
        write_noise(*state, texts[i]);
        assert_true(reference_noise_read(*state, mean, &read, NULL));
        assert_true(read.from_pictures && isnan(read.noise.relmse) &&
                    isnan(read.noise.rmse) && isnan(read.noise.relmse_trimmed));
    }
    write_picture(*state, "half1.exr", true);
    for (int i = 0; i < 2; i++) {
        write_noise(*state, texts[i]);
        assert_true(reference_noise_read(*state, mean, &read, NULL));
        assert_true(read.from_pictures);
        assert_true(fabs(read.noise.relmse - 0.0025 / 1.01) < 1e-15);
        assert_true(read.noise.relmse_trimmed == 0.0 && read.noise.rmse == 0.05);
    }
    image_destroy(mean);
}

static void a_reference_has_the_same(void **state)
{
    struct reference reference;
    char *path = text_join(*state, "mean.exr");
    write_picture(*state, "mean.exr", false);
    write_picture(*state, "half1.exr", true);
    assert_true(reference_read(path, NULL, &reference, NULL));
    assert_true(isnan(reference.noise.relmse)); /* without noise.yaml it is any picture */
    reference_deinit(&reference);
    write_noise(*state, old);
    assert_true(reference_read(path, NULL, &reference, NULL));
    assert_true(reference.noise.rmse == 0.05);
    reference_deinit(&reference);
    mem_free(path);
}

static void what_is_no_noise_is_refused(void **state)
{
    struct image *mean = picture(false), *small = image_create(2, 2);
    struct reference_noise read;
    struct err err = {0};
    write_noise(*state, "rmse: 1\n");
    assert_false(reference_noise_read(*state, mean, &read, &err));
    assert_non_null(strstr(err.message, "'relmse' is missing"));
    write_noise(*state, old);
    write_picture(*state, "half1.exr", true);
    err = (struct err){0};
    assert_false(reference_noise_read(*state, small, &read, &err));
    assert_non_null(strstr(err.message, "10x10 against 2x2"));
    image_destroy(mean);
    image_destroy(small);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(todays_figures_are_taken, set_up, tear_down),
        cmocka_unit_test_setup_teardown(older_figures_are_not, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_reference_has_the_same, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_is_no_noise_is_refused, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

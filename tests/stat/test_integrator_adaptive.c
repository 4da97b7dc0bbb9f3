/* integrator/passes with adaptive film sampling: samples whose means are known, most of
 * which are 0 in half of the pixels. The picture, its light image and b are unbiased,
 * although the samples that decide about the others are part of it; error bars are right;
 * parts of a run, checkpoints and threads do not change the bits.
 *
 * False alarms of the whole file: 1e-4. Power: the sparse half is known to .18 %, the
 * even one, the light image and b to .06 % or better, error bars to .7 %: 1.1 %, .4 % and
 * 4 % are seen with .95 at least. */

#include "base/mem.h"
#include "base/pack.h"
#include "integrator/passes.h"
#include "integrator/sample_map.h"
#include "math/accum.h"
#include "support/stat_test.h"
#include "support/test_run.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <unistd.h>
#include <cmocka.h>

#define FALSE_ALARM 1e-4
#define FIGURES     5
#define RUNS        400
#define SIDE        16
#define PIXELS      (SIDE * SIDE)
#define SPARSE      0.1 /* share of samples that are not 0 in the sparse half */

static double camera_part(int pixel)
{
    if (pixel % SIDE == 0)
        return 1e-8;
    return pixel % SIDE < SIDE / 2 ? 8.0 / 7.0 : 3.0;
}

static double light_part(int pixel)
{
    return 0.5 + pixel / SIDE % 3;
}

/* Red through the camera: nearly constant in the left half, rarely found in the right
 * one.
 */
static void estimate_camera(struct subpaths *paths, const struct numbers *numbers,
                            struct contrib *out)
{
    const double *at = ustream_take(numbers->camera, DIMS_FILM, 2);
    int x = (int)(at[0] * SIDE), pixel = (int)(at[1] * SIDE) * SIDE + x;
    double u = ustream_take(numbers->light, 0, 2)[1];
    double red = x < SIDE / 2 ? 0.9 + 0.2 * u : u < SPARSE ? 1.0 / SPARSE : 0.0;
    (void)paths;
    contrib_clear(out);
    contrib_add(out, pixel, rgb(red * camera_part(pixel), 0, 0), 0, 0);
}

/* And green by the light image, on any pixel, with a value that goes with the red one. */
static void estimate_both(struct subpaths *paths, const struct numbers *numbers,
                          struct contrib *out)
{
    estimate_camera(paths, numbers, out);
    const double *u = ustream_take(numbers->light, 0, 2);
    int other = (int)(u[0] * PIXELS);
    contrib_add(out, other, rgb(0, 2.0 * u[1] * light_part(other), 0), 2, 1);
}

static const struct passes_plan plan = {
    .depth = 6, .estimate = estimate_both, .light_image = true, .may_adapt = true};
static const struct passes_plan plan_of_camera = {
    .depth = 6, .estimate = estimate_camera, .may_adapt = true};

static const char *const words[] = {"integrator=bdpt", "mutations_per_pixel=40",
                                    "film_sampling=adaptive", "threads=1", NULL};

static struct passes *run(const struct scene *scene, const struct settings *settings,
                          const struct passes_plan *which, struct run_part part)
{
    struct passes *p = passes_create(scene, settings, which);
    struct round_limits limits = {.stop = NULL};
    if (!part_is_whole(part))
        passes_methods.set_part(p, part);
    while (passes_methods.advance(p, &limits))
        ;
    return p;
}

static bool mean_is(const char *what, const struct welford *w, double exact)
{
    double z = (w->mean - exact) / welford_se(w);
    printf("%-12s %.5f of its value, known to %.2g; z %.2f\n", what, w->mean / exact,
           welford_se(w) / exact, z);
    return stat_ok(what, stat_t_p(z, w->count - 1.0), stat_sidak(FALSE_ALARM, FIGURES));
}

/* The squared error of the whole picture's luminance as its error bars tell it. */
static double told_variance(struct passes *p)
{
    struct evidence evidence;
    double sum = 0.0, deviations[REPLICAS_MOST];
    passes_evidence(p, &evidence);
    for (long i = 0; i < PIXELS; i++) {
        evidence.deviations(evidence.self, i, deviations);
        for (int r = 0; r < evidence.replicas; r++)
            sum += deviations[r] * deviations[r];
    }
    return sum / (evidence.replicas * (evidence.replicas - 1.0));
}

static double true_error(const struct image *image, const struct passes_plan *which,
                         double scale)
{
    double sum = 0.0, green = which->light_image;
    for (int i = 0; i < PIXELS; i++) {
        double d = rgb_luminance(image_pixel(image, i)) -
                   scale * rgb_luminance(rgb(camera_part(i), green * light_part(i), 0.0));
        sum += d * d;
    }
    return sum;
}

static void known_picture(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    struct settings s = test_settings(words);
    struct image *image = image_create(SIDE, SIDE);
    struct welford left = {0}, right = {0}, green = {0}, b = {0}, predicted = {0};
    double light = 0.0, scale = scene->emission_scale;
    for (int i = 0; i < PIXELS; i++)
        light += light_part(i) / PIXELS;
    for (int run_index = 0; run_index < RUNS; run_index++) {
        s.seed = 1 + run_index;
        struct passes *p = run(scene, &s, &plan, (struct run_part){0, 0});
        struct run_statistics figures;
        passes_picture(p, image);
        passes_statistics(p, &figures);
        double red[2] = {0.0, 0.0};
        for (int i = 0; i < PIXELS; i++)
            red[i % SIDE >= SIDE / 2] += image_pixel(image, i).r * 2.0 / PIXELS;
        welford_add(&left, red[0] / scale);
        welford_add(&right, red[1] / scale);
        welford_add(&green, test_image_mean(image).g / scale);
        welford_add(&b, figures.b / scale);
        welford_add(&predicted, figures.adaptive.predicted);
        passes_destroy(p);
    }
    printf("predicted %.3f of the error of uniform samples\n", predicted.mean);
    assert_true(predicted.mean < 0.8); /* else nothing of this is tested */
    assert_true(mean_is("even half", &left, 1.0));
    assert_true(mean_is("sparse half", &right, 3.0));
    assert_true(mean_is("light image", &green, light));
    assert_true(mean_is("b", &b, rgb_luminance(rgb(2.0, light, 0.0))));
    image_destroy(image);
    scene_destroy(scene);
}

/* Told by error bars, and squared error less what is told. */
static void find_bars(const struct passes_plan *which, struct welford *told,
                      struct welford *excess)
{
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    struct settings s = test_settings(words);
    struct image *image = image_create(SIDE, SIDE);
    for (int run_index = 0; run_index < RUNS; run_index++) {
        s.seed = 1 + run_index;
        struct passes *p = run(scene, &s, which, (struct run_part){0, 0});
        double variance = told_variance(p);
        passes_picture(p, image);
        welford_add(told, variance);
        welford_add(excess, variance - true_error(image, which, scene->emission_scale));
        passes_destroy(p);
    }
    printf("error bars %.4f of the squared error, known to %.2g\n",
           told->mean / (told->mean - excess->mean), welford_se(excess) / told->mean);
    image_destroy(image);
    scene_destroy(scene);
}

static void error_bars(void **state)
{
    struct welford told = {0}, excess = {0};
    (void)state;
    find_bars(&plan_of_camera, &told, &excess);
    assert_true(stat_ok("bars", stat_t_p(excess.mean / welford_se(&excess), RUNS - 1.0),
                        stat_sidak(FALSE_ALARM, FIGURES)));
}

/* A light image is scaled as its pixel's camera samples are. 80 % of its samples come
 * after the start, of a pixel's own 64 to 86 %: so bars are wrong by less than a quarter.
 */
static void error_bars_with_light(void **state)
{
    struct welford told = {0}, excess = {0};
    (void)state;
    find_bars(&plan, &told, &excess);
    double error = told.mean - excess.mean;
    assert_true(0.75 * error < told.mean && told.mean < 1.25 * error);
}

/* --- the same bits ------------------------------------------------------------------ */

/* Writes p to memory and destroys it. */
static void store(struct passes *p, struct run_part part, struct text *bytes)
{
    struct err err = {0};
    struct pack *pack = pack_create_memory(1, &err);
    pack_set_part(pack, part, false);
    passes_pack(p, pack);
    assert_true(pack_close_memory(pack, bytes, &err));
    passes_destroy(p);
}

/* Adds what is stored to p, or has p begin with it. */
static bool load(struct passes *p, struct run_part part, bool adds, struct text *bytes)
{
    struct err err = {0};
    struct pack *pack = pack_open_memory(bytes, 1, &err);
    assert_non_null(pack);
    pack_set_part(pack, part, adds);
    passes_pack(p, pack);
    mem_free(bytes->data);
    *bytes = (struct text){0};
    return pack_close(pack, &err);
}

static void assert_same(struct passes *a, struct passes *b)
{
    struct image *images[2] = {image_create(SIDE, SIDE), image_create(SIDE, SIDE)};
    struct run_statistics figures[2];
    struct passes *p[2] = {a, b};
    for (int i = 0; i < 2; i++) {
        passes_picture(p[i], images[i]);
        passes_statistics(p[i], &figures[i]);
    }
    assert_memory_equal(images[0]->pixels, images[1]->pixels, 12 * PIXELS);
    assert_true(figures[0].b == figures[1].b && figures[0].b_se == figures[1].b_se);
    assert_true(figures[0].paths == figures[1].paths);
    assert_true(told_variance(a) == told_variance(b));
    for (int i = 0; i < 2; i++)
        image_destroy(images[i]);
}

static void parts_add_up(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    struct settings s = test_settings(words);
    struct passes *whole = run(scene, &s, &plan, (struct run_part){0, 0});
    s.threads = 3;
    struct passes *sum = passes_create(scene, &s, &plan);
    for (int i = 0; i < 3; i++) {
        struct text bytes = {0};
        struct run_part part = {i, 3};
        store(run(scene, &s, &plan, part), part, &bytes);
        assert_true(load(sum, part, true, &bytes));
    }
    assert_same(whole, sum);
    passes_destroy(sum);
    passes_destroy(whole);
    scene_destroy(scene);
}

/* After every pass: within the start, at its end, and later; with a number of passes
 * before that the replicas do not divide, and splats so dim that replicas round them at
 * random. */
static void goes_on_with_the_same_bits(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    struct settings s = test_settings(words);
    s.mutations_per_pixel = 45.0;
    struct passes *whole = run(scene, &s, &plan, (struct run_part){0, 0});
    struct round_limits limits = {.stop = NULL};
    long length = passes_whole(whole);
    for (long cut = 0; cut < length; cut++) {
        struct text bytes = {0};
        struct passes *p = passes_create(scene, &s, &plan);
        while (passes_whole(p) < cut)
            passes_methods.advance(p, &limits);
        store(p, (struct run_part){0, 0}, &bytes);
        p = passes_create(scene, &s, &plan);
        assert_true(load(p, (struct run_part){0, 0}, false, &bytes));
        while (passes_methods.advance(p, &limits))
            ;
        assert_same(whole, p);
        passes_destroy(p);
    }
    passes_destroy(whole);
    scene_destroy(scene);
}

/* A part whose start was another one is refused. */
static void other_starts_are_refused(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    struct settings s = test_settings(words), other = s;
    struct passes *sum = passes_create(scene, &s, &plan);
    struct text bytes = {0};
    other.seed = s.seed + 1;
    store(run(scene, &s, &plan, (struct run_part){0, 2}), (struct run_part){0, 2},
          &bytes);
    assert_true(load(sum, (struct run_part){0, 2}, true, &bytes));
    store(run(scene, &other, &plan, (struct run_part){1, 2}), (struct run_part){1, 2},
          &bytes);
    assert_false(load(sum, (struct run_part){1, 2}, true, &bytes));
    passes_destroy(sum);
    scene_destroy(scene);
}

/* Budgets are used up to the sample, and where they are too small nothing is adapted. */
static void budgets_are_kept(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    struct settings s = test_settings(words);
    for (int budget = 38; budget < 47; budget++) {
        struct run_statistics figures;
        s.mutations_per_pixel = budget;
        struct passes *p = run(scene, &s, &plan, (struct run_part){0, 0});
        passes_statistics(p, &figures);
        assert_true(fabs(figures.paths - (double)budget * PIXELS) <= budget);
        assert_true(isnan(figures.adaptive.predicted) == (budget < 40));
        assert_true(passes_methods.progress(p) <= 1.0 &&
                    passes_methods.progress(p) > 0.99);
        passes_destroy(p);
    }
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_picture),
        cmocka_unit_test(error_bars),
        cmocka_unit_test(error_bars_with_light),
        cmocka_unit_test(parts_add_up),
        cmocka_unit_test(goes_on_with_the_same_bits),
        cmocka_unit_test(other_starts_are_refused),
        cmocka_unit_test(budgets_are_kept),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

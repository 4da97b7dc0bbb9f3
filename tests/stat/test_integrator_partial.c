/* integrator/passes: a pass that the clock or an interrupt ends. The picture, its light
 * image and b are unbiased; a round ends in time however slow samples are; error bars
 * wait for the pass's end; and what was cut short goes on with the same bits.
 *
 * False alarms of the whole file: 1e-4. Power: after 4.85 passes the fake's two parts and
 * b are known to .1 %, its row with one sample more to .32 %: 1 % of the former and 2 %
 * of the latter are seen with .95 at least. bdpt's film is known to 1 %, its blocks to 1
 * or 2 %: 6 % of the film are seen with .95. Division by the count of whole passes alone
 * is off by 40 % and 18 %. */

#include "base/clock.h"
#include "base/mem.h"
#include "base/pack.h"
#include "integrator/passes.h"
#include "math/accum.h"
#include "support/stat_test.h"
#include "support/test_run.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <unistd.h>
#include <cmocka.h>

#define FALSE_ALARM 1e-4
#define FIGURES     (2 * 4 + 5)
#define SIDE        16
#define PIXELS      (SIDE * SIDE)

/* --- a clock and samples of our own ----------------------------------------------- */

/* In the place of base/clock's: it advances by `sample_seconds` a sample. */
static double now, sample_seconds;

double clock_wall(void)
{
    return now;
}

double clock_cpu(void)
{
    return now;
}

static long samples, stop_after;
static volatile sig_atomic_t stop;

static void count_sample(void)
{
    now += sample_seconds;
    if (++samples == stop_after)
        stop = 1;
}

static double camera_part(int pixel)
{
    return 1.0 + pixel % 7;
}

static double light_part(int pixel)
{
    return 2.0 + pixel / SIDE % 5;
}

/* Red through the camera, green by the light image, on any pixel. */
static void estimate_fake(struct subpaths *paths, const struct numbers *numbers,
                          struct contrib *out)
{
    const double *at = ustream_take(numbers->camera, DIMS_FILM, 2);
    int pixel = (int)(at[1] * SIDE) * SIDE + (int)(at[0] * SIDE);
    const double *u = ustream_take(numbers->light, 0, 2);
    int other = (int)(u[0] * PIXELS);
    (void)paths;
    contrib_clear(out);
    contrib_add(out, pixel, rgb(2.0 * u[1] * camera_part(pixel), 0, 0), 0, 0);
    contrib_add(out, other, rgb(0, light_part(other), 0), 2, 1);
    count_sample();
}

static void estimate_counted(struct subpaths *paths, const struct numbers *numbers,
                             struct contrib *out)
{
    estimate_bdpt(paths, numbers, out);
    count_sample();
}

/* At `cut` samples, the pilot's not among them; 0: to the budget's end. */
static struct passes *run(const struct scene *scene, const struct settings *settings,
                          estimate_function estimate, long cut)
{
    struct passes *p = passes_create(
        scene, settings, &(struct passes_plan){6, estimate, true, false, NULL});
    passes_trace(p, 0.0, (double)INFINITY, NULL); /* the pilot alone */
    samples = 0;
    stop = 0;
    stop_after = cut;
    struct round_limits limits = {.stop = &stop};
    while (!stop && passes_methods.advance(p, &limits))
        ;
    return p;
}

/* --- unbiased ---------------------------------------------------------------------- */

static bool mean_is(const char *what, const struct welford *w, double exact)
{
    double z = (w->mean - exact) / welford_se(w);
    printf("%-24s %.5f of its value, known to %.2g; z %.2f\n", what, w->mean / exact,
           welford_se(w) / exact, z);
    return stat_ok(what, stat_t_p(z, w->count - 1.0), stat_sidak(FALSE_ALARM, FIGURES));
}

/* Sums of a picture over all pixels, and over those that have one sample more than the
 * others: {red, green} over the truth. */
static void check_fake(const struct scene *scene, double passes)
{
    const char *const words[] = {"integrator=bdpt", "mutations_per_pixel=100", NULL};
    struct settings s = test_settings(words);
    struct image *image = image_create(SIDE, SIDE);
    struct welford red = {0}, green = {0}, b = {0}, first = {0};
    double truth[2] = {0.0};
    for (int i = 0; i < PIXELS; i++) {
        truth[0] += camera_part(i) / PIXELS;
        truth[1] += light_part(i) / PIXELS;
    }
    for (int run_index = 0; run_index < 400; run_index++) {
        s.seed = 1 + run_index;
        long cut = (long)(passes * PIXELS) / 8 * 8;
        struct passes *p = run(scene, &s, estimate_fake, cut);
        struct run_statistics figures;
        passes_picture(p, image);
        passes_statistics(p, &figures);
        assert_true(passes_paths(p) == (double)cut && figures.paths == (double)cut);
        struct rgb mean = test_image_mean(image);
        welford_add(&red, mean.r / scene->emission_scale);
        welford_add(&green, mean.g / scene->emission_scale);
        welford_add(&b, figures.b / scene->emission_scale);
        double row = 0.0; /* the first is the first of the pass, and so has one more */
        for (int x = 0; x < SIDE; x++)
            row += (double)image->pixels[3 * x] / camera_part(x) / SIDE;
        welford_add(&first, row / scene->emission_scale);
        passes_destroy(p);
    }
    printf("%g passes\n", passes);
    assert_true(mean_is("camera part", &red, truth[0]));
    assert_true(mean_is("light image", &green, truth[1]));
    assert_true(mean_is("b", &b, rgb_luminance(rgb(truth[0], truth[1], 0.0))));
    assert_true(mean_is("row with one more", &first, 1.0));
    image_destroy(image);
}

static void known_picture(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    sample_seconds = 0.0;
    check_fake(scene, 1.4);
    check_fake(scene, 4.85);
    scene_destroy(scene);
}

static void add_blocks(const struct image *image, struct welford blocks[5])
{
    double sums[5] = {0.0};
    for (int i = 0; i < PIXELS; i++) {
        struct rgb v = rgb((double)image->pixels[3 * i], (double)image->pixels[3 * i + 1],
                           (double)image->pixels[3 * i + 2]);
        int block = i / SIDE / (SIDE / 2) * 2 + i % SIDE / (SIDE / 2);
        sums[block] += rgb_luminance(v) * 4.0 / PIXELS;
        sums[4] += rgb_luminance(v) / PIXELS;
    }
    for (int i = 0; i < 5; i++)
        welford_add(&blocks[i], sums[i]);
}

/* bdpt cut in the middle against bdpt with a mutation budget: a glass ball and its
 * caustic, so that much of the light is in the light image. */
static void same_as_whole_passes(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_GLASS, false);
    struct image *image = image_create(SIDE, SIDE);
    struct welford cut[5] = {{0}}, whole[5] = {{0}};
    sample_seconds = 0.0;
    for (int i = 0; i < 300; i++) {
        const char *const words[] = {"integrator=bdpt", "mutations_per_pixel=4",
                                     "max_depth=6", "replicas=1", NULL};
        struct settings s = test_settings(words);
        for (int part = 0; part < 2; part++) {
            s.seed = 1 + 2 * i + part;
            struct passes *p = run(scene, &s, estimate_counted,
                                   part ? 0 : PIXELS * (11 + i % 3) / 8);
            passes_picture(p, image);
            add_blocks(image, part ? whole : cut);
            passes_destroy(p);
        }
    }
    for (int i = 0; i < 5; i++) {
        double se = hypot(welford_se(&cut[i]), welford_se(&whole[i]));
        double z = (cut[i].mean - whole[i].mean) / se;
        printf("block %d: %.4f of whole passes, known to %.2g; z %.2f\n", i,
               cut[i].mean / whole[i].mean, se / whole[i].mean, z);
        assert_true(
            stat_ok("block", stat_t_p(z, 598.0), stat_sidak(FALSE_ALARM, FIGURES)));
    }
    image_destroy(image);
    scene_destroy(scene);
}

/* --- in time ----------------------------------------------------------------------- */

/* A sample takes a second: a pass would take 256, the pilot 4096. */
static void ends_in_time(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    const char *const words[] = {"integrator=bdpt", "seconds=1000", NULL};
    struct settings s = test_settings(words);
    sample_seconds = 1.0;
    for (double budget = 90.0; budget < 1000.0; budget += 97.0) {
        s.seconds = budget;
        stop_after = 0;
        samples = 0;
        struct passes *p = passes_create(
            scene, &s, &(struct passes_plan){6, estimate_fake, true, false, NULL});
        struct round_limits limits = {.begin = now, .until = now + budget};
        while (now < limits.until)
            assert_true(passes_methods.advance(p, &limits));
        assert_true(now - limits.until <= 8.0);
        double pilot = (double)samples - passes_paths(p);
        assert_true(pilot <= 0.05 * budget + 8.0);
        assert_true(passes_paths(p) >= 0.95 * budget - 8.0);
        passes_destroy(p);
    }
    sample_seconds = 0.0;
    scene_destroy(scene);
}

/* Rows that are there before the first pass is over lie evenly over the film. */
static void unsampled_is_told(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    struct image *image = image_create(SIDE, SIDE);
    const char *const words[] = {"integrator=bdpt", "mutations_per_pixel=4", NULL};
    struct settings s = test_settings(words);
    struct passes *p = run(scene, &s, estimate_fake, PIXELS / 4);
    struct run_statistics figures;
    struct evidence evidence;
    passes_statistics(p, &figures);
    passes_evidence(p, &evidence);
    passes_picture(p, image);
    assert_true(figures.unsampled == 0.75);
    assert_true(isinf(figures.b_se) && figures.b > 0.0);
    assert_false(evidence.no_light);
    assert_int_equal(evidence.replicas_with_pass, 0);
    int run_of_black = 0, black = 0;
    for (int y = 0; y < SIDE; y++) {
        bool is_black = image->pixels[3 * y * SIDE] == 0.0f;
        for (int x = 0; x < SIDE; x++)
            assert_true((image->pixels[3 * (y * SIDE + x)] == 0.0f) == is_black);
        black += is_black;
        run_of_black = is_black ? run_of_black + 1 : 0;
        assert_true(run_of_black < 2 * SIDE / 4);
    }
    assert_int_equal(black, SIDE * 3 / 4);
    passes_destroy(p);
    image_destroy(image);
    scene_destroy(scene);
}

/* --- error bars, and going on ------------------------------------------------------ */

static void bars_are_of_whole_passes(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    const char *const words[] = {"integrator=bdpt", "mutations_per_pixel=100", NULL};
    struct settings s = test_settings(words);
    struct passes *whole = run(scene, &s, estimate_fake, 40L * PIXELS);
    struct passes *cut = run(scene, &s, estimate_fake, 40L * PIXELS + 88);
    struct evidence a, b;
    passes_evidence(whole, &a);
    passes_evidence(cut, &b);
    assert_int_equal(passes_whole(cut), 40);
    assert_int_equal(a.spans->count, b.spans->count);
    assert_int_equal(a.replicas_with_pass, b.replicas_with_pass);
    for (long i = 0; i < PIXELS; i++) {
        double of_whole[REPLICAS_MOST], of_cut[REPLICAS_MOST];
        a.deviations(a.self, i, of_whole);
        b.deviations(b.self, i, of_cut);
        for (int r = 0; r < a.replicas; r++)
            assert_true(of_whole[r] == of_cut[r]);
    }
    passes_destroy(whole);
    passes_destroy(cut);
    scene_destroy(scene);
}

static struct passes *through_file(const struct scene *scene, struct settings *s,
                                   struct passes *p)
{
    char path[64];
    struct err err = {0};
    snprintf(path, sizeof path, "/tmp/etalon-partial.%ld", (long)getpid());
    struct pack *pack = pack_create(path, 1, &err);
    passes_pack(p, pack);
    assert_true(pack_close(pack, &err));
    passes_destroy(p);
    s->threads = 3;
    p = passes_create(scene, s,
                      &(struct passes_plan){6, estimate_fake, true, false, NULL});
    pack = pack_open(path, 1, &err);
    assert_non_null(pack);
    passes_pack(p, pack);
    assert_true(pack_close(pack, &err));
    unlink(path);
    return p;
}

static void goes_on_with_the_same_bits(void **state)
{
    (void)state;
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    const char *const words[] = {"integrator=bdpt", "mutations_per_pixel=35", NULL};
    struct image *images[2] = {image_create(SIDE, SIDE), image_create(SIDE, SIDE)};
    struct run_statistics figures[2];
    struct evidence evidence[2];
    struct passes *p[2];
    for (int i = 0; i < 2; i++) {
        struct settings s = test_settings(words);
        p[i] = run(scene, &s, estimate_fake, i ? 18L * PIXELS + 120 : 0);
        struct round_limits limits = {.stop = NULL};
        if (i)
            p[i] = through_file(scene, &s, p[i]);
        while (i && passes_methods.advance(p[i], &limits))
            ;
        passes_picture(p[i], images[i]);
        passes_statistics(p[i], &figures[i]);
        passes_evidence(p[i], &evidence[i]);
    }
    assert_memory_equal(images[0]->pixels, images[1]->pixels, 12 * PIXELS);
    assert_true(figures[0].b == figures[1].b && figures[0].b_se == figures[1].b_se);
    assert_true(evidence[0].energy_top == evidence[1].energy_top);
    for (long i = 0; i < PIXELS; i++) {
        double a[REPLICAS_MOST], b[REPLICAS_MOST];
        evidence[0].deviations(evidence[0].self, i, a);
        evidence[1].deviations(evidence[1].self, i, b);
        assert_memory_equal(a, b, (size_t)evidence[0].replicas * sizeof *a);
    }
    for (int i = 0; i < 2; i++) {
        passes_destroy(p[i]);
        image_destroy(images[i]);
    }
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_picture),
        cmocka_unit_test(same_as_whole_passes),
        cmocka_unit_test(ends_in_time),
        cmocka_unit_test(unsampled_is_told),
        cmocka_unit_test(bars_are_of_whole_passes),
        cmocka_unit_test(goes_on_with_the_same_bits),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

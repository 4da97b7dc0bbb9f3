/* Layers beside the picture: pictures by length and by technique sum to the picture,
 * maps of steps have the means of the tallies, and none of them changes the picture by a
 * bit. What sums by construction is told from what is right by other runs: a length's
 * picture is what a smaller max_depth gives, and each technique without its weight has
 * the mean of all. Only that last test is random. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include <math.h>
#include <string.h>

#include "integrator/markov/sink_set.h"
#include "math/accum.h"
#include "support/near.h"
#include "support/test_run.h"

#define SIZE   8
#define PIXELS (SIZE * SIZE)

static struct scene *room(int size)
{
    struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 0), 34.0, size);
    test_room(desc);
    test_sphere(desc, vec3(0.4f, 0.5f, 0.2f), 0.35,
                test_material(desc, "mirror", "reflectance", rgb_grey(0.9), NULL, 0.0),
                rgb_grey(0.0), false);
    test_lamp(desc, 0.5, rgb(3, 2, 1));
    return test_build(desc, false);
}

static struct run_result run_with(const struct scene *scene, const char *const *words,
                                  const char *layers, const char *depth)
{
    const char *all[16] = {layers, depth, "bootstrap=3000", "chains=16"};
    int count = 4;
    while (*words)
        all[count++] = *words++;
    struct settings s = test_settings(all);
    return test_run(scene, &s);
}

/* Sum over the layers of that prefix; returns their number. */
static int sum_layers(const struct layers *layers, const char *prefix, double *sum)
{
    int count = 0;
    for (int i = 0; i < 3 * PIXELS; i++)
        sum[i] = 0.0;
    for (int i = 0; i < layers->count; i++) {
        const struct layer *layer = &layers->list[i];
        if (strncmp(layer->name, prefix, strlen(prefix)) != 0)
            continue;
        char channel = layer->name[strlen(layer->name) - 1];
        int c = (int)(strchr("RGB", channel) - "RGB");
        for (int j = 0; j < PIXELS; j++)
            sum[3 * j + c] += (double)layer->values[j];
        count++;
    }
    return count / 3;
}

/* Layers and picture are rounded to floats, up to twice a layer where chains and passes
 * add to it; films round each splat to 2^-37 of b, of at most 2^14 splats a pixel. */
static void assert_sums(const struct run_result *r, const char *prefix, int count)
{
    double sum[3 * PIXELS];
    assert_int_equal(sum_layers(&r->layers, prefix, sum), count);
    for (int i = 0; i < 3 * PIXELS; i++) {
        double value = (double)r->image->pixels[i];
        double bound = (2.0 * count + 1.0) * 0x1p-24 * value + 0x1p-23 * r->statistics.b;
        assert_true(fabs(sum[i] - value) <= bound);
    }
}

static const char *const designs[][4] = {
    {"integrator=pssmlt", "mutations_per_pixel=32"},
    {"integrator=pssmlt", "mutations_per_pixel=32", "builder=pt", "estimator=plain"},
    {"integrator=mmlt", "mutations_per_pixel=32", "direct=joint"},
    {"integrator=mmlt", "mutations_per_pixel=32", "direct=separate"},
    {"integrator=mmlt", "mutations_per_pixel=32", "direct=joint", "ceiling=2"},
    {"integrator=pfmlt", "mutations_per_pixel=32", "direct=joint"},
    {"integrator=rjmlt", "mutations_per_pixel=32", "direct=separate"},
    {"integrator=smlt", "mutations_per_pixel=32", "share_floor=1", "passes_share=0.3"},
    {"integrator=smlt", "mutations_per_pixel=32", "metropolis=mmlt", "share_floor=1"},
    {"integrator=bdpt", "mutations_per_pixel=4"},
    {"integrator=pt", "mutations_per_pixel=4"},
};
#define DESIGNS (sizeof designs / sizeof *designs)

static void words_of(size_t design, const char *words[6])
{
    int count = 0;
    for (int i = 0; i < 4 && designs[design][i]; i++)
        words[count++] = designs[design][i];
    words[count] = NULL;
}

/* All layers of a design. */
static const char *layers_of(size_t design)
{
    bool chains = design < DESIGNS - 2;
    return chains ? "layers=acceptance,failures,work,visits,lengths,techniques,features"
                  : "layers=failures,work,lengths,techniques,unweighted,features";
}

static void lengths_and_techniques_sum_to_the_picture(void **state)
{
    (void)state;
    struct scene *scene = room(SIZE);
    for (size_t d = 0; d < DESIGNS; d++) {
        const char *words[6];
        words_of(d, words);
        bool pt = strstr(designs[d][0], "=pt") ||
                  (designs[d][2] && strstr(designs[d][2], "=pt"));
        struct run_result r = run_with(scene, words, layers_of(d), "max_depth=4");
        assert_sums(&r, "length_", 4);
        /* Layers of all techniques are there, though pt uses two of a length. */
        assert_sums(&r, "technique_", 1 + 3 + 4 + 5);
        assert_true(!pt || layers_find(&r.layers, "technique_s2_t2.R")[9] == 0.0f);
        run_result_deinit(&r);
        r = run_with(scene, words, layers_of(d), "max_depth=10");
        assert_sums(&r, "length_", 9);
        assert_non_null(layers_find(&r.layers, "length_rest.G"));
        assert_sums(&r, "technique_", 1 + 3 + 4 + 5 + 6 + 7 + 1);
        run_result_deinit(&r);
    }
    scene_destroy(scene);
}

static void layers_change_no_bit_of_the_picture(void **state)
{
    (void)state;
    struct scene *scene = room(SIZE);
    for (size_t d = 0; d < DESIGNS; d++) {
        const char *words[6];
        words_of(d, words);
        struct run_result with = run_with(scene, words, layers_of(d), "max_depth=5");
        struct run_result without = run_with(scene, words, "layers=none", "max_depth=5");
        assert_memory_equal(with.image->pixels, without.image->pixels,
                            3 * PIXELS * sizeof(float));
        assert_true(with.statistics.paths == without.statistics.paths);
        assert_true(with.layers.count > without.layers.count + 12);
        run_result_deinit(&with);
        run_result_deinit(&without);
    }
    scene_destroy(scene);
}

/* The paths of a sample of pt are the same up to the depth, and so is its picture. */
static void a_length_is_what_another_depth_leaves(void **state)
{
    (void)state;
    struct scene *scene = room(SIZE);
    const char *const words[] = {"integrator=pt", "mutations_per_pixel=4", NULL};
    struct run_result deep = run_with(scene, words, "layers=lengths", "max_depth=3");
    struct run_result flat = run_with(scene, words, "layers=lengths", "max_depth=2");
    for (int k = 1; k <= 2; k++)
        for (int c = 0; c < 3; c++) {
            char name[LAYER_NAME_SIZE];
            snprintf(name, sizeof name, "length_%d.%c", k, "RGB"[c]);
            assert_memory_equal(layers_find(&deep.layers, name),
                                layers_find(&flat.layers, name), PIXELS * sizeof(float));
        }
    assert_null(layers_find(&flat.layers, "length_3.R"));
    assert_true(layers_find(&deep.layers, "length_3.R")[20] > 0.0f);
    run_result_deinit(&deep);
    run_result_deinit(&flat);
    scene_destroy(scene);
}

static double mean_of(const struct layers *layers, const char *name)
{
    const float *values = layers_find(layers, name);
    double sum = 0.0;
    assert_non_null(values);
    for (int i = 0; i < PIXELS; i++)
        sum += (double)values[i];
    return sum / PIXELS;
}

/* Of the paths of length 3 in a room without mirrors every technique alone is an unbiased
 * estimate. Paired over seeds; false alarm 1e-4 in all (Sidak over 4, Student's law).
 * Power: with the weights left on, the differences are 30 to 160 standard errors. */
#define SEEDS 12
static void techniques_without_weights_have_one_mean(void **state)
{
    (void)state;
    struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 0), 34.0, SIZE);
    test_room(desc);
    test_lamp(desc, 0.5, rgb(3, 2, 1));
    struct scene *scene = test_build(desc, false);
    static const char *const names[] = {"unweighted_s0_t4.G", "unweighted_s1_t3.G",
                                        "unweighted_s2_t2.G", "unweighted_s3_t1.G"};
    double differences[4][SEEDS];
    for (int seed = 0; seed < SEEDS; seed++) {
        char word[32];
        snprintf(word, sizeof word, "seed=%d", seed + 1);
        const char *const words[] = {"integrator=bdpt", "mutations_per_pixel=64", word,
                                     NULL};
        struct run_result r = run_with(scene, words, "layers=lengths,unweighted",
                                       "max_depth=3");
        double all = mean_of(&r.layers, "length_3.G");
        for (int i = 0; i < 4; i++)
            differences[i][seed] = mean_of(&r.layers, names[i]) / all - 1.0;
        run_result_deinit(&r);
    }
    for (int i = 0; i < 4; i++) {
        struct welford w = {0};
        for (int seed = 0; seed < SEEDS; seed++)
            welford_add(&w, differences[i][seed]);
        double t = w.mean / welford_se(&w);
        print_message("%s: %.3f (%.1f sigmas)\n", names[i], 1.0 + w.mean, t);
        assert_true(fabs(t) < 7.0); /* Student, 11 degrees: 2.3e-5 */
    }
    scene_destroy(scene);
}

/* On a film of one pixel a map has the mean of the whole run; the maps of where and of
 * work have the mean 1 on any. */
static void maps_have_the_means_of_the_tallies(void **state)
{
    (void)state;
    struct scene *one = room(1), *many = room(SIZE);
    for (size_t d = 0; d < DESIGNS; d++) {
        const char *words[6];
        words_of(d, words);
        struct run_result r = run_with(many, words, layers_of(d), "max_depth=4");
        assert_relative(mean_of(&r.layers, "work.Y"), 1.0, 1e-6);
        run_result_deinit(&r);
        if (d >= DESIGNS - 2 || strstr(words[0], "smlt"))
            continue;
        r = run_with(many, words, layers_of(d), "max_depth=4");
        assert_relative(mean_of(&r.layers, "visits.Y"), 1.0, 1e-6);
        run_result_deinit(&r);
        r = run_with(one, words, layers_of(d), "max_depth=4");
        for (int i = 0; i < r.statistics.move_count; i++) {
            const struct move_statistics *move = &r.statistics.moves[i];
            if (text_equal(move->name, "large") || text_equal(move->name, "small"))
                assert_relative(
                    (double)layers_find(&r.layers, text_equal(move->name, "large")
                                                       ? "acceptance_large.Y"
                                                       : "acceptance_small.Y")[0],
                    move->acceptance, 1e-6);
        }
        assert_relative((double)layers_find(&r.layers, "failures.Y")[0],
                        r.statistics.failure_rate, 1e-6);
        run_result_deinit(&r);
    }
    scene_destroy(one);
    scene_destroy(many);
}

/* A state with splats on several pixels counts once in all, by their luminance; second
 * stages are work alone, jumps are no small steps. */
static void a_proposal_counts_once(void **state)
{
    (void)state;
    struct film *all = film_create(4, 1), *small = film_create(4, 1),
                *large = film_create(4, 1);
    struct contrib c;
    contrib_init(&c, 4);
    contrib_add(&c, 0, rgb_grey(1.0), 1, 1);
    contrib_add(&c, 2, rgb_grey(3.0), 0, 0);
    contrib_add(&c, 2, rgb_grey(4.0), 0, 0);
    struct map_sink sink = map_sink_of(all, small, large, true);
    const struct step_event events[] = {
        {MOVE_LARGE, true, false, 0.25, 7.0},        {MOVE_LOCAL, true, true, 0.0, 3.0},
        {MOVE_LOCAL + 1, true, false, 0.5, 5.0},     {MOVE_JUMP, true, false, 1.0, 2.0},
        {MOVE_SECOND_STAGE, false, false, 1.0, 4.0},
    };
    for (size_t i = 0; i < sizeof events / sizeof *events; i++)
        sink.sink.add(&sink.sink, &c, &events[i]);
    struct rgb first = film_value(all, 0), second = film_value(all, 2);
    assert_relative(first.r, 1.0 / 8.0, 1e-12);
    assert_relative(first.g, 4.0 / 8.0, 1e-12);
    assert_relative(first.b, 21.0 / 8.0, 1e-12);
    assert_relative(second.g, 4.0 * 7.0 / 8.0, 1e-12);
    assert_relative(film_value(small, 2).r, 0.5 * 7.0 / 8.0, 1e-12);
    assert_relative(film_value(small, 2).g, 2.0 * 7.0 / 8.0, 1e-12);
    assert_relative(film_value(large, 0).r, 0.25 / 8.0, 1e-12);
    assert_true(film_value(all, 1).g == 0.0);
    contrib_clear(&c);
    sink.sink.add(&sink.sink, &c, &events[0]); /* a state without light is nowhere */
    assert_relative(film_value(large, 0).g, 1.0 / 8.0, 1e-12);
    contrib_deinit(&c);
    film_destroy(all);
    film_destroy(small);
    film_destroy(large);
}

/* A mirror where x < 0, at z = 0, that shows a wall at z = 6, behind the camera, and a
 * diffuse wall where x > 0, at z = -1. */
static void features(void **state)
{
    (void)state;
    struct scene_desc *desc = test_desc(vec3(0, 0, 4), vec3(0, 0, 0), 40.0, SIZE);
    struct rgb dark = {0.0, 0.0, 0.0};
    int mirror = test_material(desc, "mirror", "reflectance", rgb(0.5, 1.0, 1.0), NULL,
                               0.0);
    test_quad(desc, vec3(-4, 0, 0), vec3(4, 0, 0), vec3(0, 4, 0), mirror, dark);
    test_quad(desc, vec3(4, 0, -1), vec3(4, 0, 0), vec3(0, 4, 0),
              test_diffuse(desc, 0.2, 0.5, 0.8), dark);
    test_quad(desc, vec3(0, 0, 6), vec3(-9, 0, 0), vec3(0, 9, 0),
              test_diffuse(desc, 0.6, 0.4, 0.1), dark);
    test_lamp(desc, 0.1, rgb_grey(1.0));
    struct scene *scene = test_build(desc, false);
    const char *const words[] = {"integrator=pt", "mutations_per_pixel=1", NULL};
    struct run_result r = run_with(scene, words, "layers=features", "max_depth=2");
    int mirrored = 4 * SIZE + 6, plain = 4 * SIZE + 1; /* x grows to the left */
    const double expected[][3] = {{0.3, 0.4, 0.1}, {0.2, 0.5, 0.8}};
    for (int c = 0; c < 3; c++) {
        const char *const names[] = {"albedo.R", "albedo.G", "albedo.B"};
        assert_relative((double)layers_find(&r.layers, names[c])[mirrored],
                        expected[0][c], 1e-6);
        assert_relative((double)layers_find(&r.layers, names[c])[plain], expected[1][c],
                        1e-6);
    }
    assert_relative((double)layers_find(&r.layers, "normal.Z")[mirrored], -1.0, 1e-6);
    assert_relative((double)layers_find(&r.layers, "normal.Z")[plain], 1.0, 1e-6);
    double depth = (double)layers_find(&r.layers, "depth.Z")[mirrored];
    assert_true(depth > 4.0 && depth < 4.0 / cos(0.45));
    depth = (double)layers_find(&r.layers, "depth.Z")[plain];
    assert_true(depth > 5.0 && depth < 5.0 / cos(0.45));
    run_result_deinit(&r);
    scene_destroy(scene);
}

static void what_an_integrator_has_not_is_refused(void **state)
{
    (void)state;
    static const char *const cases[][2] = {{"bdpt", "acceptance"},
                                           {"pt", "visits"},
                                           {"mlt", "techniques"},
                                           {"mlt", "lengths"},
                                           {"pssmlt", "unweighted"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct settings s;
        struct err err = {0};
        settings_init(&s);
        assert_true(settings_set(&s, "integrator", cases[i][0], NULL, &err));
        assert_true(settings_set(&s, "layers", cases[i][1], NULL, &err));
        assert_false(settings_check(&s, &err));
        assert_non_null(strstr(err.message, cases[i][1]));
        assert_true(settings_set(&s, "layers", "failures,work,features", NULL, &err));
        err = (struct err){0};
        assert_true(settings_check(&s, &err));
        assert_false(settings_set(&s, "layers", "failures,wrok", NULL, &err));
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lengths_and_techniques_sum_to_the_picture),
        cmocka_unit_test(layers_change_no_bit_of_the_picture),
        cmocka_unit_test(a_length_is_what_another_depth_leaves),
        cmocka_unit_test(techniques_without_weights_have_one_mean),
        cmocka_unit_test(maps_have_the_means_of_the_tallies),
        cmocka_unit_test(a_proposal_counts_once),
        cmocka_unit_test(features),
        cmocka_unit_test(what_an_integrator_has_not_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Values that are not finite are counted wherever they are met, and reported: by walks,
 * by estimators, by the bootstrap and by chains; and where they need not be, they are
 * not. */

#include <string.h>

#include "path/estimate.h"
#include "support/test_run.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

/* A room whose red wall has been broken: no file can give such a material. */
static struct scene *broken_room(void)
{
    struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 0), 34.0, 8);
    test_room(desc);
    test_lamp(desc, 0.35, rgb(3, 2, 1));
    struct bsdf *red = &desc->materials[1];
    assert_true(red->param[0] == 0.6);
    for (int i = 0; i < 6; i++)
        red->param[i] = HUGE_VAL;
    return test_build(desc, false);
}

/* The same wall as a broken mirror, which nothing connects to: only walks meet it. */
static struct scene *broken_mirror(void)
{
    struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 0), 34.0, 8);
    test_room(desc);
    test_lamp(desc, 0.35, rgb(3, 2, 1));
    int mirror = test_material(desc, "mirror", "reflectance", rgb_grey(0.9), NULL, 0.0);
    desc->materials[1] = desc->materials[mirror];
    for (int i = 0; i < 3; i++)
        desc->materials[1].param[i] = HUGE_VAL;
    return test_build(desc, false);
}

/* A path that is cut while it grows: the estimator counts what its walks have cut. */
static void test_walk(void **state)
{
    (void)state;
    struct scene *scene = broken_mirror();
    struct subpaths paths;
    struct contrib out;
    struct rng rng;
    struct ustream_random u;
    ustream_random_init(&u, &rng);
    subpaths_init(&paths, scene, 4);
    contrib_init(&out, estimate_splats(4));
    struct numbers numbers = {&u.stream, &u.stream, &u.stream};
    long cut = 0;
    for (uint64_t i = 0; i < 1000; i++) {
        rng_init(&rng, 3, RNG_TEST, i);
        walk_camera(&paths, &u.stream, 5, HIT_ANY);
        walk_light(&paths, &u.stream, 4, HIT_ANY);
        cut += paths.nonfinite;
        paths.nonfinite = 0;
        rng_init(&rng, 3, RNG_TEST, i);
        estimate_bdpt(&paths, &numbers, &out);
        assert_int_equal(paths.nonfinite, 0);
        assert_int_equal(out.nonfinite, cut);
    }
    assert_true(cut > 50);
    contrib_deinit(&out);
    subpaths_deinit(&paths);
    scene_destroy(scene);
}

/* A corner far from the origin. The small wall lies in the plane of an axis, so rays
 * leave it where its points are, which are rounded on to the other wall, and so are that
 * one's: many a path meets it at a distance of 0. */
static struct scene *rounded_corner(void)
{
    const float far = 3e4f, step = 0x1p-9f; /* between two floats there */
    const struct rgb dark = {0, 0, 0}, glow = {1, 1, 1};
    struct scene_desc *desc = test_desc(vec3(1, far, 1 - far), vec3(0, far, 0.1f - far),
                                        20.0, 8);
    int white = test_diffuse(desc, 0.5, 0.5, 0.5);
    test_quad(desc, vec3(0, far, 2 - far), vec3(0, 2, 0), vec3(0, 0, 2), white, dark);
    test_quad(desc, vec3(0, far, -far), vec3(far, 0, 0), vec3(0, 2, step), white, glow);
    return test_build(desc, false);
}

static void test_corner(void **state)
{
    (void)state;
    struct scene *scene = rounded_corner();
    struct subpaths paths;
    struct rng rng;
    struct ustream_random u;
    long together = 0;
    ustream_random_init(&u, &rng);
    subpaths_init(&paths, scene, 3);
    for (uint64_t i = 0; i < 200000; i++) {
        rng_init(&rng, 5, RNG_TEST, i);
        walk_camera(&paths, &u.stream, 4, HIT_ANY);
        const struct vertex *v = paths.camera;
        for (int j = 2; j < paths.camera_count; j++) {
            struct vec3 d = vec3_sub(v[j].hit.at.p, v[j - 1].hit.at.p);
            together += vec3_dot(d, d) == 0.0f;
            assert_true(v[j].pdf_fwd > 0.0 && isfinite(v[j].pdf_fwd));
            assert_true(isfinite(v[j].mis_tail));
        }
    }
    assert_int_equal(paths.nonfinite, 0);
    assert_true(together > 10);
    subpaths_deinit(&paths);
    scene_destroy(scene);
}

static double reported(const struct scene *scene, const char *const *words)
{
    struct settings s = test_settings(words);
    struct run_result r = test_run(scene, &s);
    double count = r.statistics.nonfinite;
    run_result_deinit(&r);
    return count;
}

static void test_reports(void **state)
{
    (void)state;
    struct scene *scene = broken_room();
    const char *const pt[] = {"integrator=pt", "mutations_per_pixel=20", NULL};
    const char *const bdpt[] = {"integrator=bdpt", "mutations_per_pixel=20", NULL};
    const char *const few[] = {"mutations_per_pixel=0.02", "chains=1", "bootstrap=1000",
                               NULL};
    const char *const many[] = {"mutations_per_pixel=100", "chains=1", "bootstrap=1000",
                                NULL};
    assert_true(reported(scene, pt) > 50.0);
    assert_true(reported(scene, bdpt) > 50.0);
    double bootstrap = reported(scene, few);
    assert_true(bootstrap > 50.0); /* 2 mutations cannot be so many */
    assert_true(reported(scene, many) > bootstrap + 50.0);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_walk),
        cmocka_unit_test(test_corner),
        cmocka_unit_test(test_reports),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

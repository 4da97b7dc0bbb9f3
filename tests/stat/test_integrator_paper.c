/* pfmlt in mode paper is biased: its states have the density f Z, Z the probability that
 * a proposal does not fail (chain/step_pf_paper.c). A test that finds this difference
 * shows that the other tests of pictures would find one of its size; mode counted, at the
 * same budget and by the same test, must differ from bdpt by nothing. */

#include "support/picture_test.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define FALSE_ALARM 1e-4
#define DETECTED    1e-6 /* what the biased mode must be below */

static struct pictures render(const struct scene *scene, const char *mode, int first_seed)
{
    const char *const words[] = {"integrator=pfmlt",
                                 "direct=joint",
                                 "max_depth=5",
                                 "bootstrap=20000",
                                 "mutations_per_pixel=800",
                                 "large_step_probability=0.3",
                                 "estimator=plain",
                                 mode,
                                 NULL};
    return pictures_render(scene, words, first_seed, false);
}

static void test_paper_is_biased(void **state)
{
    (void)state;
    const char *const reference[] = {"integrator=bdpt", "mutations_per_pixel=120",
                                     "max_depth=5", NULL};
    struct scene *scene = test_scene(TEST_DIFFUSE, false);
    struct pictures bdpt = pictures_render(scene, reference, 1, false);
    struct pictures counted = render(scene, "mode=counted", 1001);
    struct pictures paper = render(scene, "mode=paper", 1001);
    printf("counted\n");
    assert_true(picture_same(&counted, &bdpt, 4, 4, FALSE_ALARM));
    printf("paper\n");
    assert_true(picture_signs_p(&paper, &bdpt) < DETECTED);
    pictures_deinit(&bdpt);
    pictures_deinit(&counted);
    pictures_deinit(&paper);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_paper_is_biased)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* All integrators of chains against bdpt on the coffee maker: glass, metal and coated
 * plastic, paths of 12 edges, of which the long ones are found seldom; by the families of
 * support/picture_test.h. The quick test, at 24x30 pixels, sees a brightness that is
 * wrong by more than a tenth; ETALON_LONG, with more mutations a pixel, less. Skipped
 * (77) without the scene. */

#include "import/import.h"

#include "support/picture_test.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define COFFEE      "../shared/scenes/coffee-pbrt3/scene.pbrt"
#define FALSE_ALARM 1e-4
#define BLOCK       6 /* pixels a side of 24x30 */

static const struct {
    const char *words[3];
    const char *quick, *full; /* mutations per pixel; NULL: ETALON_LONG alone */
} variants[] = {
    {{"builder=bdpt", "seed=1", "seed=1"}, NULL, "160"},
    {{"integrator=mmlt", "rule=zsolnai2013", "seed=1"}, "150", "960"},
    {{"integrator=mmlt", "estimator=plain", "large_step_probability=0.3"}, NULL, "960"},
    {{"integrator=mmlt", "direct=separate", "seed=1"}, NULL, "960"},
    {{"integrator=pfmlt", "mode=exact", "rule=zsolnai2013"}, "150", "960"},
    {{"integrator=pfmlt", "mode=counted", "seed=1"}, NULL, "960"},
};

#define VARIANTS ((int)(sizeof variants / sizeof variants[0]))

static void test_coffee(void **state)
{
    (void)state;
    bool full = getenv("ETALON_LONG") != NULL, same = true;
    struct err err = {0};
    struct scene_desc *desc = import_scene(COFFEE, NULL, &err);
    if (desc == NULL)
        test_scene_die(&err);
    desc->width = 24;
    desc->height = 30;
    struct scene *scene = test_build(desc, false);
    const char *const reference[] = {
        "integrator=bdpt", "max_depth=12",
        full ? "mutations_per_pixel=320" : "mutations_per_pixel=24", NULL};
    struct pictures bdpt = pictures_render(scene, reference, 1, full);
    for (int i = 0; i < VARIANTS; i++) {
        const char *budget = full ? variants[i].full : variants[i].quick;
        char word[64];
        if (budget == NULL)
            continue;
        snprintf(word, sizeof word, "mutations_per_pixel=%s", budget);
        const char *const words[] = {"max_depth=12",
                                     full ? "bootstrap=50000" : "bootstrap=20000",
                                     word,
                                     variants[i].words[0],
                                     variants[i].words[1],
                                     variants[i].words[2],
                                     NULL};
        printf("%s, %s, %s\n", words[3], words[4], words[5]);
        struct pictures chains = pictures_render(scene, words, 1001 + 1000 * i, full);
        same = picture_same(&chains, &bdpt, BLOCK, BLOCK,
                            stat_sidak(FALSE_ALARM, VARIANTS)) &&
               same;
        pictures_deinit(&chains);
    }
    assert_true(same);
    pictures_deinit(&bdpt);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_coffee)};
    FILE *there = fopen(COFFEE, "r");
    if (there == NULL) {
        printf("no " COFFEE "\n");
        return 77;
    }
    fclose(there);
    return cmocka_run_group_tests(tests, NULL, NULL);
}

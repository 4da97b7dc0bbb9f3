/* Blind families against an oracle: all paths of up to 8 edges as words of S and D, and
 * all techniques of each integrator, one by one. A word is in a family that is named if
 * and only if no technique samples it; no word is in two families; no family is empty. */

#include <regex.h>
#include <string.h>

#include "base/mem.h"
#include "run/blind_spots.h"
#include "path/estimate.h"
#include "support/test_scene.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#define EDGES 8

/* "L", the events, "E": vertex i is word[i], of `edges` + 1. */
static void spell(unsigned bits, int edges, char *word)
{
    word[0] = 'L';
    for (int i = 1; i < edges; i++)
        word[i] = bits >> (i - 1) & 1 ? 'S' : 'D';
    word[edges] = 'E';
    word[edges + 1] = '\0';
}

/* Whether the scene can have it. A delta light in a pinhole's picture is none. */
static bool may_be(const struct needs *needs, const char *word)
{
    bool delta = needs->point_lights || needs->distant_lights;
    return delta && (!strchr(word, 'S') || needs->delta_bsdfs) &&
           (!strchr(word, 'D') || needs->rough_bsdfs) && (word[1] != 'E' || needs->lens);
}

/* Technique (s,t) on a path from a delta light: the ends of its connection are no S. */
static bool samples(const char *word, int s, int t)
{
    int edges = (int)strlen(word) - 1;
    assert_int_equal(s + t, edges + 1);
    return s > 0 && !(s == 1 && t == 1) && word[s - 1] != 'S' && word[s] != 'S';
}

static unsigned kind_of(int s, int t)
{
    return s == 0   ? TECHNIQUE_HIT
           : t == 1 ? TECHNIQUE_CAMERA
           : s == 1 ? TECHNIQUE_LIGHT
                    : TECHNIQUE_SURFACES;
}

/* By all techniques of these kinds, */
static bool is_sampled(unsigned kinds, const char *word)
{
    int edges = (int)strlen(word) - 1;
    for (int s = 0; s <= edges; s++)
        if (kinds & kind_of(s, edges + 1 - s) && samples(word, s, edges + 1 - s))
            return true;
    return false;
}

/* and by those that mmlt proposes in such a scene. */
static bool is_sampled_by_mmlt(const struct needs *needs, const char *word)
{
    int edges = (int)strlen(word) - 1;
    struct needs pruned = *needs;
    struct techniques techniques;
    pruned.light_connections = pruned.camera_connections = needs->rough_bsdfs;
    pruned.light_hits = needs->area_lights;
    techniques_init(&techniques, &pruned, edges);
    for (int i = 0; i < techniques.count; i++)
        if (samples(word, edges + 1 - techniques.t[i], techniques.t[i]))
            return true;
    return false;
}

static bool is_in(const struct blind_family *family, const char *word)
{
    char pattern[64];
    regex_t regex;
    snprintf(pattern, sizeof pattern, "^%s$", family->paths);
    assert_int_equal(regcomp(&regex, pattern, REG_EXTENDED | REG_NOSUB), 0);
    bool match = regexec(&regex, word, 0, NULL, 0) == 0;
    regfree(&regex);
    return match;
}

static void check(unsigned techniques, bool mmlt, const struct needs *needs,
                  int max_depth)
{
    const struct blind_family *found[BLIND_FAMILIES];
    int count = blind_find(needs, techniques, max_depth, found);
    int members[BLIND_FAMILIES] = {0};
    for (int edges = 1; edges <= max_depth; edges++)
        for (unsigned bits = 0; bits < 1u << (edges - 1); bits++) {
            char word[EDGES + 2];
            int families = 0;
            spell(bits, edges, word);
            for (int i = 0; i < count; i++)
                if (is_in(found[i], word)) {
                    families++;
                    members[i]++;
                }
            if (!may_be(needs, word))
                continue;
            bool sampled = mmlt ? is_sampled_by_mmlt(needs, word)
                                : is_sampled(techniques, word);
            if (families != (sampled ? 0 : 1))
                fail_msg("techniques %u, depth %d: %s is %ssampled and in %d families",
                         techniques, max_depth, word, sampled ? "" : "not ", families);
        }
    for (int i = 0; i < count; i++)
        assert_true(members[i] > 0);
}

static void families_are_what_no_technique_samples(void **state)
{
    (void)state;
    for (unsigned bits = 0; bits < 64; bits++) {
        struct needs needs = {
            .point_lights = bits & 1,
            .distant_lights = bits >> 1 & 1,
            .delta_bsdfs = bits >> 2 & 1,
            .rough_bsdfs = bits >> 3 & 1,
            .lens = bits >> 4 & 1,
            .area_lights = bits >> 5 & 1,
        };
        for (int depth = 1; depth <= EDGES; depth++) {
            check(TECHNIQUES_PT, false, &needs, depth);
            check(TECHNIQUES_PT | TECHNIQUE_CAMERA, false, &needs, depth);
            check(TECHNIQUES_BDPT, false, &needs, depth);
            check(TECHNIQUES_BDPT, true, &needs, depth);
        }
    }
}

static void check_text(struct scene *scene, const char *integrator, const char *builder,
                       int depth, const char *expected)
{
    char text[BLIND_TEXT];
    struct settings settings;
    settings_init(&settings);
    settings.integrator = integrator;
    settings.builder = builder;
    blind_spots(scene->desc, &settings, depth, text);
    assert_string_equal(text, expected);
}

/* A wall, a mirror or a pane of glass, and one light. */
static struct scene *make(const char *material, const struct light_desc *light, bool lamp,
                          double lens, bool keep_all)
{
    struct scene_desc *desc = test_desc(vec3(0, 0, 4), vec3(0, 0, 0), 34.0, 4);
    int other = test_material(desc, material, NULL, rgb_grey(0.0), NULL, 0.0);
    desc->camera.lens_radius = lens;
    desc->camera.focus_distance = 4.0;
    test_quad(desc, vec3(0, 0, 0), vec3(2, 0, 0), vec3(0, 2, 0),
              test_diffuse(desc, 0.5, 0.5, 0.5), rgb_grey(0.0));
    test_quad(desc, vec3(2, 0, 2), vec3(0, 0, 2), vec3(0, 2, 0), other, rgb_grey(0.0));
    if (light)
        scene_desc_add_light(desc, light);
    if (lamp)
        test_lamp(desc, 0.2, rgb_grey(1.0));
    return test_build(desc, keep_all);
}

static void of_scenes_and_integrators(void **state)
{
    (void)state;
    struct light_desc point = {.to_world = xform_identity(), .intensity = rgb_grey(1.0)};
    struct light_desc dead = {.to_world = xform_identity(), .intensity = rgb_grey(0.0)};
    struct light_desc sun = test_beam(&light_distant, vec3(0, 2, 3), vec3(0, 0, 0),
                                      rgb_grey(1.0));
    struct light_desc spot = test_beam(&light_spot, vec3(0, 2, 3), vec3(0, 0, 0),
                                       rgb_grey(1.0));
    struct light_desc sky = {.type = &light_environment,
                             .to_world = xform_identity(),
                             .intensity = rgb_grey(1.0)};
    static const char few[] = "LS+E, LS+(DS+)+E";
    static const char many[] = "LS+E, LS+(DS+)+E, LS(S|D)*DE, LS(S|D)*DD(S|D)*SE";
    const struct {
        const char *material;
        const struct light_desc *light;
        bool lamp;
        double lens;
        const char *integrator, *builder;
        int depth;
        const char *expected;
    } rows[] = {
        {"mirror", &point, false, 0.0, "pt", "bdpt", 12, many},
        {"dielectric", &spot, false, 0.0, "pssmlt", "pt", 12, many},
        {"plastic", &sun, true, 0.0, "pssmlt", "bdpt", 12, few}, /* a lobe is smooth */
        {"mirror", &point, false, 0.0, "mmlt", "bdpt", 12, few},
        {"mirror", &point, false, 0.0, "pfmlt", "bdpt", 12, few},
        {"mirror", &point, false, 0.0, "bdpt", "bdpt", 3, "LS+E"},
        {"mirror", &point, false, 0.0, "pt", "bdpt", 3, "LS+E, LS(S|D)*DE"},
        {"mirror", &point, false, 0.0, "pt", "bdpt", 1, ""},
        {"diffuse", &point, false, 0.0, "pt", "bdpt", 12, ""},
        {"black", &point, false, 0.0, "pt", "bdpt", 12, ""},
        {"diffuse", &point, false, 0.1, "bdpt", "bdpt", 12, "LE"},
        {"mirror", &dead, true, 0.0, "pt", "bdpt", 12, ""},
        {"mirror", &sky, true, 0.1, "pt", "bdpt", 12, ""},
        {"mirror", NULL, true, 0.1, "pt", "bdpt", 12, ""},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        for (int keep_all = 0; keep_all < 2; keep_all++) {
            struct scene *scene = make(rows[i].material, rows[i].light, rows[i].lamp,
                                       rows[i].lens, keep_all);
            check_text(scene, rows[i].integrator, rows[i].builder, rows[i].depth,
                       rows[i].expected);
            scene_destroy(scene);
        }
}

/* The flags of a scene that is not built are those of the one that is. */
static void needs_before_and_after(void **state)
{
    (void)state;
    for (int i = 0; i < TEST_CONTENTS; i++) {
        struct scene *scene = test_scene((enum test_contents)i, false);
        struct needs before = needs_of_desc(scene->desc), after = scene->needs;
        assert_int_equal(before.point_lights, after.point_lights);
        assert_int_equal(before.distant_lights, after.distant_lights);
        assert_int_equal(before.delta_bsdfs, after.delta_bsdfs);
        assert_int_equal(before.rough_bsdfs, after.rough_bsdfs);
        assert_int_equal(before.lens, after.lens);
        scene_destroy(scene);
    }
}

static void the_sentence(void **state)
{
    (void)state;
    struct settings settings;
    struct text text = {0};
    struct light_desc point = {.to_world = xform_identity(), .intensity = rgb_grey(1.0)};
    struct scene *scene = make("mirror", &point, false, 0.0, false);
    settings_init(&settings);
    assert_true(blind_spots_tell(scene->desc, &settings, 12, &text));
    assert_non_null(strstr(text.data, "pssmlt cannot sample all light of point and spot "
                                      "lights: LS+E (their images"));
    text.length = 0;
    settings.builder = "pt";
    assert_true(blind_spots_tell(scene->desc, &settings, 12, &text));
    assert_non_null(strstr(text.data, "pssmlt over pt cannot"));
    assert_non_null(strstr(text.data, "LS(S|D)*DE (caustics"));
    assert_false(blind_spots_tell(scene->desc, &settings, 1, &text));
    mem_free(text.data);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(families_are_what_no_technique_samples),
        cmocka_unit_test(of_scenes_and_integrators),
        cmocka_unit_test(needs_before_and_after),
        cmocka_unit_test(the_sentence),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

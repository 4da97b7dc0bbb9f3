/* A checkpoint is bound to exactly those settings of which the table says so: a setting
 * that decides bits and is not in the identity would make a resumed run wrong without a
 * word, one that decides none and is in it would refuse for nothing. Nothing here is left
 * to chance. */
#include "lab/identity.h"

#include "base/mem.h"
#include "lab/scene_settings.h"
#include "support/setting_examples.h"
#include "support/test_file.h"
#include "support/test_run.h"

#include <stdlib.h>
#include <string.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

/* Of all integrators rjmlt reads the most settings; builder is pssmlt's, and part of the
 * identity of all. With eight mutations a pixel a run would be held against `until_...`,
 * which may end it. */
static struct settings settings_with(const char *key, const char *value)
{
    static const char *const words[] = {"integrator=rjmlt", "mutations_per_pixel=7",
                                        "bootstrap=300",    "chains=5",
                                        "max_depth=4",      "size=6x6",
                                        "direct=joint",     NULL};
    struct settings s = test_settings(words);
    struct err err = {0};
    assert_true(settings_set(&s, key, value, NULL, &err));
    return s;
}

/* The scene as the program would build it with these settings. */
static struct scene *build(const struct settings *s)
{
    struct scene_desc *desc = test_desc(vec3(0, 1, 4.5f), vec3(0, 1, 0), 34.0, 3);
    struct scene_options options = scene_settings_options(s);
    struct err err = {0};
    int white = test_diffuse(desc, 0.7, 0.7, 0.7);
    test_quad(desc, vec3(0, 0, 0), vec3(2, 0, 0), vec3(0, 0, -2), white, rgb_grey(0));
    test_quad(desc, vec3(0, 2, 0), vec3(0.5f, 0, 0), vec3(0, 0, 0.5f), white,
              rgb(3, 2, 1));
    struct scene *scene = scene_build(desc, &options, &err);
    if (scene == NULL)
        test_scene_die(&err);
    return scene;
}

static struct text identity_of(const struct settings *s)
{
    char *path = test_file("identity.scene");
    struct scene *scene = build(s);
    struct identity identity;
    struct text text = {0};
    struct err err = {0};
    assert_true(text_write_file(path, "scene", 5, &err));
    assert_true(identity_init(&identity, path, scene, s, NULL, &err));
    for (int i = 0; i < identity.count; i++)
        text_append(&text, "%s=%s\n", identity.entries[i].name,
                    identity.entries[i].value);
    identity_deinit(&identity);
    scene_destroy(scene);
    remove(path);
    mem_free(path);
    return text;
}

static bool has_entry(const struct text *identity, const char *name)
{
    char *start = text_format("\n%s=", name);
    bool found = strstr(identity->data, start) != NULL;
    mem_free(start);
    return found;
}

/* Whether two values of it have different identities. */
static bool changes_identity(const struct setting *row)
{
    struct setting_examples e = setting_examples(row, false);
    struct settings s = settings_with(row->name, e.texts[0]);
    struct text first = identity_of(&s);
    bool changes = false;
    for (int i = 1; i < e.count; i++) {
        s = settings_with(row->name, e.texts[i]);
        struct text other = identity_of(&s);
        changes = changes || !text_equal(first.data, other.data);
        mem_free(other.data);
    }
    mem_free(first.data);
    return changes;
}

/* With a single word there is nothing to change to. */
static bool has_choice(const struct setting *row)
{
    return row->kind != SETTING_NAME || row->words[1].word != NULL;
}

static void identity_is_what_rows_declare(void **state)
{
    (void)state;
    struct settings s = settings_with("seed", "1");
    struct text identity = identity_of(&s);
    for (int i = 0; settings_row(i); i++) {
        const struct setting *row = settings_row(i);
        bool declared = row->resume == RESUME_SAME;
        if (has_entry(&identity, row->name) != declared)
            fail_msg("%s is %s the identity", row->name,
                     declared ? "missing from" : "part of");
        if (has_choice(row) && changes_identity(row) != declared)
            fail_msg("%s %s", row->name,
                     declared ? "does not change the identity" : "changes the identity");
    }
    mem_free(identity.data);
}

static struct run_result picture_of(const char *key, const char *value)
{
    struct settings s = settings_with(key, value);
    struct scene *scene = build(&s);
    struct run_result result = test_run(scene, &s);
    scene_destroy(scene);
    return result;
}

/* What the table calls free decides no bit of a picture. A setting that is declared free
 * and is none is seen by any bit of any pixel. */
static void free_settings_change_no_bit(void **state)
{
    (void)state;
    for (int i = 0; settings_row(i); i++) {
        const struct setting *row = settings_row(i);
        struct setting_examples e = setting_examples(row, true);
        if (row->resume != RESUME_FREE)
            continue;
        struct run_result first = picture_of(row->name, e.texts[0]);
        size_t bytes = 3 * sizeof(float) * (size_t)first.image->width *
                       (size_t)first.image->height;
        assert_true(first.statistics.b > 0.0);
        for (int j = 1; j < e.count; j++) {
            struct run_result other = picture_of(row->name, e.texts[j]);
            if (memcmp(first.image->pixels, other.image->pixels, bytes) != 0)
                fail_msg("%s=%s and %s: other pictures", row->name, e.texts[0],
                         e.texts[j]);
            run_result_deinit(&other);
        }
        run_result_deinit(&first);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(identity_is_what_rows_declare),
        cmocka_unit_test(free_settings_change_no_bit),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* lab/fingerprint: which files a scene is made of. */
#include "lab/fingerprint.h"

#include "base/mem.h"
#include "base/text.h"

#include <stdlib.h>
#include <string.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include <unistd.h>

static const struct {
    const char *name, *text;
} files[] = {
    {"scene.pbrt", "Include \"part.pbrt\" WorldBegin WorldEnd"},
    {"part.pbrt", "Shape \"plymesh\" \"string filename\" \"mesh.ply\""},
    {"mesh.ply", "picture.png"},
    {"picture.png", "x"},
    {"lux.lxs", "Include \"part.lxm\""},
    {"part.lxm", "Shape \"plymesh\" \"string filename\" [\"mesh.ply\"]"},
};

#define FILES (sizeof files / sizeof files[0])

static int set_up(void **state)
{
    char *folder = text_copy("/tmp/etalon_fingerprint_XXXXXX");
    *state = folder;
    if (mkdtemp(folder) == NULL)
        return -1;
    for (size_t i = 0; i < FILES; i++) {
        char *path = text_join(folder, files[i].name);
        text_write_file(path, files[i].text, strlen(files[i].text), NULL);
        mem_free(path);
    }
    return 0;
}

static int tear_down(void **state)
{
    for (size_t i = 0; i < FILES; i++) {
        char *path = text_join(*state, files[i].name);
        unlink(path);
        mem_free(path);
    }
    rmdir(*state);
    mem_free(*state);
    return 0;
}

static bool names(const char *folder, const char *scene, const char *file)
{
    struct err err = {0};
    bool named = false;
    char *from = text_join(folder, scene), *to = text_join(folder, file);
    assert_true(fingerprint_names(from, to, &named, &err));
    mem_free(from);
    mem_free(to);
    return named;
}

static void names_lead_on(void **state)
{
    assert_true(names(*state, "scene.pbrt", "scene.pbrt"));
    assert_true(names(*state, "scene.pbrt", "part.pbrt"));
    assert_true(names(*state, "scene.pbrt", "./mesh.ply"));
    assert_false(names(*state, "scene.pbrt", "picture.png")); /* a mesh names nothing */
    assert_false(names(*state, "scene.pbrt", "lux.lxs"));
    assert_false(names(*state, "scene.pbrt", "absent.png"));
    assert_true(names(*state, "lux.lxs", "mesh.ply"));
}

static void content_counts(void **state)
{
    struct hash before, after;
    char *scene = text_join(*state, "lux.lxs"), *mesh = text_join(*state, "mesh.ply");
    assert_true(fingerprint_scene(scene, NULL, &before, NULL));
    assert_true(text_write_file(mesh, "y", 1, NULL));
    assert_true(fingerprint_scene(scene, NULL, &after, NULL));
    assert_true(before.value != after.value);
    mem_free(scene);
    mem_free(mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_lead_on),
        cmocka_unit_test(content_counts),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}

/* cli/info: counts of a scene whose contents are known; the JSON says them to a reader of
 * JSON; memory and films are those that are there. */
#include "cli/info.h"

#include "base/doc.h"
#include "base/mem.h"
#include "base/text.h"
#include "image/film.h"
#include "scene/triangle.h"
#include "support/test_file.h"

#include <stdlib.h>
#include <string.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

static const char scene[] =
    "LookAt 0 0 5  0 0 0  0 1 0\n"
    "Camera \"perspective\" \"float fov\" [40]\n"
    "Film \"image\" \"integer xresolution\" [64] \"integer yresolution\" [32]\n"
    "PixelFilter \"gaussian\"\n"
    "Integrator \"bdpt\" \"integer maxdepth\" [4]\n"
    "WorldBegin\n"
    "LightSource \"point\" \"rgb I\" [1 1 1]\n"
    "LightSource \"distant\" \"rgb L\" [1 1 1]\n"
    "ObjectBegin \"two\"\n"
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]\n"
    "  \"point P\" [0 0 0 1 0 0 1 1 0 0 1 0]\n"
    "Shape \"sphere\" \"float radius\" [2]\n"
    "ObjectEnd\n"
    "ObjectInstance \"two\"\n"
    "Material \"mirror\"\n"
    "Translate 5 0 0\n"
    "ObjectInstance \"two\"\n"
    "WorldEnd\n";

static void open_scene(struct session *session, const struct args *args)
{
    struct err err = {0};
    char *path = test_file("info.pbrt");
    assert_true(text_write_file(path, scene, sizeof scene - 1, &err));
    assert_true(session_open(session, path, args, &err));
    remove(path);
    mem_free(path);
}

static struct doc *read_json(const struct info *info)
{
    struct err err = {0};
    char *text = info_json(info);
    struct doc *doc = doc_parse(text, strlen(text), "json", &err);
    if (!doc)
        fail_msg("%s in\n%s", err.message, text);
    mem_free(text);
    return doc;
}

static double at(const struct doc_node *root, const char *key, const char *below)
{
    double value = -1.0;
    const struct doc_node *node = doc_get(root, key);
    assert_non_null(node);
    if (below)
        node = doc_get(node, below);
    assert_non_null(node);
    assert_true(doc_to_double(node, &value, NULL));
    return value;
}

static void json_says_what_is_there(void **state)
{
    (void)state;
    struct session session;
    struct info info;
    open_scene(&session, &(struct args){0});
    info_gather(&info, &session);
    struct doc *doc = read_json(&info);
    const struct doc_node *root = doc_root(doc);
    assert_int_equal(doc_kind(root), DOC_MAP);
    assert_true(at(root, "film", "width") == 64.0);
    assert_true(at(root, "max_depth", NULL) == 5.0);
    assert_true(at(root, "shapes", "total") == 4.0);
    assert_true(at(root, "shapes", "mesh") == 2.0);
    assert_true(at(root, "shapes", "sphere") == 2.0);
    assert_true(at(root, "triangles", NULL) == 4.0);
    assert_true(at(root, "instances", NULL) == 2.0);
    assert_true(at(root, "instances_shared", NULL) == 0.0);
    assert_true(at(root, "lights", "point") == 1.0);
    assert_true(at(root, "lights", "distant") == 1.0);
    assert_true(at(root, "memory_bytes", "bvh") > 0.0);
    assert_string_equal(doc_text(doc_get(root, "integrator")), "pssmlt");
    const struct doc_node *low = doc_item(doc_get(root, "bounds"), 0);
    double x;
    assert_true(doc_to_double(doc_item(low, 0), &x, NULL));
    assert_float_equal(x, -2.0, 1e-4);
    const struct doc_node *warning = doc_item(doc_get(root, "warnings"), 0);
    assert_non_null(strstr(doc_text(doc_get(warning, "file")), "info.pbrt"));
    assert_true(at(warning, "line", NULL) == 4.0);
    assert_true(at(warning, "count", NULL) == 1.0);
    doc_destroy(doc);
    session_close(&session);
}

/* Two triangles of four corners: 12 bytes a corner and triangle, and a record of each
 * triangle. */
static void geometry_is_what_meshes_take(void **state)
{
    (void)state;
    struct session session;
    struct info info;
    open_scene(&session, &(struct args){0});
    info_gather(&info, &session);
    size_t meshes = 2 * (4 * 12 + 2 * 12 + 2 * TRIANGLE_RECORD_PLAIN * sizeof(float) +
                         sizeof(struct mesh));
    size_t rest = 4 * sizeof(struct shape) + 2 * sizeof(struct quadric);
    assert_int_equal(info.memory.geometry, meshes + rest);
    session_close(&session);
}

static double films_of(const char *integrator, long threads)
{
    struct session session;
    struct info info;
    open_scene(&session, &(struct args){0});
    session.settings.integrator = integrator;
    session.settings.threads = threads;
    info_gather(&info, &session);
    session_close(&session);
    return info.run.films;
}

/* Of up to 5 edges; those of 1 and 2 are plain samples of mmlt and pfmlt. */
static void films_are_counted_for_the_integrator(void **state)
{
    (void)state;
    double film = film_bytes(64, 32), lane = film_lanes_bytes(64, 32, 2);
    double replicas = 64.0 * 32.0 * 8.0 * 8.0; /* chains: for each thread */
    double sums = 64.0 * 32.0 * (3.0 * 16.0 + 4.0) + replicas;
    double pending = replicas_bytes(64, 32, 1, 3, false); /* of the pass under way */
    assert_true(films_of("pt", 3) == sums + pending);
    assert_true(films_of("bdpt", 3) == sums + pending + film + 2.0 * lane);
    assert_true(films_of("pssmlt", 3) == 2.0 * (film + 2.0 * lane) + 3.0 * replicas);
    double chains = 2.0 * replicas + replicas_bytes(64, 32, 1, 2, false);
    assert_true(films_of("mmlt", 2) == sums + 4.0 * (film + lane) + chains);
    assert_true(films_of("pfmlt", 2) == sums + 5.0 * (film + lane) + chains);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(json_says_what_is_there),
        cmocka_unit_test(geometry_is_what_meshes_take),
        cmocka_unit_test(films_are_counted_for_the_integrator),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

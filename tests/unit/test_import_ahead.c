/* import/ahead: what many threads read ahead changes nothing, neither meshes and pictures
 * nor notes, their order, and which error is told. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "support/import_test.h"

#define THREADS 4

static void write_ply(const char *name, const char *last)
{
    char text[512];
    snprintf(text, sizeof text,
             "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float "
             "y\nproperty float z\nelement face 2\nproperty list uchar int "
             "vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n%s\n3 0 1 2\n3 0 1 3\n",
             last);
    import_test_write(name, text);
}

static void write_files(void)
{
    static const unsigned char tga[18 + 6] = {
        [2] = 2, [12] = 2, [14] = 1, [16] = 24, [18] = 10, 20, 30, 100, 150, 200};
    write_ply("a.ply", "0 0 1");
    write_ply("b.ply", "0 0 2");
    write_ply("flat.ply", "1 0 0"); /* its second triangle has no area: a note */
    write_ply("wrong.ply", "0 0 one");
    write_ply("worse.ply", "0 zero 1");
    import_test_write("c.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    import_test_write_bytes("picture.tga", tga, sizeof tga);
    import_test_write_bytes("cut.tga", tga, 12);
    import_test_write("part.pbrt", "Shape \"plymesh\" \"string filename\" \"b.ply\"\n");
}

#define HEAD      "Camera \"perspective\"\nWorldBegin\n"
#define PLY(name) "Shape \"plymesh\" \"string filename\" \"" name "\"\n"
#define PICTURE(name, more) \
    "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"" name "\"" more "\n"

static void same_arrays(const void *a, const void *b, size_t size)
{
    assert_int_equal(a == NULL, b == NULL);
    if (a)
        assert_memory_equal(a, b, size);
}

static void same_scenes(const struct scene_desc *a, const struct scene_desc *b)
{
    assert_int_equal(a->shape_count, b->shape_count);
    for (size_t i = 0; i < a->shape_count; i++) {
        const struct mesh *m = a->shapes[i].mesh, *n = b->shapes[i].mesh;
        assert_int_equal(m->vertex_count, n->vertex_count);
        assert_int_equal(m->triangle_count, n->triangle_count);
        same_arrays(m->p, n->p, 12 * (size_t)m->vertex_count);
        same_arrays(m->n, n->n, 12 * (size_t)m->vertex_count);
        same_arrays(m->index, n->index, 12 * (size_t)m->triangle_count);
    }
    assert_int_equal(a->textures.image_count, b->textures.image_count);
    for (size_t i = 0; i < a->textures.image_count; i++) {
        const struct texture_image *m = a->textures.images[i], *n = b->textures.images[i];
        assert_string_equal(m->path, n->path);
        assert_int_equal(m->encoding, n->encoding);
        assert_memory_equal(m->bytes, n->bytes, m->size);
        assert_memory_equal(m->decode, n->decode, sizeof m->decode);
    }
    assert_int_equal(a->log.count, b->log.count);
    for (size_t i = 0; i < a->log.count; i++) {
        assert_string_equal(a->log.notes[i].text, b->log.notes[i].text);
        assert_int_equal(a->log.notes[i].line, b->log.notes[i].line);
        assert_int_equal(a->log.notes[i].count, b->log.notes[i].count);
    }
}

struct told {
    long most, count;
};

static void tell(void *ctx, long done, long count)
{
    struct told *told = ctx;
    told->most = done > told->most ? done : told->most;
    told->count = count;
}

/* `files`: how many are read ahead, each once. */
static void check_same(const char *name, const char *text, size_t shapes, size_t notes,
                       long files)
{
    struct err err = {0};
    struct told told = {0};
    struct import_options options = {
        .threads = THREADS, .progress = tell, .progress_ctx = &told};
    write_files();
    const char *path = import_test_write(name, text);
    struct scene_desc *plain = import_scene(path, NULL, &err);
    struct scene_desc *ahead = import_scene(path, &options, &err);
    if (!plain)
        fail_msg("%d:%d: %s", err.line, err.col, err.message);
    assert_non_null(ahead);
    assert_int_equal(plain->shape_count, shapes);
    assert_int_equal(plain->log.count, notes);
    same_scenes(plain, ahead);
    assert_int_equal(ahead->textures.prepared_count, 0);
    assert_int_equal(told.count, files);
    assert_int_equal(told.most, files);
    scene_desc_destroy(plain);
    scene_desc_destroy(ahead);
}

static void pbrt_is_the_same(void **state)
{
    (void)state;
    check_same("scene.pbrt",
               HEAD PICTURE("picture.tga", "") PICTURE("absent.png", "") PICTURE(
                   "picture.tga", "\"string encoding\" \"linear\"") PLY("flat.ply")
                   PLY("a.ply") "Include \"part.pbrt\"\n"
                                "# \"worse.ply\" it isn't\n" PLY(
                                    "a.ply") "LightSource \"infinite\"\nWorldEnd\n",
               4, 2, 6);
}

/* Read ahead as what is usual, asked for as something else. */
static void encodings_are_the_same(void **state)
{
    (void)state;
    check_same("scene.pbrt",
               HEAD PICTURE("picture.tga", "\"string encoding\" \"linear\"")
                   PICTURE("picture.tga", "") PLY("a.ply") "WorldEnd\n",
               1, 0, 2);
}

static void mitsuba_is_the_same(void **state)
{
    (void)state;
    check_same("scene.xml",
               "<scene version='3.0.0'><shape type=\"obj\"><string name='filename' "
               "value='c.obj'/></shape>\n<shape type='ply'><string name='filename' "
               "value=\"a.ply\"/></shape></scene>",
               2, 0, 2);
}

static void yaml_is_the_same(void **state)
{
    (void)state;
    check_same("scene.yaml",
               "camera: {position: [0, 1, 2], target: [0, 0, 0], fov: 50}\n"
               "film: {width: 8, height: 8}\nmaterials:\n  wall: {type: diffuse}\n"
               "shapes:\n  - {type: mesh, material: wall, file: b.ply}\n"
               "  - type: mesh\n    material: wall\n    file: a.ply\n",
               2, 0, 2);
}

static void check_error(const char *text, const char *expected)
{
    struct err plain = {0}, ahead = {0};
    struct import_options options = {.threads = THREADS};
    write_files();
    const char *path = import_test_write("scene.pbrt", text);
    assert_null(import_scene(path, NULL, &plain));
    assert_null(import_scene(path, &options, &ahead));
    import_test_error_is(&plain, expected);
    import_test_error_is(&ahead, expected);
    assert_string_equal(plain.file, ahead.file);
    assert_string_equal(plain.message, ahead.message);
    assert_int_equal(plain.line, ahead.line);
    assert_int_equal(plain.col, ahead.col);
}

/* The first by place, whichever was read first. */
static void errors_are_the_same(void **state)
{
    (void)state;
    check_error(HEAD PLY("a.ply") PLY("wrong.ply") PLY("worse.ply"), "wrong.ply:13:5");
    check_error(HEAD PLY("worse.ply") PLY("wrong.ply"), "worse.ply:13:3");
    check_error(HEAD PLY("a.ply") "Shap\n" PLY("worse.ply"), "scene.pbrt:4:1");
    check_error(HEAD PLY("absent.ply") PLY("worse.ply"), "absent.ply");
    check_error(HEAD PICTURE("cut.tga", "") PLY("worse.ply"), "cut.tga");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pbrt_is_the_same),    cmocka_unit_test(encodings_are_the_same),
        cmocka_unit_test(mitsuba_is_the_same), cmocka_unit_test(yaml_is_the_same),
        cmocka_unit_test(errors_are_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

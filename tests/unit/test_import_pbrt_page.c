/* docs/formats-pbrt.md says of every line of pbrt's pages what becomes of it: each is
 * loaded, in a scene of each version, and held to that. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "base/mem.h"
#include "support/import_test.h"

#include <zlib.h>

#define PAGE  "docs/formats-pbrt.md"
#define CELLS 4

/* Cells of a row "| `line` | v3 | v4 | ... |", cut in place; false if it is no such row.
 */
static bool cut_row(char *row, char *cell[CELLS])
{
    if (strncmp(row, "| `", 3) != 0)
        return false;
    cell[0] = row + 3;
    for (int i = 1; i < CELLS; i++) {
        char *end = strstr(cell[i - 1], " | ");
        assert_non_null(end);
        *end = '\0';
        cell[i] = end + 3;
    }
    char *quote = strrchr(cell[0], '`');
    assert_non_null(quote);
    *quote = '\0';
    return true;
}

static bool starts(const char *line, const char *directive)
{
    size_t length = strlen(directive);
    return strncmp(line, directive, length) == 0 && line[length] == ' ';
}

static bool before_world(const char *line)
{
    static const char *const words[] = {"Camera",     "Film",       "PixelFilter",
                                        "Integrator", "Sampler",    "Accelerator",
                                        "Option",     "ColorSpace", "TransformTimes"};
    for (size_t i = 0; i < sizeof words / sizeof words[0]; i++)
        if (starts(line, words[i]))
            return true;
    return false;
}

/* A scene of that version around the line, with names that the lines may use. */
static void write_scene(struct text *text, const char *line, bool v4)
{
    bool first = before_world(line);
    text->length = 0;
    text_append(text, "%s\n", starts(line, "Camera") ? "" : "Camera \"perspective\"");
    if (!starts(line, "Film"))
        text_append(text, "Film \"%s\"\n", v4 ? "rgb" : "image");
    if (!starts(line, "PixelFilter"))
        text_append(text, "PixelFilter \"box\"\n");
    text_append(text, "%s\nWorldBegin\n", first ? line : "");
    text_append(text,
                "MakeNamedMaterial \"m\" \"string type\" \"%s\"\n"
                "Texture \"f\" \"float\" \"checkerboard\"\n"
                "Texture \"s\" \"spectrum\" \"checkerboard\"\n",
                v4 ? "diffuse" : "matte");
    text_append(text, "%s\n%s", first ? "" : line, v4 ? "" : "WorldEnd");
}

/* "silent", "warned" or the error. */
static const char *outcome(const char *scene, struct err *err)
{
    struct scene_desc *desc = import_scene(import_test_write("scene.pbrt", scene), NULL,
                                           err);
    if (!desc)
        return err->message;
    bool warned = desc->log.count > 0;
    scene_desc_destroy(desc);
    return warned ? "warned" : "silent";
}

static bool agrees(const char *word, const char *line, bool v4, struct text *text)
{
    static const char *const silent[] = {"read", "nothing"}, *const warned[] = {
                                                                 "nearest", "left out"};
    struct err err = {0};
    if (text_equal(word, "-"))
        return true;
    write_scene(text, line, v4);
    const char *got = outcome(text->data, &err);
    for (int i = 0; i < 2; i++)
        if ((text_equal(word, silent[i]) && text_equal(got, "silent")) ||
            (text_equal(word, warned[i]) && text_equal(got, "warned")))
            return true;
    if (text_equal(word, "error") && !text_equal(got, "silent") &&
        !text_equal(got, "warned"))
        return true;
    print_message("%s: %s: the page says \"%s\", it was: %s\n", v4 ? "v4" : "v3", line,
                  word, got);
    return false;
}

static void write_files(void)
{
    static const float texels[4 * 2 * 3] = {1.0f, 0.5f, 1.0f};
    static const int sizes[2][2] = {{4, 2}, {2, 2}};
    static const char *const names[] = {"map.pfm", "square.pfm"};
    for (int i = 0; i < 2; i++) {
        char data[256];
        int head = snprintf(data, sizeof data, "PF\n%d %d\n-1\n", sizes[i][0],
                            sizes[i][1]);
        size_t bytes = (size_t)(sizes[i][0] * sizes[i][1]) * 3 * sizeof(float);
        memcpy(data + head, texels, bytes);
        import_test_write_bytes(names[i], data, (size_t)head + bytes);
    }
    import_test_write("mesh.ply",
                      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                      "property float y\nproperty float z\nelement face 1\n"
                      "property list uchar int vertex_indices\nend_header\n"
                      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    import_test_write("eta.spd", "400 1\n700 2\n");
    import_test_write("more.pbrt", "Shape \"sphere\"\n");
    gzFile f = gzopen(import_test_path("more.pbrt.gz"), "wb");
    assert_non_null(f);
    assert_true(gzputs(f, "Shape \"sphere\"\n") > 0);
    assert_int_equal(gzclose(f), Z_OK);
}

static void test_page(void **state)
{
    (void)state;
    size_t size;
    struct err err = {0};
    struct text scene = {0};
    char *page = text_read_file(PAGE, &size, NULL, &err), *cell[CELLS];
    assert_non_null(page);
    write_files();
    int rows = 0, wrong = 0;
    for (char *row = page, *next; row; row = next) {
        next = strchr(row, '\n');
        if (next)
            *next++ = '\0';
        if (!cut_row(row, cell))
            continue;
        rows++;
        wrong += !agrees(cell[1], cell[0], false, &scene);
        wrong += !agrees(cell[2], cell[0], true, &scene);
    }
    mem_free(page);
    mem_free(scene.data);
    print_message("%d lines\n", rows);
    assert_true(rows > 200);
    assert_int_equal(wrong, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_page)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

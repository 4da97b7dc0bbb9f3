/* docs/formats-pbrt.md says of every line of pbrt's pages what becomes of it: each is
 * loaded, in a scene of each version, and held to that. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/import_page.h"

#include <zlib.h>

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

static void write_files(void)
{
    import_test_write("more.pbrt", "Shape \"sphere\"\n");
    gzFile f = gzopen(import_test_path("more.pbrt.gz"), "wb");
    assert_non_null(f);
    assert_true(gzputs(f, "Shape \"sphere\"\n") > 0);
    assert_int_equal(gzclose(f), Z_OK);
}

static void test_page(void **state)
{
    static const struct import_page page = {.path = "docs/formats-pbrt.md",
                                            .scene = "scene.pbrt",
                                            .versions = {"v3", "v4"},
                                            .write = write_scene};
    (void)state;
    write_files();
    assert_true(import_page_check(&page) > 200);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_page)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* Scene files of a few lines that stand for very much, each line doubling what the one
 * before made: one error, and no wait for it. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "base/mem.h"
#include "support/import_test.h"

#define DOUBLINGS 28

static void bad(const char *name, struct text *text, const char *expected)
{
    import_test_bad(name, text->data, expected);
    mem_free(text->data);
}

static void test_parameters(void **state)
{
    struct text text = {0};
    (void)state;
    text_append(&text,
                "<scene version=\"3.0.0\">\n<default name=\"a0\" value=\"xx\"/>\n");
    for (int i = 1; i < DOUBLINGS; i++)
        text_append(&text, "<default name=\"a%d\" value=\"$a%d$a%d\"/>\n", i, i - 1,
                    i - 1);
    text_append(&text, "</scene>\n");
    /* 2^(i + 1) bytes in line i + 2 */
    bad("scene.xml", &text,
        "scene.xml:18:1: $parameters make an attribute of more than 65536 bytes");
}

static void test_mitsuba_textures(void **state)
{
    struct text text = {0};
    (void)state;
    text_append(
        &text, "<scene version=\"3.0.0\">\n<texture type=\"checkerboard\" id=\"t0\"/>\n");
    for (int i = 1; i < DOUBLINGS; i++)
        text_append(&text,
                    "<texture type=\"checkerboard\" id=\"t%d\"><ref name=\"color0\" "
                    "id=\"t%d\"/><ref name=\"color1\" id=\"t%d\"/></texture>\n",
                    i, i - 1, i - 1);
    text_append(&text,
                "<shape type=\"sphere\"><bsdf type=\"diffuse\"><ref name=\"reflectance\" "
                "id=\"t%d\"/></bsdf></shape></scene>\n",
                DOUBLINGS - 1);
    /* 4 2^i - 1 nodes in line i + 2 */
    bad("scene.xml", &text, "scene.xml:13:1: a texture made of more than 4096 textures");
}

/* No more than the stack holds. */
static void test_mitsuba_depth(void **state)
{
    struct text text = {0};
    (void)state;
    text_append(
        &text, "<scene version=\"3.0.0\">\n<texture type=\"checkerboard\" id=\"t0\"/>\n");
    for (int i = 1; i < 50000; i++)
        text_append(&text,
                    "<texture type=\"scale\" id=\"t%d\"><ref id=\"t%d\"/></texture>\n", i,
                    i - 1);
    text_append(&text,
                "<shape type=\"sphere\"><bsdf type=\"diffuse\"><ref name=\"reflectance\" "
                "id=\"t49999\"/></bsdf></shape></scene>\n");
    bad("scene.xml", &text, ":1: more than 100 objects inside one another");
}

static void test_pbrt_textures(void **state)
{
    struct text text = {0};
    (void)state;
    text_append(&text, "WorldBegin\nTexture \"t0\" \"spectrum\" \"checkerboard\"\n");
    for (int i = 1; i < DOUBLINGS; i++)
        text_append(&text,
                    "Texture \"t%d\" \"spectrum\" \"scale\" \"texture tex1\" \"t%d\" "
                    "\"texture tex2\" \"t%d\"\n",
                    i, i - 1, i - 1);
    text_append(&text, "WorldEnd\n");
    /* 4 2^i - 1 nodes in line i + 2 */
    bad("scene.pbrt", &text,
        "scene.pbrt:13:1: a texture made of more than 4096 textures");
}

/* Files that each include the next one twice. */
static void write_chain(const char *ending, const char *head, const char *include,
                        const char *tail, int files)
{
    char name[32], line[80];
    for (int i = 0; i < files; i++) {
        struct text text = {0};
        snprintf(name, sizeof name, "f%d.%s", i, ending);
        snprintf(line, sizeof line, include, i + 1);
        text_append(&text, "%s%s%s%s", head, line, line, tail);
        import_test_write(name, text.data);
        mem_free(text.data);
    }
    snprintf(name, sizeof name, "f%d.%s", files, ending);
    import_test_write(name, head[0] ? "<scene/>" : "\n");
}

static void test_includes(void **state)
{
    struct err err = {0}, err_xml = {0};
    (void)state;
    write_chain("pbrt", "", "Include \"f%d.pbrt\"\n", "", 31);
    assert_null(import_scene(import_test_path("f0.pbrt"), NULL, &err));
    import_test_error_is(&err, ":9: more than 10000 files are included");
    write_chain("xml", "<scene version=\"3.0.0\">\n", "<include filename=\"f%d.xml\"/>\n",
                "</scene>\n", 15);
    assert_null(import_scene(import_test_path("f0.xml"), NULL, &err_xml));
    import_test_error_is(&err_xml, ":1: more than 10000 files are included");
}

static void test_subdivision(void **state)
{
    struct text text = {0};
    (void)state;
    text_append(&text,
                "WorldBegin\nShape \"loopsubdiv\" \"integer nlevels\" 10 \"integer "
                "indices\" [0 1 2 0 2 3 0 3 1 1 3 2]\n\"point P\" [0 0 0 1 0 0 0 1 0 0 0 "
                "1]\nWorldEnd\n");
    bad("scene.pbrt", &text, "scene.pbrt:2:41: no surface: ");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_parameters),    cmocka_unit_test(test_mitsuba_textures),
        cmocka_unit_test(test_mitsuba_depth), cmocka_unit_test(test_pbrt_textures),
        cmocka_unit_test(test_includes),      cmocka_unit_test(test_subdivision),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* docs/formats-mitsuba.md says of every line of Mitsuba's pages what becomes of it: each
 * is loaded, in a scene of each version, and held to that. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/import_page.h"
#include "support/serialized_make.h"

/* Whether the line is an element of that name, perhaps of that type. */
static bool is(const char *line, const char *element, const char *type)
{
    size_t length = strlen(element);
    char kind[64];
    snprintf(kind, sizeof kind, "type=\"%s\"", type ? type : "");
    const char *end = strchr(line, '>');
    const char *found = strstr(line, kind);
    return line[0] == '<' && strncmp(line + 1, element, length) == 0 &&
           (line[length + 1] == ' ' || line[length + 1] == '/' ||
            line[length + 1] == '>') &&
           (!type || (found && end && found < end));
}

static bool is_any(const char *line, const char *const *elements)
{
    for (; *elements; elements++)
        if (is(line, *elements, NULL))
            return true;
    return false;
}

/* What a line needs around it, but for sensors and their parts. */
static const char *const steps[] = {"translate", "rotate", "scale",
                                    "lookat",    "matrix", NULL};
static const char *const colours[] = {"rgb",      "srgb",      "float", "xyz",
                                      "spectrum", "blackbody", NULL};

static void write_around(struct text *text, const char *line)
{
    const char *before = "", *after = "";
    if (is(line, "bsdf", NULL) && !strstr(line, " id=")) {
        before = "<shape type=\"rectangle\">";
        after = "</shape>";
    } else if (is(line, "emitter", "area") && strstr(line, "loose") == NULL) {
        before = "<shape type=\"rectangle\">";
        after = "</shape>";
    } else if (is(line, "emitter", "directionalarea")) {
        before = "<shape type=\"rectangle\">";
        after = "</shape>";
    } else if (is(line, "texture", NULL)) {
        before = "<shape type=\"rectangle\"><bsdf type=\"diffuse\">";
        after = "</bsdf></shape>";
    } else if (is_any(line, steps)) {
        before = "<shape type=\"rectangle\"><transform name=\"toWorld\">";
        after = "</transform></shape>";
    } else if (is_any(line, colours) && strstr(line, "\"radiance\"")) {
        before = "<shape type=\"rectangle\"><emitter type=\"area\">";
        after = "</emitter></shape>";
    } else if (is_any(line, colours)) {
        before = "<shape type=\"rectangle\"><bsdf type=\"diffuse\">";
        after = "</bsdf></shape>";
    }
    /* A texture stands for the reflectance. */
    if (is(line, "texture", NULL))
        text_append(text, "%s<texture name=\"reflectance\"%s%s\n", before,
                    line + strlen("<texture"), after);
    else
        text_append(text, "%s%s%s\n", before, line, after);
}

/* The element with more in it. */
static void write_with(struct text *text, const char *line, const char *element,
                       const char *inner)
{
    char tag[32];
    snprintf(tag, sizeof tag, "</%s>", element);
    const char *end = strstr(line, tag);
    if (end)
        text_append(text, "%.*s%s%s", (int)(end - line), line, inner, end);
    else
        text_append(text, "%.*s>%s%s", (int)strlen(line) - 2, line, inner, tag);
}

static void write_sensor(struct text *text, const char *line)
{
    static const char *const film =
        "<film type=\"hdrfilm\"><rfilter type=\"box\"/></film>";
    if (is(line, "sensor", NULL)) {
        write_with(text, line, "sensor", film);
        return;
    }
    text_append(text, "<sensor type=\"perspective\">");
    if (is(line, "film", NULL))
        write_with(text, line, "film", "<rfilter type=\"box\"/>");
    else if (is(line, "rfilter", NULL))
        text_append(text, "<film type=\"hdrfilm\">%s</film>", line);
    else
        text_append(text, "%s%s", film, is(line, "sampler", NULL) ? line : "");
    text_append(text, "</sensor>\n");
}

/* A scene of that version around the line, with names that the lines may use. */
static void write_scene(struct text *text, const char *line, bool second)
{
    static const char *const parts[] = {"sensor", "film", "rfilter", "sampler", NULL};
    text->length = 0;
    text_append(text, "<scene version=\"%s\">\n", second ? "3.0.0" : "0.6.0");
    text_append(text, "<emitter type=\"point\"/><bsdf type=\"diffuse\" id=\"m\"/>\n"
                      "<shape type=\"shapegroup\" id=\"group\">"
                      "<shape type=\"cube\"/></shape>\n");
    write_sensor(text, line);
    if (!is_any(line, parts))
        write_around(text, line);
    text_append(text, "</scene>\n");
}

static void write_files(void)
{
    struct serialized file = {0}, body = {0};
    serialized_square(&body, 4, 0x1000, 0.0);
    size_t offset = serialized_add(&file, 4, &body);
    serialized_end(&file, 4, &offset, 1);
    import_test_write_bytes("mesh.serialized", file.data, file.size);
    import_test_write("half.spd", "400 .5\n700 .5\n");
    import_test_write("mesh.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    import_test_write("more.xml", "<scene version=\"3.0.0\"><shape type=\"sphere\"/>"
                                  "</scene>");
}

static void test_page(void **state)
{
    static const struct import_page page = {.path = "docs/formats-mitsuba.md",
                                            .scene = "scene.xml",
                                            .versions = {"0.6", "3"},
                                            .write = write_scene};
    (void)state;
    write_files();
    assert_true(import_page_check(&page) > 250);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_page)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

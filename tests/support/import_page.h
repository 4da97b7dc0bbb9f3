#ifndef ETALON_TESTS_SUPPORT_IMPORT_PAGE_H
#define ETALON_TESTS_SUPPORT_IMPORT_PAGE_H

/* Pages that say of every line of a format what becomes of it, in two versions:
 * "| `line` | word | word | ... |". Each line is loaded and held to its words. Wants
 * cmocka included before. */

#include "support/import_test.h"

struct import_page {
    const char *path;
    const char *scene; /* name of the file that a line is loaded from */
    const char *versions[2];
    /* A scene of the first or the second version around the line. */
    void (*write)(struct text *text, const char *line, bool second);
};

#define IMPORT_PAGE_CELLS 4

/* Cells of a row, cut in place; false if it is no such row. */
static inline bool import_page_cut(char *row, char *cell[IMPORT_PAGE_CELLS])
{
    if (strncmp(row, "| `", 3) != 0)
        return false;
    cell[0] = row + 3;
    for (int i = 1; i < IMPORT_PAGE_CELLS; i++) {
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

/* "silent", "warned" or the error. */
static inline const char *import_page_outcome(const char *name, const char *scene,
                                              char note[200], struct err *err)
{
    note[0] = '\0';
    struct scene_desc *desc = import_scene(import_test_write(name, scene), NULL, err);
    if (!desc)
        return err->message;
    bool warned = desc->log.count > 0;
    if (warned)
        snprintf(note, 200, "%s", desc->log.notes[0].text);
    scene_desc_destroy(desc);
    return warned ? "warned" : "silent";
}

static inline bool import_page_is(const char *word, const char *got)
{
    bool silent = text_equal(got, "silent"), warned = text_equal(got, "warned");
    if (text_equal(word, "read") || text_equal(word, "nothing"))
        return silent;
    if (text_equal(word, "nearest") || text_equal(word, "left out"))
        return warned;
    return text_equal(word, "error") && !silent && !warned;
}

static inline bool import_page_agrees(const struct import_page *page, const char *word,
                                      const char *line, bool second, struct text *text)
{
    struct err err = {0};
    char note[200];
    if (text_equal(word, "-"))
        return true;
    page->write(text, line, second);
    const char *got = import_page_outcome(page->scene, text->data, note, &err);
    if (import_page_is(word, got))
        return true;
    print_message("%s: %s: the page says \"%s\", it was: %s %s\n", page->versions[second],
                  line, word, got, note);
    return false;
}

/* Files that lines may name. */
static inline void import_page_files(void)
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
}

/* Asserts that each line is what the page says; returns their number. */
static inline int import_page_check(const struct import_page *page)
{
    size_t size;
    struct err err = {0};
    struct text scene = {0};
    char *text = text_read_file(page->path, &size, NULL, &err), *cell[IMPORT_PAGE_CELLS];
    assert_non_null(text);
    import_page_files();
    int rows = 0, wrong = 0;
    for (char *row = text, *next; row; row = next) {
        next = strchr(row, '\n');
        if (next)
            *next++ = '\0';
        if (!import_page_cut(row, cell))
            continue;
        rows++;
        for (int i = 0; i < 2; i++)
            wrong += !import_page_agrees(page, cell[1 + i], cell[0], i == 1, &scene);
    }
    mem_free(text);
    mem_free(scene.data);
    print_message("%d lines\n", rows);
    assert_int_equal(wrong, 0);
    return rows;
}

#endif

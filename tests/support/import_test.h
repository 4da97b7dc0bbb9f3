#ifndef ETALON_TESTS_IMPORT_TEST_H
#define ETALON_TESTS_IMPORT_TEST_H

/* Scene files that a test writes, reads and expects something of. Wants cmocka included
 * before. */

#include "base/mem.h"
#include "base/text.h"
#include "import/import.h"
#include "import/spectrum.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A path in the test's own folder; good until eight more are asked for. */
static inline const char *import_test_path(const char *name)
{
    static char made[64], ring[8][512];
    static int next;
    const char *directory = getenv("TEST_TMP");
    if (!directory && !made[0]) {
        snprintf(made, sizeof made, "%s/etalon-XXXXXX", P_tmpdir);
        assert_non_null(mkdtemp(made));
    }
    char *path = ring[next++ % 8];
    snprintf(path, sizeof ring[0], "%s/%s", directory ? directory : made, name);
    return path;
}

static inline const char *import_test_write_bytes(const char *name, const void *data,
                                                  size_t size)
{
    const char *path = import_test_path(name);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(data, 1, size, f), size);
    assert_int_equal(fclose(f), 0);
    return path;
}

static inline const char *import_test_write(const char *name, const char *text)
{
    return import_test_write_bytes(name, text, strlen(text));
}

static inline void import_test_error_is(const struct err *err, const char *expected)
{
    char line[1200];
    err_format(err, line, (int)sizeof line);
    if (!strstr(line, expected))
        print_message("'%s' lacks '%s'\n", line, expected);
    assert_non_null(strstr(line, expected));
}

/* The colour of a file of pairs, as pbrt v3 takes it. */
static inline bool import_test_spectrum(const char *path, const struct place *at,
                                        struct rgb *out, struct err *err)
{
    size_t count;
    double *pairs = spectrum_read_file(path, at, &count, err);
    bool read = pairs && spectrum_from_pairs(pairs, count, out);
    mem_free(pairs);
    return read;
}

/* Reads the text as a file of that name; it must be good. */
static inline struct scene_desc *import_test_good(const char *name, const char *text)
{
    struct err err = {0};
    struct scene_desc *desc = import_scene(import_test_write(name, text), NULL, &err);
    if (!desc)
        print_message("%d:%d: %s\n", err.line, err.col, err.message);
    assert_non_null(desc);
    return desc;
}

/* It must fail with a line that contains `expected`: "scene.pbrt:3:7: unknown ...". */
static inline void import_test_bad(const char *name, const char *text,
                                   const char *expected)
{
    struct err err = {0};
    assert_null(import_scene(import_test_write(name, text), NULL, &err));
    import_test_error_is(&err, expected);
}

/* Whether the log holds a note with that text, how often, and at which line. */
static inline void import_test_note(const struct scene_desc *desc, const char *text,
                                    long count, int line)
{
    for (size_t i = 0; i < desc->log.count; i++) {
        const struct log_note *n = &desc->log.notes[i];
        if (strstr(n->text, text)) {
            assert_int_equal(n->count, count);
            assert_int_equal(n->line, line);
            return;
        }
    }
    print_message("no note '%s'\n", text);
    fail();
}

static inline void import_test_near(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        print_message("%.17g is not %.17g\n", a, b);
    assert_true(fabs(a - b) <= tolerance);
}

/* A parameter of a material by its name. */
static inline const double *import_test_param(const struct scene_desc *desc, int material,
                                              const char *name)
{
    const struct bsdf *bsdf = &desc->materials[material];
    const struct bsdf_param *param = bsdf_param_find(bsdf->type, name);
    assert_non_null(param);
    return bsdf->param + param->offset;
}

#endif

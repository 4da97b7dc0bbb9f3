/* scene/memory: what is kept of a large mesh and what its loading takes; when the
 * hierarchy is compact; films that do not fit. ETALON_LONG: ten million triangles. */
#include "base/machine.h"
#include "base/mem.h"
#include "base/text.h"
#include "import/import.h"
#include "run/run.h"
#include "scene/hit_fill.h"
#include "scene/memory.h"
#include "scene/triangle.h"
#include "support/test_file.h"

#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

/* A bumpy grid of 2 side^2 triangles; returns the bytes of its positions and indices. */
static double write_grid(const char *path, int32_t side)
{
    FILE *out = fopen(path, "wb");
    assert_non_null(out);
    int32_t vertices = (side + 1) * (side + 1), faces = 2 * side * side;
    fprintf(out,
            "ply\nformat binary_little_endian 1.0\nelement vertex %d\n"
            "property float x\nproperty float y\nproperty float z\nelement face %d\n"
            "property list uchar int vertex_indices\nend_header\n",
            (int)vertices, (int)faces);
    for (int32_t i = 0; i < vertices; i++) {
        int32_t x = i % (side + 1), y = i / (side + 1);
        float p[3] = {(float)x, (float)y, (float)(x * 7 % 5 + y * 3 % 4)};
        fwrite(p, sizeof p, 1, out);
    }
    for (int32_t i = 0; i < faces; i++) {
        int32_t a = i / 2 % side + i / 2 / side * (side + 1), up = a + side + 1;
        int32_t corners[2][3] = {{a, a + 1, up + 1}, {a, up + 1, up}};
        fputc(3, out);
        fwrite(corners[i % 2], sizeof corners[0], 1, out);
    }
    assert_int_equal(fclose(out), 0);
    return 12.0 * vertices + 12.0 * faces;
}

static struct scene *load_grid(int32_t side, enum accel_compact compact, double *data)
{
    char *mesh = test_file("grid.ply"), *path = test_file("grid.pbrt");
    char *text = text_format("LookAt 0 0 5 0 0 0 0 1 0\nCamera \"perspective\"\n"
                             "WorldBegin\nLightSource \"point\"\n"
                             "Shape \"plymesh\" \"string filename\" \"%s\"\n"
                             "WorldEnd\n",
                             mesh);
    struct err err = {0};
    *data = write_grid(mesh, side);
    assert_true(text_write_file(path, text, strlen(text), &err));
    mem_free(text);
    struct import_options importing = {.threads = 2};
    struct scene_options options = {.compact = compact, .threads = 2};
    struct scene_desc *desc = import_scene(path, &importing, &err);
    assert_non_null(desc);
    struct scene *scene = scene_build(desc, &options, &err);
    assert_non_null(scene);
    remove(mesh);
    remove(path);
    mem_free(mesh);
    mem_free(path);
    return scene;
}

/* Both kinds see the same surface; the description tells them apart. */
static void test_compact(void **state)
{
    (void)state;
    double data;
    struct scene *full = load_grid(40, ACCEL_AUTO, &data);
    struct scene *compact = load_grid(40, ACCEL_COMPACT, &data);
    assert_false(accel_is_compact(full->accel));
    assert_true(accel_is_compact(compact->accel));
    assert_non_null(strstr(accel_description(compact->accel), ", compact"));
    assert_null(strstr(accel_description(full->accel), "compact"));
    for (int i = 0; i < 3; i++) {
        struct ray_endpoint from = {.p = vec3(3.3f + (float)i, 5.7f, 50.0f)};
        struct hit a, b;
        assert_true(accel_intersect(full, &from, vec3(0.0f, 0.0f, -1.0f), &a));
        assert_true(accel_intersect(compact, &from, vec3(0.0f, 0.0f, -1.0f), &b));
        assert_float_equal(a.at.p.z, b.at.p.z, 1e-4);
    }
    scene_destroy(full);
    scene_destroy(compact);
    assert_true(accel_wants_compact(1e7, 68e7 / ACCEL_MEMORY_SHARE - 1.0));
    assert_false(accel_wants_compact(1e7, 68e7 / ACCEL_MEMORY_SHARE + 1.0));
}

/* What a hit reads of a triangle has the same bits with a record as without. */
static void test_records(void **state)
{
    (void)state;
    double data;
    struct scene *scene = load_grid(20, ACCEL_AUTO, &data);
    struct err err = {0};
    struct shape built;
    const struct triangles *full = &scene->shapes[0].triangles, *lean = &built.triangles;
    assert_true(shape_build(&built, &scene->desc->shapes[0], scene->desc->materials,
                            &scene->desc->log, &err));
    assert_non_null(full->records);
    assert_null(full->edge_offset);
    assert_null(lean->records);
    for (uint32_t i = 0; i < full->count; i++) {
        float made[4], kept[4];
        struct triangle a = triangle_load(lean, i), b = triangle_load(full, i);
        assert_memory_equal(triangle_face(lean, i, made), triangle_face(full, i, kept),
                            sizeof made);
        assert_memory_equal(&a.p0, &b.p0, sizeof a.p0);
        assert_memory_equal(&a.e1, &b.e1, sizeof a.e1);
        assert_memory_equal(&a.e2, &b.e2, sizeof a.e2);
    }
    shape_deinit(&built);
    scene_destroy(scene);
}

/* The same with shading normals and uv: hits as they are, and as they are from the mesh.
 */
static void test_full_records(void **state)
{
    (void)state;
    enum { TRIANGLES = 2 };
    /* Padded as those of meshes are: 16 bytes are read at the last corner. */
    float p[13] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, .5f},
          uv[] = {.1f, .2f, .8f, .3f, .2f, .9f, .7f, .6f};
    float n[] = {.1f, 0, 1, 0, .2f, 1, -.1f, 0, 1, .3f, .3f, 1}, made[4], face[4];
    uint32_t index[] = {0, 1, 2, 2, 1, 3, 0, 0, 0, 0};
    float records[TRIANGLES * TRIANGLE_RECORD_FULL];
    struct triangles lean = {
        .index = index, .p = p, .n = n, .uv = uv, .count = TRIANGLES};
    struct log log;
    log_init(&log);
    triangle_build_offsets(&lean, NULL, &log);
    struct triangles full = lean;
    full.edge_offset = mem_alloc(TRIANGLES, sizeof *full.edge_offset);
    memcpy(full.edge_offset, lean.edge_offset, TRIANGLES * sizeof *full.edge_offset);
    assert_int_equal(triangle_record_floats(&full), sizeof records / sizeof *records);
    triangle_use_records(&full, records);
    for (uint32_t i = 0; i < TRIANGLES; i++) {
        struct shape of = {.triangles = lean}, kept = {.triangles = full};
        struct bsdf bsdf = {.flags = BSDF_ANISOTROPIC};
        struct hit a = {.bsdf = &bsdf}, b = a;
        of.bsdf = kept.bsdf = &bsdf;
        of.aligned = kept.aligned = true;
        hit_fill_triangle(&of, i, .3f, .4f, true, &a);
        hit_fill_triangle(&kept, i, .3f, .4f, true, &b);
        assert_memory_equal(&a, &b, sizeof a);
        assert_memory_equal(triangle_face(&lean, i, made), triangle_face(&full, i, face),
                            sizeof made);
    }
    mem_free(lean.edge_offset);
    log_deinit(&log);
}

/* Bytes that the heap grows by where a mesh becomes a shape without records. */
static double heap_growth(const struct scene *scene)
{
    struct err err = {0};
    struct shape shape;
    struct mallinfo2 before = mallinfo2();
    assert_true(shape_build(&shape, &scene->desc->shapes[0], scene->desc->materials,
                            &scene->desc->log, &err));
    struct mallinfo2 after = mallinfo2();
    shape_deinit(&shape);
    return (double)(after.uordblks + after.hblkhd) -
           (double)(before.uordblks + before.hblkhd);
}

/* Own arrays within 1.5 times the data beyond the limit, and with records of 64 bytes a
 * triangle in place of offsets below it; by what memory_of_scene says and by what the
 * heap grows by. */
static void test_own_arrays(void **state)
{
    (void)state;
    static const int32_t sides[] = {50, 353, 706, 708, 1400};
    int count = getenv("ETALON_LONG") ? 5 : 2;
    for (int i = 0; i < count; i++) {
        double data, triangles = 2.0 * sides[i] * sides[i];
        struct scene *scene = load_grid(sides[i], ACCEL_AUTO, &data);
        double own = (double)memory_of_scene(scene).geometry;
        bool large = triangles > SHAPE_RECORDS_MOST;
        double records = large ? 0.0 : (64.0 - 4.0) * triangles;
        print_message("%.0f triangles: own %.0f of data %.0f, %.2f\n", triangles, own,
                      data, own / data);
        assert_true(own - records <= 1.5 * data);
        assert_true(large == (scene->shapes[0].triangles.records == NULL));
        assert_true(data + heap_growth(scene) <= own - records + 8192.0);
        scene_destroy(scene);
    }
}

static void test_films_that_do_not_fit(void **state)
{
    (void)state;
    struct settings settings;
    struct err err = {0};
    settings_init(&settings);
    struct run_memory fits = {.films = 0x1p29, .states = 0x1p28, .pictures = 0x1p28};
    struct run_memory large = {.films = 0x1p31, .states = 0x1p30, .pictures = 0x1p30};
    assert_true(run_check_memory(&fits, 0x1p30, &settings, &err));
    assert_false(run_check_memory(&large, 0x1p30, &settings, &err));
    assert_non_null(strstr(err.message, "4096 MB (films 2048, states 1024, pictures 1024"
                                        "), and 1024 MB of memory"));
    assert_null(strstr(err.message, "paper"));
    assert_null(strstr(err.message, "fewer chains"));
    settings.integrator = "pfmlt";
    settings.mode = "paper";
    large.states = 0x1p33;
    err = (struct err){0};
    assert_false(run_check_memory(&large, 0x1p30, &settings, &err));
    assert_non_null(strstr(err.message, "fewer chains"));
    assert_non_null(strstr(err.message, "paper"));
}

static void test_machine(void **state)
{
    (void)state;
    char *touched = mem_aligned(64, 1 << 26, 1);
    assert_true(machine_memory_available() > 0.0);
    assert_true(machine_memory_peak() >= 0x1p26);
    mem_free(touched);
}

/* First of all: the peak is the process's. */
static void test_ten_million(void **state)
{
    (void)state;
    double data;
    if (!getenv("ETALON_LONG") || machine_memory_available() < 0x1p32)
        skip();
    double before = machine_memory_peak();
    struct scene *scene = load_grid(2237, ACCEL_AUTO, &data);
    struct memory memory = memory_of_scene(scene);
    print_message("data %.0f, own %zu, peak before the BVH %.0f, BVH %zu bytes\n", data,
                  memory.geometry, scene->load_peak, memory.bvh);
    assert_true((double)memory.geometry <= 1.5 * data);
    assert_true(scene->load_peak - before <= 1.5 * data);
    assert_true(memory.bvh > 0);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ten_million), cmocka_unit_test(test_compact),
        cmocka_unit_test(test_records),     cmocka_unit_test(test_full_records),
        cmocka_unit_test(test_own_arrays),  cmocka_unit_test(test_films_that_do_not_fit),
        cmocka_unit_test(test_machine),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* EXR: our own files round-trip to the bit; files of the C++ library (tests/data/exr, of
 * every compression and layout) read as their pixel formula; broken files are errors. */
#include "base/mem.h"
#include "base/text.h"
#include "image/exr.h"
#include "math/rng.h"
#include "support/test_file.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define DATA "tests/data/exr/"

static char *directory;

static int make_directory(void **state)
{
    (void)state;
    directory = test_file("exr");
    return mkdir(directory, 0700);
}

static int remove_directory(void **state)
{
    (void)state;
    int status = rmdir(directory); /* fails if a test left a file behind */
    mem_free(directory);
    return status;
}

/* Random bits: denormals, infinities and NaNs included. */
static struct image *random_image(int width, int height, uint64_t index)
{
    struct image *image = image_create(width, height);
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, index);
    for (int i = 0; i < 3 * width * height; i++) {
        uint32_t bits = (uint32_t)rng_u64(&rng);
        memcpy(&image->pixels[i], &bits, sizeof bits);
    }
    return image;
}

static void round_trip_keeps_every_bit(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {1, 40}, {333, 1}, {64, 16}, {61, 47}};
    char *path = text_join(directory, "round.exr");
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        int width = sizes[i][0], height = sizes[i][1];
        struct image *image = random_image(width, height, i);
        struct err err = {0};
        assert_true(exr_write(path, image, NULL, 0, NULL, &err));
        struct image *back = exr_read(path, NULL, &err);
        assert_non_null(back);
        assert_true(back->width == width && back->height == height);
        size_t size = 3 * (size_t)width * (size_t)height * sizeof(float);
        assert_memory_equal(back->pixels, image->pixels, size);
        image_destroy(back);
        image_destroy(image);
    }
    unlink(path);
    mem_free(path);
}

/* Noise over an ever wider range of magnitudes, which compresses ever less, from less
 * than its own size to more. */
static void noise_of_any_range_comes_back(void **state)
{
    (void)state;
    enum { WIDTH = 64, HEIGHT = 16, VALUES = 3 * WIDTH * HEIGHT };
    char *path = text_join(directory, "noise.exr");
    struct rng rng;
    rng_init(&rng, 2, RNG_TEST, 0);
    for (int i = 0; i < 100; i++) {
        struct image *image = image_create(WIDTH, HEIGHT);
        struct err err = {0};
        for (int j = 0; j < VALUES; j++)
            image->pixels[j] = (float)exp2((2.0 + 0.012 * i) * (rng_double(&rng) - 0.5));
        assert_true(exr_write(path, image, NULL, 0, NULL, &err));
        struct image *back = exr_read(path, NULL, &err);
        assert_non_null(back);
        assert_memory_equal(back->pixels, image->pixels, VALUES * sizeof(float));
        image_destroy(back);
        image_destroy(image);
    }
    unlink(path);
    mem_free(path);
}

/* A file without R, G, B, made by renaming them: what its first layer holds is read. */
static void a_layer_stands_for_the_picture(void **state)
{
    static const float values[3][2] = {{1.0f, 2.0f}, {3.0f, 4.0f}, {5.0f, 6.0f}};
    static const char *const names[3] = {"diffuse.R", "diffuse.G", "diffuse.B"};
    (void)state;
    char path[512];
    size_t size;
    struct err err = {0};
    struct layers layers = {.count = 0};
    for (int c = 0; c < 3; c++)
        layers_refer(&layers, names[c], values[c]);
    struct image *image = image_create(2, 1);
    snprintf(path, sizeof path, "%s/layer.exr", directory);
    assert_true(exr_write(path, image, NULL, 0, &layers, &err));
    layers_deinit(&layers);
    char *file = text_read_file(path, &size, NULL, &err);
    char *at = memmem(file, size, "chlist", 7);
    assert_non_null(at);
    at += 7 + 4; /* the type's name, the size */
    for (int c = 0; c < 3; c++, at += 2 + 16) {
        assert_int_equal(at[0], "BGR"[c]);
        at[0] = "CHS"[c];
    }
    assert_true(text_write_file(path, file, size, &err));
    struct image *back = exr_read(path, NULL, &err);
    assert_non_null(back);
    for (int x = 0; x < 2; x++)
        for (int c = 0; c < 3; c++)
            assert_true(image_at(back, x, 0)[c] == values[c][x]);
    image_destroy(back);
    image_destroy(image);
    mem_free(file);
    unlink(path);
}

/* The windows of the file are at the place of the picture on its film. */
static void a_part_keeps_its_place(void **state)
{
    static const unsigned char windows[2][16] = {
        {7, 0, 0, 0, 5, 0, 0, 0, 9, 0, 0, 0, 6, 0, 0, 0}, /* data: 7, 5 to 9, 6 */
        {0, 0, 0, 0, 0, 0, 0, 0, 19, 0, 0, 0, 9, 0, 0, 0} /* display: 20 x 10 */};
    static const char *const names[2] = {"dataWindow", "displayWindow"};
    (void)state;
    struct err err = {0};
    struct image *image = image_create(3, 2);
    image->x = 7;
    image->y = 5;
    image->whole_width = 20;
    image->whole_height = 10;
    for (int i = 0; i < 18; i++)
        image->pixels[i] = (float)i;
    char path[512];
    snprintf(path, sizeof path, "%s/part.exr", directory);
    assert_true(exr_write(path, image, NULL, 0, NULL, &err));
    struct image *back = exr_read(path, NULL, &err), *like = image_create_like(image);
    assert_non_null(back);
    assert_memory_equal(back->pixels, image->pixels, 18 * sizeof(float));
    for (int i = 0; i < 2; i++) {
        const struct image *one = i ? like : back;
        assert_int_equal(one->x, 7);
        assert_int_equal(one->y, 5);
        assert_int_equal(one->whole_width, 20);
        assert_int_equal(one->whole_height, 10);
    }
    size_t size;
    char *file = text_read_file(path, &size, NULL, &err);
    for (int i = 0; i < 2; i++) {
        char *at = memmem(file, size, names[i], strlen(names[i]) + 1);
        assert_non_null(at);
        at += strlen(names[i]) + 1 + sizeof "box2i" + 4; /* name, type, size */
        assert_memory_equal(at, windows[i], 16);
    }
    mem_free(file);
    unlink(path);
    image_destroy(image);
    image_destroy(back);
    image_destroy(like);
}

static void attributes_come_back(void **state)
{
    (void)state;
    static const struct exr_attribute attributes[] = {
        {"scene", "scenes/door/scene.yaml"},
        {"p_l_reason", "r = 0.31 >= 0.1: eta_s / (2 (eta_s - eta_l))\nand \"so\" on"},
        {"empty", ""},
        {"a_name_that_is_longer_than_old_readers_can_take", "long"},
    };
    char *path = text_join(directory, "attributes.exr");
    struct image *image = random_image(5, 4, 9);
    struct err err = {0};
    assert_true(exr_write(path, image, attributes, 4, NULL, &err));
    for (int i = 0; i < 4; i++) {
        char *value = exr_read_attribute(path, attributes[i].name);
        assert_non_null(value);
        assert_string_equal(value, attributes[i].value);
        mem_free(value);
    }
    assert_null(exr_read_attribute(path, "missing"));
    assert_null(exr_read_attribute(path, "compression")); /* no string */
    assert_null(exr_read_attribute("no/such/file.exr", "scene"));
    unlink(path);
    image_destroy(image);
    mem_free(path);
}

static void layers_do_not_disturb_the_picture(void **state)
{
    (void)state;
    enum { W = 37, H = 29 };
    char *path = text_join(directory, "layers.exr");
    struct image *image = random_image(W, H, 10);
    struct image *extra = random_image(W, H, 11);
    struct layers layers = {.count = 0};
    layers_refer(&layers, "failure.Y", extra->pixels);
    layers_refer(&layers, "AA", extra->pixels + W * H);
    layers_refer(&layers, "Z", extra->pixels + 2 * W * H);
    layers_refer(&layers, "none", NULL);
    assert_int_equal(layers.count, 3);
    struct err err = {0};
    assert_true(exr_write(path, image, NULL, 0, &layers, &err));
    struct image *back = exr_read(path, NULL, &err);
    assert_non_null(back);
    assert_memory_equal(back->pixels, image->pixels, 3 * W * H * sizeof(float));
    size_t size = 0;
    char *bytes = text_read_file(path, &size, NULL, &err);
    assert_non_null(bytes);
    assert_non_null(memmem(bytes, size, "failure.Y", 10));
    assert_true(size > 6 * W * H * sizeof(float)); /* noise cannot be packed */
    mem_free(bytes);
    layers_deinit(&layers);
    image_destroy(back);
    image_destroy(image);
    image_destroy(extra);
    unlink(path);
    mem_free(path);
}

/* exr_read takes Y for the picture where there is no R, G, B: so a layer Y comes back
 * once the names of the colours are overwritten in the file. */
static void layer_values_are_the_ones_given(void **state)
{
    (void)state;
    enum { W = 9, H = 21 };
    char *path = text_join(directory, "grey.exr");
    struct image *image = random_image(W, H, 12);
    struct layers layers = {0};
    layers_refer(&layers, "Y", image->pixels);
    struct err err = {0};
    assert_true(exr_write(path, image, NULL, 0, &layers, &err));
    size_t size = 0;
    char *bytes = text_read_file(path, &size, NULL, &err);
    assert_non_null(bytes);
    /* The list of channels starts with B, 16 bytes, G, 16 bytes, R. */
    char *list = memmem(bytes, size, "chlist", 7);
    assert_non_null(list);
    for (int c = 0; c < 3; c++) {
        char *name = list + 7 + 4 + 18 * c;
        assert_true(name[0] == "BGR"[c] && name[1] == 0);
        name[0] = "BCD"[c];
    }
    assert_true(text_write_file(path, bytes, size, &err));
    mem_free(bytes);
    struct image *back = exr_read(path, NULL, &err);
    assert_non_null(back);
    for (int i = 0; i < W * H; i++)
        for (int c = 0; c < 3; c++)
            assert_memory_equal(&back->pixels[3 * i + c], &image->pixels[i],
                                sizeof(float));
    image_destroy(back);
    image_destroy(image);
    unlink(path);
    layers_deinit(&layers);
    mem_free(path);
}

/* Layers by name: three channels, one as grey; a name that only begins alike is another,
 * and one that is not there is none. */
static void layers_are_read_by_name(void **state)
{
    (void)state;
    enum { W = 9, H = 21 };
    char *path = text_join(directory, "layers.exr");
    struct image *image = random_image(W, H, 16);
    struct layers layers = {0};
    const char *const names[] = {"normal.X",   "normal.Y",   "normal.Z", "length_1.R",
                                 "length_1.G", "length_1.B", "work.Y",   "depth.Z"};
    for (int k = 0; k < 8; k++) {
        float *values = layers_add(&layers, names[k], W * H);
        for (int i = 0; i < W * H; i++)
            values[i] = (float)(100 * k + i);
    }
    assert_true(exr_write(path, image, NULL, 0, &layers, NULL));
    struct exr_file *file = exr_open(path);
    assert_non_null(file);
    static const struct {
        const char *name;
        float first[3];
    } cases[] = {{"normal", {0, 100, 200}},
                 {"length_1", {300, 400, 500}},
                 {"work", {600, 600, 600}},
                 {"depth", {700, 700, 700}}};
    for (int k = 0; k < 4; k++) {
        struct image *layer = exr_layer(file, cases[k].name);
        assert_non_null(layer);
        for (int i = 0; i < W * H; i++)
            for (int c = 0; c < 3; c++)
                assert_true(layer->pixels[3 * i + c] == cases[k].first[c] + (float)i);
        image_destroy(layer);
    }
    assert_null(exr_layer(file, "length"));
    assert_null(exr_layer(file, "length_10"));
    exr_close(file);
    layers_deinit(&layers);
    image_destroy(image);
    unlink(path);
    mem_free(path);
}

/* The channel A of alpha, first in the file's list of names: it does not disturb R, G, B,
 * and its values are found once the four names are overwritten by others of which Y is
 * the only known one. */
static void alpha_stands_beside_the_colours(void **state)
{
    (void)state;
    enum { W = 11, H = 19 };
    char *path = text_join(directory, "alpha.exr");
    struct image *image = random_image(W, H, 14), *alpha = random_image(W, H, 15);
    struct layers layers = {0};
    layers_refer(&layers, "A", alpha->pixels);
    struct err err = {0};
    assert_true(exr_write(path, image, NULL, 0, &layers, &err));
    struct image *back = exr_read(path, NULL, &err);
    assert_non_null(back);
    assert_memory_equal(back->pixels, image->pixels, 3 * W * H * sizeof(float));
    image_destroy(back);
    size_t size = 0;
    char *bytes = text_read_file(path, &size, NULL, &err);
    assert_non_null(bytes);
    char *list = memmem(bytes, size, "chlist", 7);
    assert_non_null(list);
    for (int c = 0; c < 4; c++) {
        char *name = list + 7 + 4 + 18 * c;
        assert_true(name[0] == "ABGR"[c] && name[1] == 0);
        name[0] = "YZ[]"[c];
    }
    assert_true(text_write_file(path, bytes, size, &err));
    mem_free(bytes);
    back = exr_read(path, NULL, &err);
    assert_non_null(back);
    for (int i = 0; i < W * H; i++)
        assert_memory_equal(&back->pixels[3 * i], &alpha->pixels[i], sizeof(float));
    image_destroy(back);
    image_destroy(image);
    image_destroy(alpha);
    unlink(path);
    layers_deinit(&layers);
    mem_free(path);
}

static void names_in_use_are_refused(void **state)
{
    (void)state;
    char *path = text_join(directory, "names.exr");
    struct image *image = random_image(2, 2, 13);
    static const char *const names[][2] = {{"R", "Q"}, {"Q", "Q"}, {"", "Q"}};
    for (int i = 0; i < 3; i++) {
        struct err err = {0};
        struct layers layers = {.count = 0};
        for (int j = 0; j < 2; j++)
            layers_refer(&layers, names[i][j], image->pixels);
        assert_false(exr_write(path, image, NULL, 0, &layers, &err));
        assert_int_equal(err.code, ERR_VALUE);
        layers_deinit(&layers);
    }
    const struct exr_attribute bad = {"channels", "no string"};
    struct err err = {0};
    assert_false(exr_write(path, image, &bad, 1, NULL, &err));
    assert_int_equal(err.code, ERR_IO);
    assert_true(access(path, F_OK) != 0);
    image_destroy(image);
    mem_free(path);
}

static void failure_leaves_nothing_behind(void **state)
{
    (void)state;
    struct image *image = random_image(3, 3, 14);
    char *path = text_join(directory, "no/such/directory.exr");
    struct err err = {0};
    assert_false(exr_write(path, image, NULL, 0, NULL, &err));
    assert_int_equal(err.code, ERR_IO);
    assert_non_null(strstr(err.message, "No such file"));
    mem_free(path);
    /* A directory in the way: the temporary file is written, and goes again. */
    path = text_join(directory, "taken.exr");
    assert_int_equal(mkdir(path, 0777), 0);
    err = (struct err){0};
    assert_false(exr_write(path, image, NULL, 0, NULL, &err));
    assert_int_equal(err.code, ERR_IO);
    assert_int_equal(rmdir(path), 0);
    mem_free(path);
    image_destroy(image);
}

/* The formula of tests/data/exr/README.md. */
static float fixture_value(int c, int x, int y)
{
    x = (x % 64 + 64) % 64;
    y = (y % 64 + 64) % 64;
    if (c == 0)
        return (float)(x * y % 32) / 8.0f;
    return c == 1 ? (float)(x - y) * 0.25f : ldexpf(1.0f, (x + 2 * y) % 20 - 10);
}

static void foreign_files_read_as_their_formula(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        int x0, y0, width, height;
    } files[] = {
        {"none_float", 0, 0, 45, 37},       {"rle_half", 0, 0, 45, 37},
        {"zips_float", 0, 0, 45, 37},       {"zip_half", 0, 0, 45, 37},
        {"piz_half", 0, 0, 45, 37},         {"piz_float", 0, 0, 45, 37},
        {"pxr24_float", 0, 0, 45, 37},      {"tiled_zip_half", 0, 0, 45, 37},
        {"tiled_none_float", 0, 0, 45, 37}, {"tiled_mipmap_float", 0, 0, 45, 37},
        {"decreasing_half", 0, 0, 45, 37},  {"extra_half", 0, 0, 45, 37},
        {"grey_half", 0, 0, 45, 37},        {"crop_float", 5, 3, 27, 26},
        {"overscan_half", 0, 0, 45, 37},
    };
    for (size_t f = 0; f < sizeof files / sizeof files[0]; f++) {
        char *path = text_format(DATA "%s.exr", files[f].name);
        struct err err = {0};
        struct image *image = exr_read(path, NULL, &err);
        if (!image)
            print_error("%s\n", err.message);
        assert_non_null(image);
        assert_int_equal(image->width, files[f].width);
        assert_int_equal(image->height, files[f].height);
        bool grey = strncmp(files[f].name, "grey", 4) == 0;
        for (int y = 0; y < image->height; y++)
            for (int x = 0; x < image->width; x++)
                for (int c = 0; c < 3; c++) {
                    float expected = fixture_value(grey ? 0 : c, x + files[f].x0,
                                                   y + files[f].y0);
                    assert_true(image_at(image, x, y)[c] == expected);
                }
        char *comment = exr_read_attribute(path, "comment");
        assert_non_null(comment);
        assert_string_equal(comment, "made by the C++ library");
        mem_free(comment);
        image_destroy(image);
        mem_free(path);
    }
}

static void lossy_files_read_as_the_other_library_reads_them(void **state)
{
    (void)state;
    static const char *const names[] = {"b44", "b44a"};
    for (int f = 0; f < 2; f++) {
        char *path = text_format(DATA "%s_half.exr", names[f]);
        char *decoded = text_format(DATA "%s_half_decoded.exr", names[f]);
        struct err err = {0};
        struct image *a = exr_read(path, NULL, &err);
        struct image *b = exr_read(decoded, NULL, &err);
        assert_non_null(a);
        assert_non_null(b);
        assert_memory_equal(a->pixels, b->pixels, 45 * 37 * 3 * sizeof(float));
        image_destroy(a);
        image_destroy(b);
        mem_free(path);
        mem_free(decoded);
    }
}

static void what_cannot_be_read_says_so(void **state)
{
    (void)state;
    static const struct {
        const char *path, *message;
        enum err_code code;
    } files[] = {
        {DATA "uint.exr", "half or float", ERR_UNSUPPORTED},
        {DATA "subsampled.exr", "subsampled", ERR_UNSUPPORTED},
        {DATA "parts.exr", "more than one part", ERR_UNSUPPORTED},
        {DATA "deep.exr", "deep data", ERR_UNSUPPORTED},
        {DATA "dwaa_half.exr", "compression", ERR_UNSUPPORTED},
        {DATA "outside_half.exr", "display window", ERR_VALUE},
        {DATA "none.exr", "No such file", ERR_IO},
        {DATA, "directory", ERR_IO},
        {DATA "README.md", DATA "README.md", ERR_SYNTAX},
        {"/dev/null", "not a regular file", ERR_IO},
    };
    const struct place at = {"scene.yaml", 12, 3};
    for (size_t f = 0; f < sizeof files / sizeof files[0]; f++) {
        struct err err = {0};
        assert_null(exr_read(files[f].path, &at, &err));
        if (!strstr(err.message, files[f].message) || err.code != files[f].code)
            print_error("%s: %d %s\n", files[f].path, (int)err.code, err.message);
        assert_non_null(strstr(err.message, files[f].message));
        assert_int_equal(err.code, files[f].code);
        assert_string_equal(err.file, "scene.yaml");
        assert_true(err.line == 12 && err.col == 3);
    }
}

/* Reads bytes as a file; either outcome is legal, a crash is not. */
static bool survives(const char *path, const char *bytes, size_t size)
{
    struct err err = {0};
    unlink(path); /* some file systems flush to disk when a file is replaced */
    assert_true(text_write_file(path, bytes, size, &err));
    struct image *image = exr_read(path, NULL, &err);
    assert_true(image || (err.code != ERR_NONE && err.message[0]));
    bool read = image;
    image_destroy(image);
    return read;
}

static void each_fixture(void (*check)(const char *path, const char *bytes, size_t size))
{
    char *path = text_join(directory, "broken.exr");
    DIR *data = opendir(DATA);
    assert_non_null(data);
    for (struct dirent *entry = readdir(data); entry; entry = readdir(data)) {
        if (!text_ends_with(entry->d_name, ".exr"))
            continue;
        char *fixture = text_join(DATA, entry->d_name);
        struct err err = {0};
        size_t size = 0;
        char *bytes = text_read_file(fixture, &size, NULL, &err);
        assert_non_null(bytes);
        check(path, bytes, size);
        mem_free(bytes);
        mem_free(fixture);
    }
    closedir(data);
    unlink(path);
    mem_free(path);
}

/* No part of a file is dispensable, but the tail of mip levels that are never read. */
static void check_truncations(const char *path, const char *bytes, size_t size)
{
    bool whole = survives(path, bytes, size);
    size_t readable = 0;
    for (size_t length = 0; length < size; length += 1 + length / 60)
        readable += survives(path, bytes, length);
    assert_true(readable == 0 || (whole && memmem(bytes, size, "tiles", 5)));
}

static void truncated_files_are_errors(void **state)
{
    (void)state;
    each_fixture(check_truncations);
}

static void check_flips(const char *path, const char *bytes, size_t size)
{
    bool slow = getenv("ETALON_LONG");
    struct rng rng;
    rng_init(&rng, 2, RNG_TEST, size);
    char *broken = mem_alloc(size, 1);
    for (int run = 0; run < (slow ? 20000 : 150); run++) {
        memcpy(broken, bytes, size);
        int flips = 1 + (int)(rng_u64(&rng) % 8);
        size_t range = run % 2 ? size : size < 400 ? size : 400; /* headers more often */
        for (int i = 0; i < flips; i++)
            broken[rng_u64(&rng) % range] = (char)rng_u64(&rng);
        survives(path, broken, size);
    }
    mem_free(broken);
}

static void flipped_bytes_never_crash(void **state)
{
    (void)state;
    each_fixture(check_flips);
}

static void real_references_read(void **state)
{
    (void)state;
    static const struct {
        const char *path;
        int width, height;
    } files[] = {
        {"../shared/scenes/coffee-pbrt3/TungstenRender.exr", 0, 0},
        {"../shared/scenes/coffee-pbrt3/reference-240x300-12edges.exr", 240, 300},
        {"../shared/scenes/living-room-pbrt3/TungstenRender.exr", 0, 0},
        {"../shared/scenes/living-room-pbrt3/reference-320x180-12edges.exr", 320, 180},
        {"../shared/scenes/peer-box/diffuse-reference.exr", 256, 256},
        {"../shared/scenes/peer-box/glass-reference.exr", 256, 256},
        {"../shared/scenes/veach-ajar-mitsuba/TungstenRender.exr", 0, 0},
        {"../shared/scenes/veach-bidir-mitsuba/TungstenRender.exr", 0, 0},
        {"../shared/scenes/veach-mis-mitsuba/TungstenRender.exr", 0, 0},
    };
    int found = 0;
    for (size_t f = 0; f < sizeof files / sizeof files[0]; f++) {
        if (access(files[f].path, R_OK) != 0)
            continue;
        found++;
        struct err err = {0};
        struct image *image = exr_read(files[f].path, NULL, &err);
        if (!image)
            print_error("%s\n", err.message);
        assert_non_null(image);
        if (files[f].width)
            assert_true(image->width == files[f].width &&
                        image->height == files[f].height);
        double sum = 0.0;
        for (int i = 0; i < 3 * image->width * image->height; i++)
            sum += (double)image->pixels[i];
        double mean = sum / (3.0 * image->width * image->height);
        print_message("%s: %dx%d, mean %.4f\n", files[f].path, image->width,
                      image->height, mean);
        assert_true(mean > 0.01 && mean < 10.0);
        image_destroy(image);
    }
    if (!found) {
        print_message("no scenes in ../shared/scenes: skipped\n");
        skip();
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(round_trip_keeps_every_bit),
        cmocka_unit_test(noise_of_any_range_comes_back),
        cmocka_unit_test(a_layer_stands_for_the_picture),
        cmocka_unit_test(a_part_keeps_its_place),
        cmocka_unit_test(attributes_come_back),
        cmocka_unit_test(layers_do_not_disturb_the_picture),
        cmocka_unit_test(layer_values_are_the_ones_given),
        cmocka_unit_test(layers_are_read_by_name),
        cmocka_unit_test(alpha_stands_beside_the_colours),
        cmocka_unit_test(names_in_use_are_refused),
        cmocka_unit_test(failure_leaves_nothing_behind),
        cmocka_unit_test(foreign_files_read_as_their_formula),
        cmocka_unit_test(lossy_files_read_as_the_other_library_reads_them),
        cmocka_unit_test(what_cannot_be_read_says_so),
        cmocka_unit_test(truncated_files_are_errors),
        cmocka_unit_test(flipped_bytes_never_crash),
        cmocka_unit_test(real_references_read),
    };
    return cmocka_run_group_tests(tests, make_directory, remove_directory);
}

/* Random damage to small valid files of every kind: the readers must refuse or accept,
 * never crash, hang or allocate what a header only claims. A fixed seed; ETALON_FUZZ sets
 * the number of executions. Meant for VARIANT=san. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/import_test.h"
#include "support/serialized_make.h"

#include <sys/resource.h>

#define SEED_MAX 4000

struct seed {
    const char *name; /* of the file: its ending names the reader */
    char data[SEED_MAX];
    size_t size;
};

static const char ascii_ply[] =
    "ply\nformat ascii 1.0\ncomment c\nelement vertex 4\nproperty float x\n"
    "property double y\nproperty float z\nproperty float nx\nproperty float ny\n"
    "property float nz\nproperty float u\nproperty float v\nelement face 2\n"
    "property list uchar int vertex_indices\nproperty int id\nend_header\n"
    "0 0 0 0 0 1 0 0\n1 0 0 0 0 1 1 0\n1 1 0 0 0 1 1 1\n0 1 0 0 0 1 0 1\n"
    "4 0 1 2 3 7\n3 0 1 2 8\n";

static const char pbrt_text[] =
    "LookAt 0 0 5 0 0 0 0 1 0\nCamera \"perspective\" \"float fov\" [30]\n"
    "Film \"image\" \"integer xresolution\" 20 \"float cropwindow\" [0 1 0 1]\n"
    "Integrator \"path\" \"integer maxdepth\" 5\nPixelFilter \"box\"\nWorldBegin\n"
    "MakeNamedMaterial \"a\" \"string type\" \"metal\" \"spectrum k\" [400 1 700 2]\n"
    "Texture \"t\" \"spectrum\" \"constant\" \"rgb value\" [.1 .2 .3]\n"
    "AttributeBegin AreaLightSource \"diffuse\" \"blackbody L\" [3000 2]\n"
    "Rotate 30 0 1 0 Scale 1 -1 2 ReverseOrientation Shape \"sphere\" AttributeEnd\n"
    "Material \"matte\" \"texture Kd\" \"t\" # comment\n"
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [0 0 0 1 0 0 0 1 0]"
    " \"normal N\" [0 0 1 0 0 1 0 0 1] \"float uv\" [0 0 1 0 1 1]\n"
    "TransformBegin NamedMaterial \"a\" Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1]\n"
    "Shape \"disk\" TransformEnd Shape \"plymesh\" \"string filename\" \"ok.ply\"\n"
    "Texture \"c\" \"spectrum\" \"checkerboard\" \"texture tex1\" \"t\" \"float uscale\" "
    "4\n"
    "Texture \"i\" \"float\" \"imagemap\" \"string filename\" \"no.png\" \"string wrap\" "
    "\"clamp\"\nMakeNamedMaterial \"u\" \"string type\" \"uber\" \"texture opacity\" "
    "\"c\" "
    "\"texture bumpmap\" \"i\"\nMaterial \"mix\" \"string namedmaterial1\" \"a\" "
    "\"string namedmaterial2\" \"u\" ObjectBegin \"o\" Shape \"loopsubdiv\" "
    "\"integer nlevels\" 1 \"integer indices\" [0 1 2 2 1 3] \"point P\" "
    "[0 0 0 1 0 0 0 1 0 1 1 1] ObjectEnd ObjectInstance \"o\"\n"
    "LightSource \"distant\" \"point from\" [0 1 2] LightSource \"infinite\" \"rgb L\" "
    "[1 1 1] LightSource \"spot\" \"float coneangle\" 30\n"
    "Include \"inner.pbrt\"\nLightSource \"point\" \"rgb I\" [1 1 1]\nWorldEnd\n";

static const char yaml_text[] =
    "camera: {position: [0, 0, 5], target: [0, 0, 0], fov: 30, fov_axis: y}\n"
    "film: {width: 8, height: 4, crop: [0, 1, 0, 1]}\nmax_depth: 5\n"
    "settings: {integrator: mmlt}\nmaterials:\n  a: {type: diffuse, reflectance: .5}\n"
    "  b: &b {type: roughconductor, alpha: 0.2, distribution: ggx, k: [1, 2, 3]}\n"
    "shapes:\n  - type: sphere\n    material: a\n    transform: [{scale: 2}, {rotate: "
    "{axis: [0, 0, 1], degrees: 30}}]\n    emission: [1, 2, 3]\n    two_sided: true\n"
    "  - {type: lathe, material: b, segments: 9, crease: 20, profile: [[0, 0], [1, 0], "
    "[1, 2], [0, 2]]}\n  - {type: mesh, material: a, file: ok.ply, reverse: true}\n"
    "  - {type: box, material: a}\n"
    "lights: [{type: point, position: [1, 2, 3], intensity: 5}]\n";

static const char obj_text[] =
    "# c\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0 .5 .5 .5\nv 0 1 \\\n0\nvn 0 0 1\n"
    "vt 0 0\nvt 1\nvt 1 1\ng a\nusemtl m\ns 1\nf 1/1/1 2/2/1 3/3/1 4/1/1\n"
    "f -4//-1 -3//-1 -2//-1\nf 1 2 3 4\nf 1/1 2/2 3/3\n";

static const char xml_text[] =
    "<?xml version=\"1.0\"?>\n<scene version=\"0.6.0\">\n<default name=\"d\" "
    "value=\"6\"/>"
    "<integrator type=\"bdpt\"><integer name=\"maxDepth\" value=\"$d\"/></integrator>\n"
    "<sensor type=\"thinlens\"><float name=\"fov\" value=\"19.5\"/><float "
    "name=\"apertureRadius\" value=\"1\"/><float name=\"focusDistance\" value=\"2\"/>"
    "<transform name=\"toWorld\"><lookat origin=\"0,1,6\" target=\"0,1,0\" up=\"0,1,0\"/>"
    "<rotate y=\"1\" angle=\"9\"/><scale value=\"2\"/></transform><film type=\"hdrfilm\">"
    "<integer name=\"width\" value=\"16\"/><integer name=\"cropWidth\" value=\"8\"/>"
    "</film></sensor>\n<bsdf type=\"twosided\" id=\"a\"><bsdf type=\"roughconductor\">"
    "<string name=\"material\" value=\"Al\"/><float name=\"alpha\" value=\".2\"/>"
    "<texture type=\"checkerboard\" name=\"specularReflectance\"/></bsdf></bsdf>\n"
    "<shape type=\"obj\"><string name=\"filename\" value=\"ok.obj\"/><ref id=\"a\"/>"
    "</shape><include filename=\"inner.xml\"/>\n<shape type=\"cylinder\"><point "
    "name=\"p0\" x=\"1\"/><bsdf type=\"dielectric\"><string name=\"intIOR\" "
    "value=\"water\"/></bsdf></shape><shape type=\"rectangle\"><emitter "
    "type=\"area\"><spectrum "
    "name=\"radiance\" value=\"400:1, 500:2\"/></emitter></shape><emitter type=\"point\">"
    "<rgb name=\"intensity\" value=\"#ff0080\"/></emitter>\n</scene>\n";

static void take(struct seed *seed, const char *name, const void *data, size_t size)
{
    assert_true(size <= SEED_MAX);
    seed->name = name;
    memcpy(seed->data, data, size);
    seed->size = size;
}

/* A triangle, twice, in either byte order. */
static void make_binary(struct seed *seed, bool big)
{
    static const char head[] =
        " 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 2\nproperty list uchar ushort vertex_indices\nend_header\n";
    char data[SEED_MAX];
    int n = snprintf(data, sizeof data, "ply\nformat binary_%s_endian%s",
                     big ? "big" : "little", head);
    char *at = data + n;
    for (int i = 0; i < 9; i++) {
        uint32_t bits = i == 3 || i == 7 ? 0x3f800000 : 0;
        for (int k = 0; k < 4; k++)
            *at++ = (char)(bits >> 8 * (big ? 3 - k : k));
    }
    for (int face = 0; face < 2; face++) {
        *at++ = 3;
        for (int i = 0; i < 3; i++) {
            *at++ = (char)(big ? 0 : i);
            *at++ = (char)(big ? i : 0);
        }
    }
    take(seed, big ? "big.ply" : "little.ply", data, (size_t)(at - data));
}

/* Before it is compressed: see pack. */
static void make_serialized(struct seed *seed)
{
    struct serialized body = {.size = 0};
    serialized_square(&body, 4, 0x101b, 0.0);
    take(seed, "body.serialized", body.data, body.size);
}

/* Damage to compressed data is seldom more than that, so it is done before. */
static const char *write_seed(const char *name, const char *data, size_t size)
{
    struct serialized file = {.size = 0}, body = {.size = size};
    if (!text_ends_with(name, "body.serialized"))
        return import_test_write_bytes(name, data, size);
    memcpy(body.data, data, size);
    size_t offset = serialized_add(&file, 4, &body);
    serialized_end(&file, 4, &offset, 1);
    return import_test_write_bytes(name, file.data, file.size);
}

/* And the file as it is. */
static void make_file(struct seed *seed)
{
    struct serialized body = {.size = 0}, file = {.size = 0};
    serialized_square(&body, 3, 0x2002, 0.0);
    size_t offset = serialized_add(&file, 3, &body);
    serialized_end(&file, 3, &offset, 1);
    take(seed, "file.serialized", file.data, file.size);
}

/* The upper half of a 64-bit linear congruential generator. */
static uint32_t draw(uint64_t *random, uint32_t below)
{
    *random = *random * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)((*random >> 32) * below >> 32);
}

/* One small damage of the kinds that files suffer and attackers try; at most 16 bytes
 * longer. */
static size_t damage(uint64_t *random, char *data, size_t size)
{
    static const char *const words[] = {
        "-1",  "4294967295", "1e38",       "1e999",       "nan",
        "\"",  "[",          "]",          "99999999999", "{",
        "*b",  "- ",         "\n",         "0",           "list ",
        "#",   ": ",         "2147483648", "World",       "AttributeBegin ",
        "<a>", "/>",         "$d",         "//",          "<ref id=\"a\"/>"};
    size_t at = size ? draw(random, (uint32_t)size) : 0;
    size_t length = 1 + draw(random, 12);
    length = length < size - at ? length : size - at;
    const char *word = words[draw(random, sizeof words / sizeof words[0])];
    size_t word_length = strlen(word);
    switch (draw(random, 6)) {
    case 0: /* a bit */
        if (size)
            data[at] = (char)(data[at] ^ (1 << draw(random, 8)));
        return size;
    case 1: /* a byte */
        if (size)
            data[at] = (char)draw(random, 256);
        return size;
    case 2: /* an early end */
        return draw(random, 4) ? size : at;
    case 3: /* a piece lost */
        memmove(data + at, data + at + length, size - at - length);
        return size - length;
    case 4: /* a piece twice */
        memmove(data + at + length, data + at, size - at);
        return size + length;
    default: /* a word put in */
        memmove(data + at + word_length, data + at, size - at);
        memcpy(data + at, word, word_length);
        return size + word_length;
    }
}

/* NULL with no error: that ending is none of a mesh. */
static struct mesh *read_mesh(const char *name, const char *path, struct err *err)
{
    struct import_serialized_flags flags;
    if (text_ends_with(name, ".ply"))
        return import_ply(path, NULL, err);
    if (text_ends_with(name, ".obj"))
        return import_obj(path, NULL, err);
    if (text_ends_with(name, ".serialized"))
        return import_serialized(path, 0, &flags, NULL, err);
    return NULL;
}

/* Files read ahead change nothing, not even of what is wrong. */
static bool read_scene(const char *path, struct err *err)
{
    struct err second = {0};
    struct import_options options = {.threads = 2};
    struct scene_desc *desc = import_scene(path, NULL, err);
    struct scene_desc *ahead = import_scene(path, &options, &second);
    bool read = desc != NULL;
    assert_int_equal(read, ahead != NULL);
    assert_string_equal(err->message, second.message);
    assert_int_equal(err->line, second.line);
    assert_int_equal(err->col, second.col);
    if (read)
        assert_int_equal(desc->log.count, ahead->log.count);
    scene_desc_destroy(desc);
    scene_desc_destroy(ahead);
    return read;
}

static bool read_file(const char *name, const char *path)
{
    struct err err = {0};
    struct mesh *mesh = read_mesh(name, path, &err);
    bool read = mesh != NULL;
    mesh_destroy(mesh);
    if (!read && err.code == ERR_NONE)
        read = read_scene(path, &err);
    assert_true(read == (err.code == ERR_NONE));
    assert_true(read == (err.message[0] == '\0'));
    return read;
}

#define SEEDS   9
#define DAMAGES 4

static void make_seeds(struct seed seeds[SEEDS])
{
    import_test_write("ok.ply", ascii_ply);
    import_test_write("inner.pbrt", "Shape \"cylinder\"\n");
    take(&seeds[0], "ascii.ply", ascii_ply, sizeof ascii_ply - 1);
    make_binary(&seeds[1], false);
    make_binary(&seeds[2], true);
    take(&seeds[3], "fuzz.pbrt", pbrt_text, sizeof pbrt_text - 1);
    take(&seeds[4], "fuzz.yaml", yaml_text, sizeof yaml_text - 1);
    import_test_write("ok.obj", obj_text);
    import_test_write("inner.xml", "<shape type=\"disk\"/>");
    take(&seeds[5], "fuzz.obj", obj_text, sizeof obj_text - 1);
    take(&seeds[6], "fuzz.xml", xml_text, sizeof xml_text - 1);
    make_serialized(&seeds[7]);
    make_file(&seeds[8]);
    for (int i = 0; i < SEEDS; i++)
        assert_true(read_file(seeds[i].name,
                              write_seed(seeds[i].name, seeds[i].data, seeds[i].size)));
}

static void test_damage(void **state)
{
    struct seed seeds[SEEDS];
    char data[SEED_MAX + 16 * DAMAGES];
    uint64_t random = 20240607;
    long accepted[SEEDS] = {0};
    const char *wish = getenv("ETALON_FUZZ");
    long runs = wish ? atol(wish) : getenv("ETALON_LONG") ? 100000 : 9000;
    (void)state;
    make_seeds(seeds);
    for (long run = 0; run < runs; run++) {
        const struct seed *seed = &seeds[run % SEEDS];
        size_t size = seed->size;
        memcpy(data, seed->data, size);
        for (uint32_t n = 1 + draw(&random, DAMAGES); n > 0; n--)
            size = damage(&random, data, size);
        accepted[run % SEEDS] += read_file(seed->name,
                                           write_seed(seed->name, data, size));
    }
    for (int i = 0; i < SEEDS; i++) {
        print_message("%s: %ld runs, %ld accepted\n", seeds[i].name, runs / SEEDS,
                      accepted[i]);
        assert_true(accepted[i] > 0 && accepted[i] < runs / SEEDS);
    }
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    print_message("peak memory %ld kB\n", usage.ru_maxrss);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_damage)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* import/pbrt/import_pbrt: every directive by what it leaves in the description. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "base/mem.h"
#include "scene/light.h"
#include "support/import_test.h"

#define SPHERE "Shape \"sphere\"\n"

/* The world that a scene with this body has. */
static struct scene_desc *world(const char *body)
{
    struct text text = {0};
    text_append(&text, "Camera \"perspective\" WorldBegin\n%s\nWorldEnd\n", body);
    struct scene_desc *desc = import_test_good("scene.pbrt", text.data);
    mem_free(text.data);
    return desc;
}

/* Where the (only) sphere of the body puts the point (1,2,3). */
static void goes_to(const char *body, double x, double y, double z)
{
    struct text text = {0};
    text_append(&text, "%s\n" SPHERE, body);
    struct scene_desc *desc = world(text.data);
    struct vec3 p = xform_point(&desc->shapes[0].to_world, vec3(1.0f, 2.0f, 3.0f));
    import_test_near((double)p.x, x, 1e-5);
    import_test_near((double)p.y, y, 1e-5);
    import_test_near((double)p.z, z, 1e-5);
    scene_desc_destroy(desc);
    mem_free(text.data);
}

static void test_transforms(void **state)
{
    (void)state;
    goes_to("", 1, 2, 3);
    goes_to("Translate 10 20 30", 11, 22, 33);
    goes_to("Scale 2 3 -4", 2, 6, -12);
    goes_to("Rotate 90 0 0 1", -2, 1, 3);
    goes_to("Rotate 90 2 0 0", 1, -3, 2);
    /* The one written last happens first. */
    goes_to("Translate 10 0 0 Scale 2 2 2", 12, 4, 6);
    goes_to("Scale 2 2 2 Translate 10 0 0", 22, 4, 6);
    goes_to("Scale 2 2 2 Identity Translate 0 0 1", 1, 2, 4);
    /* Columns one after the other: x' = x + 7, y' = 2 y. */
    goes_to("Scale 9 9 9 Transform [1 0 0 0  0 2 0 0  0 0 1 0  7 0 0 1]", 8, 4, 3);
    goes_to("Scale 2 2 2 ConcatTransform [1 0 0 0 0 2 0 0 0 0 1 0 7 0 0 1]", 16, 8, 6);
    /* World to camera: a camera at z = 5 that looks along -z sees x to its left. */
    goes_to("LookAt 0 0 5  0 0 0  0 1 0", -1, 2, 2);
}

static void test_stack(void **state)
{
    (void)state;
    goes_to("AttributeBegin Translate 5 5 5 AttributeEnd", 1, 2, 3);
    goes_to("TransformBegin Translate 5 5 5 TransformEnd", 1, 2, 3);
    goes_to("Translate 1 0 0 AttributeBegin Scale 2 2 2 TransformBegin Scale 3 3 3 "
            "TransformEnd AttributeEnd Translate 0 1 0",
            2, 3, 3);
    goes_to("Translate 1 0 0 CoordinateSystem \"here\" Scale 9 9 9 "
            "CoordSysTransform \"here\"",
            2, 2, 3);
    goes_to("Scale 9 9 9 CoordSysTransform \"world\"", 1, 2, 3);
}

/* AttributeEnd brings back material, light and orientation; TransformEnd does not. */
static void test_state_scope(void **state)
{
    (void)state;
    struct scene_desc *desc = world(
        "Material \"mirror\"\n"
        "AttributeBegin Material \"matte\" AreaLightSource \"diffuse\" "
        "ReverseOrientation " SPHERE "AttributeEnd " SPHERE
        "TransformBegin Material \"glass\" ReverseOrientation TransformEnd " SPHERE);
    assert_int_equal(desc->shape_count, 3);
    const struct shape_desc *s = desc->shapes;
    assert_string_equal(desc->materials[s[0].material].type->name, "diffuse");
    assert_true(s[0].emits && s[0].reverse_orientation);
    assert_string_equal(desc->materials[s[1].material].type->name, "mirror");
    assert_true(!s[1].emits && !s[1].reverse_orientation);
    assert_string_equal(desc->materials[s[2].material].type->name, "dielectric");
    assert_true(s[2].reverse_orientation);
    scene_desc_destroy(desc);
}

static void test_camera(void **state)
{
    (void)state;
    struct scene_desc *desc = import_test_good(
        "scene.pbrt",
        "Scale -1 1 1 LookAt 1 2 6  1 2 0  0 1 0\n"
        "Camera \"perspective\" \"float fov\" 30 \"float lensradius\" [.25]"
        " \"float focaldistance\" 6 \"float screenwindow\" [-1 1 -.5 .75]\n"
        "Film \"image\" \"integer xresolution\" 20 \"integer yresolution\" [10]"
        " \"float cropwindow\" [0 .5 .25 1] \"string filename\" \"a.exr\"\n"
        "Integrator \"bdpt\" \"integer maxdepth\" 7 \"float rrthreshold\" 0\n"
        "Sampler \"halton\" \"integer pixelsamples\" 3\n"
        "Accelerator \"bvh\" \"string splitmethod\" \"sah\"\n"
        "PixelFilter \"box\"\nWorldBegin WorldEnd");
    const struct camera_desc *c = &desc->camera;
    struct vec3 eye = xform_point(&c->to_world, vec3(0, 0, 0));
    struct vec3 right = xform_vector(&c->to_world, vec3(1, 0, 0));
    struct vec3 forward = xform_vector(&c->to_world, vec3(0, 0, 1));
    import_test_near((double)eye.x, 1.0, 1e-5);
    import_test_near((double)eye.y, 2.0, 1e-5);
    import_test_near((double)eye.z, 6.0, 1e-5);
    import_test_near((double)right.x, 1.0, 1e-5);
    import_test_near((double)forward.z, -1.0, 1e-5);
    assert_true(c->fov == 30.0 && c->fov_axis == FOV_SMALLER && c->lens_radius == 0.25);
    assert_true(c->focus_distance == 6.0 && c->has_window);
    assert_true(c->window[0] == -1.0 && c->window[3] == 0.75);
    assert_true(c->crop[1] == 0.5 && c->crop[2] == 0.25 && c->crop[3] == 1.0);
    assert_true(desc->width == 20 && desc->height == 10 && desc->max_depth == 8);
    assert_int_equal(desc->log.count, 0);
    scene_desc_destroy(desc);
}

/* A scaled camera space: lens and focus are lengths in it. */
static void test_scaled_camera(void **state)
{
    (void)state;
    struct scene_desc *desc = import_test_good(
        "scene.pbrt", "Scale 2 2 -2 LookAt 0 0 0 0 0 -1 0 1 0\n"
                      "Camera \"perspective\" \"float lensradius\" .6 "
                      "\"float focaldistance\" 6 WorldBegin WorldEnd");
    import_test_near(desc->camera.lens_radius, 0.3, 1e-12);
    import_test_near(desc->camera.focus_distance, 3.0, 1e-12);
    scene_desc_destroy(desc);
}

static void is_setting(const struct scene_desc *desc, size_t i, const char *key,
                       const char *value)
{
    assert_true(i < desc->setting_count);
    assert_string_equal(desc->settings[i].key, key);
    assert_string_equal(desc->settings[i].value, value);
}

/* What pbrt's mlt is told is the default of the same setting; of other integrators it is
 * nobody's. */
static void test_mlt(void **state)
{
    (void)state;
    struct scene_desc *desc = import_test_good(
        "scene.pbrt",
        "Integrator \"mlt\" \"integer maxdepth\" 7 \"float largestepprobability\" .25 "
        "\"integer mutationsperpixel\" 50 \"integer chains\" 100 \"float sigma\" .5 "
        "\"integer bootstrapsamples\" 1000 WorldBegin WorldEnd");
    assert_int_equal(desc->setting_count, 6);
    is_setting(desc, 0, "large_step_probability", "0.25");
    is_setting(desc, 1, "kernel", "gaussian");
    is_setting(desc, 2, "sigma", "0.5");
    is_setting(desc, 3, "mutations_per_pixel", "50");
    is_setting(desc, 4, "chains", "100");
    is_setting(desc, 5, "bootstrap", "8000"); /* for each of 8 depths */
    assert_int_equal(desc->max_depth, 8);
    assert_int_equal(desc->log.count, 1); /* no camera */
    scene_desc_destroy(desc);
    desc = import_test_good(
        "scene.pbrt", "Integrator \"mlt\" \"float largestepprobability\" 0\n"
                      "Integrator \"path\" \"integer chains\" 5 WorldBegin WorldEnd");
    assert_int_equal(desc->setting_count, 0);
    import_test_note(desc, "\"largestepprobability\" of Integrator \"mlt\" is not used",
                     1, 1);
    import_test_note(desc, "unused parameter \"integer chains\" of Integrator", 1, 2);
    scene_desc_destroy(desc);
}

static void reflects(const struct scene_desc *desc, size_t shape, double expected)
{
    const double *v = import_test_param(desc, desc->shapes[shape].material,
                                        "reflectance");
    import_test_near(v[1], expected, 1e-12);
}

/* A shape's own parameters count before its material's, for that shape alone. */
static void test_material_of_shape(void **state)
{
    (void)state;
    struct scene_desc *desc = world(
        "Texture \"t\" \"spectrum\" \"constant\" \"rgb value\" [.7 .7 .7]\n"
        "MakeNamedMaterial \"m\" \"string type\" \"mirror\" \"rgb Kr\" [.1 .1 .1]\n"
        "Shape \"sphere\" \"rgb Kd\" [.2 .3 .4] \"float radius\" 2\n"
        "Material \"matte\" \"rgb Kd\" [.6 .6 .6] " SPHERE
        "Shape \"sphere\" \"texture Kd\" \"t\"\n"
        "NamedMaterial \"m\" Shape \"sphere\" \"rgb Kr\" [.9 .9 .9] \"float foo\" "
        "1\n" SPHERE "Material \"none\" Shape \"sphere\" \"rgb Kd\" [.2 .2 .2]\n");
    static const double expected[] = {0.3, 0.6, 0.7, 0.9, 0.1};
    assert_int_equal(desc->shape_count, 5);
    for (size_t i = 0; i < 5; i++)
        reflects(desc, i, expected[i]);
    import_test_note(desc, "unused parameter \"float foo\" of Shape", 1, 7);
    scene_desc_destroy(desc);
    desc = import_test_good("scene.pbrt", "Film \"rgb\" WorldBegin Shape \"sphere\" "
                                          "\"rgb reflectance\" [.2 .2 .2]");
    import_test_note(desc, "unused parameter \"rgb reflectance\" of Shape", 1, 1);
    scene_desc_destroy(desc);
}

static void test_camera_defaults(void **state)
{
    (void)state;
    struct scene_desc *desc = import_test_good(
        "scene.pbrt", "Translate 0 0 3\nCamera \"perspective\" \"float halffov\" 10 "
                      "\"float frameaspectratio\" 2\n"
                      "PixelFilter \"gaussian\" \"float xwidth\" 2\n"
                      "Integrator \"whitted\" \"float nonsense\" 1\nWorldBegin WorldEnd");
    const struct camera_desc *c = &desc->camera;
    assert_true(xform_point(&c->to_world, vec3(0, 0, 0)).z == -3.0f);
    assert_true(c->fov == 20.0 && c->lens_radius == 0.0);
    assert_true(c->window[0] == -2.0 && c->window[2] == -1.0 && c->window[3] == 1.0);
    assert_true(desc->width == 1280 && desc->height == 720 && desc->max_depth == 6);
    assert_int_equal(desc->log.count, 3);
    import_test_note(desc, "the filter \"gaussian\" is not used", 1, 3);
    import_test_note(desc, "integrator \"whitted\" leaves light out", 1, 4);
    import_test_note(desc, "unused parameter \"float nonsense\"", 1, 4);
    scene_desc_destroy(desc);
}

static const char *kind_of(const struct scene_desc *desc, int shape)
{
    return desc->materials[desc->shapes[shape].material].type->name;
}

static void test_materials(void **state)
{
    (void)state;
    struct scene_desc *desc = world(
        SPHERE "Material \"matte\" \"rgb Kd\" [.1 .2 .3] \"float sigma\" 20\n" SPHERE
               "Material \"matte\" \"rgb Kd\" [0 0 0]\n" SPHERE
               "Material \"mirror\" \"color Kr\" [.5 .6 -.7]\n" SPHERE
               "Material \"glass\" \"float index\" 1.3 \"rgb Kt\" [.9 .8 .7]\n" SPHERE
               "Material \"glass\" \"float eta\" 2 \"float index\" 9\n" SPHERE
               "Material \"none\"\n" SPHERE "Material \"\"\n" SPHERE SPHERE);
    assert_int_equal(desc->shape_count, 6);
    assert_string_equal(kind_of(desc, 0), "diffuse");
    assert_true(import_test_param(desc, desc->shapes[0].material, "reflectance")[1] ==
                0.5);
    assert_true(import_test_param(desc, desc->shapes[1].material, "reflectance")[2] ==
                0.3);
    assert_string_equal(kind_of(desc, 2), "black");
    const double *kr = import_test_param(desc, desc->shapes[3].material, "reflectance");
    assert_true(kr[0] == 0.5 && kr[2] == 0.0);
    int glass = desc->shapes[4].material;
    assert_string_equal(desc->materials[glass].type->name, "dielectric");
    assert_true(import_test_param(desc, glass, "eta")[0] == 1.3);
    assert_true(import_test_param(desc, glass, "transmittance")[2] == 0.7);
    assert_true(import_test_param(desc, desc->shapes[5].material, "eta")[0] == 2.0);
    assert_string_equal(kind_of(desc, 1), "orennayar");
    import_test_near(*import_test_param(desc, desc->shapes[1].material, "sigma"),
                     20.0 * 3.14159265358979 / 180.0, 1e-9);
    import_test_note(desc, "shapes without a material are left out", 3, 14);
    import_test_note(desc, "unused parameter \"float index\" of Material \"glass\"", 1,
                     11);
    scene_desc_destroy(desc);
}

/* v3's translucent adds a diffuse and a glossy pair of lobes: shares of a blend, each
 * brighter by the inverse of its share. */
static void test_translucent(void **state)
{
    (void)state;
    struct scene_desc *desc = world(
        "Material \"translucent\" \"rgb Kd\" [.4 .2 .1] \"rgb Ks\" [.2 .1 .1] \"rgb "
        "reflect\" [.5 .5 .5] \"rgb transmit\" [.25 .5 .5]\n" SPHERE
        "Material \"translucent\" \"rgb Ks\" [0 0 0] \"rgb Kd\" [1 1 1]\n" SPHERE
        "Material \"translucent\" \"rgb Kd\" [0 0 0]\n" SPHERE
        "Material \"translucent\" \"rgb Kd\" [0 0 0] \"rgb Ks\" [0 0 0]\n" SPHERE);
    const struct bsdf *blend = &desc->materials[desc->shapes[0].material];
    assert_string_equal(blend->type->name, "blend");
    double share = blend->param[0];
    const struct bsdf *diffuse = blend->child[0], *glossy = blend->child[1];
    assert_string_equal(diffuse->type->name, "translucent");
    assert_string_equal(glossy->type->name, "roughdielectric");
    const struct bsdf_param *r = bsdf_param_find(diffuse->type, "reflectance");
    const struct bsdf_param *t = bsdf_param_find(diffuse->type, "transmittance");
    const struct bsdf_param *g = bsdf_param_find(glossy->type, "transmittance");
    import_test_near((1.0 - share) * diffuse->param[r->offset], 0.2, 1e-12);
    import_test_near((1.0 - share) * diffuse->param[t->offset + 1], 0.1, 1e-12);
    import_test_near(share * glossy->param[g->offset], 0.05, 1e-12);
    assert_string_equal(kind_of(desc, 1), "translucent");
    assert_string_equal(kind_of(desc, 2), "roughdielectric");
    assert_string_equal(kind_of(desc, 3), "black");
    assert_int_equal(desc->log.count, 0);
    scene_desc_destroy(desc);
}

/* pbrt v3's RoughnessToAlpha(.1) = .3515..., of .01 (metal's default) .0864... */
static void test_rough_materials(void **state)
{
    (void)state;
    double x = log(0.1), y = log(0.01);
    double a1 = 1.62142 + 0.819955 * x + 0.1734 * x * x + 0.0171201 * x * x * x +
                0.000640711 * x * x * x * x;
    double a2 = 1.62142 + 0.819955 * y + 0.1734 * y * y + 0.0171201 * y * y * y +
                0.000640711 * y * y * y * y;
    struct scene_desc *desc = world(
        "Material \"substrate\"\n" SPHERE
        "Material \"substrate\" \"bool remaproughness\" \"false\" \"float uroughness\" "
        ".2 "
        "\"float vroughness\" 0 \"rgb Ks\" [.04 .05 .06]\n" SPHERE
        "Material \"metal\"\n" SPHERE
        "Material \"metal\" \"float roughness\" .1 \"rgb eta\" [1 2 3]\n" SPHERE
        "Material \"glass\" \"float vroughness\" .1\n" SPHERE);
    const struct shape_desc *s = desc->shapes;
    import_test_near(import_test_param(desc, s[0].material, "alpha_u")[0], a1, 1e-12);
    assert_true(import_test_param(desc, s[0].material, "ks")[0] == 0.5);
    assert_true(import_test_param(desc, s[1].material, "alpha_u")[0] == 0.2);
    assert_true(import_test_param(desc, s[1].material, "alpha_v")[0] == 1e-3);
    assert_true(import_test_param(desc, s[1].material, "ks")[2] == 0.06);
    assert_string_equal(kind_of(desc, 2), "roughconductor");
    import_test_near(import_test_param(desc, s[2].material, "alpha_v")[0], a2, 1e-12);
    import_test_near(import_test_param(desc, s[2].material, "k")[0], 3.912, 1e-3);
    import_test_near(import_test_param(desc, s[3].material, "alpha_u")[0], a1, 1e-12);
    assert_true(import_test_param(desc, s[3].material, "eta")[2] == 3.0);
    assert_string_equal(kind_of(desc, 4), "roughdielectric");
    import_test_near(import_test_param(desc, s[4].material, "alpha_v")[0], a1, 1e-12);
    scene_desc_destroy(desc);
}

/* Names are seen to the end of their block; the newest hides older ones. */
static void test_names(void **state)
{
    (void)state;
    struct scene_desc *desc = world(
        "Texture \"grey\" \"spectrum\" \"constant\" \"rgb value\" [.2 .2 .2]\n"
        "Texture \"ior\" \"float\" \"constant\" \"float value\" 1.7\n"
        "MakeNamedMaterial \"a\" \"string type\" \"matte\" \"texture Kd\" \"grey\"\n"
        "MakeNamedMaterial \"b\" \"string type\" [\"glass\"] \"texture eta\" \"ior\"\n"
        "AttributeBegin MakeNamedMaterial \"a\" \"string type\" \"mirror\"\n"
        "NamedMaterial \"a\"\n" SPHERE "AttributeEnd NamedMaterial \"a\"\n" SPHERE
        "NamedMaterial \"b\"\n" SPHERE);
    assert_string_equal(kind_of(desc, 0), "mirror");
    assert_string_equal(kind_of(desc, 1), "diffuse");
    assert_true(import_test_param(desc, desc->shapes[1].material, "reflectance")[0] ==
                0.2);
    assert_true(import_test_param(desc, desc->shapes[2].material, "eta")[0] == 1.7);
    assert_int_equal(desc->log.count, 0);
    scene_desc_destroy(desc);
}

static void test_lights(void **state)
{
    (void)state;
    struct scene_desc *desc = world(
        "AreaLightSource \"diffuse\" \"rgb L\" [1 2 3] \"rgb scale\" [2 2 2] "
        "\"bool twosided\" \"true\" \"integer samples\" 4\n" SPHERE
        "AreaLightSource \"area\" \"rgb L\" [0 0 0]\n" SPHERE
        "Scale 2 2 2 Translate 1 0 0\n"
        "LightSource \"point\" \"rgb I\" [4 5 6] \"point from\" [0 1 0]\n"
        "LightSource \"point\" \"rgb I\" [0 0 0]\n");
    assert_true(desc->shapes[0].emits && desc->shapes[0].two_sided);
    assert_true(desc->shapes[0].radiance.b == 6.0);
    assert_false(desc->shapes[1].emits);
    assert_int_equal(desc->light_count, 1);
    struct vec3 p = xform_point(&desc->lights[0].to_world, vec3(0, 0, 0));
    assert_true(p.x == 2.0f && p.y == 1.0f && p.z == 0.0f); /* from: in world axes */
    assert_true(desc->lights[0].intensity.g == 5.0);
    assert_int_equal(desc->lights[0].place.line, 7);
    import_test_note(desc, "a light of no intensity", 1, 8);
    scene_desc_destroy(desc);
}

#define TRIANGLE \
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [0 0 0 1 0 0 0 1 0]"
#define NORMALS " \"normal N\" [0 0 1 0 0 1 0 0 2]"

static void test_mesh(void **state)
{
    (void)state;
    struct scene_desc *desc = world("Translate 0 0 5\n" TRIANGLE NORMALS
                                    " \"float st\" [0 0 1 0 0 1]\n");
    const struct mesh *mesh = desc->shapes[0].mesh;
    assert_int_equal(mesh->triangle_count, 1);
    assert_true(mesh->p[2] == 5.0f && mesh->p[3] == 1.0f); /* in world space */
    assert_true(mesh->n[2] > 0.0f && mesh->uv[2] == 1.0f);
    assert_int_equal(desc->shapes[0].place.line, 3);
    assert_int_equal(desc->shapes[0].place.col, 1);
    scene_desc_destroy(desc);
}

/* Mirrored, a mesh without normals turns its winding's side, one with them does not; and
 * so do quadrics, as in pbrt v3. ReverseOrientation turns each once more. */
static void test_orientation(void **state)
{
    static const bool expected[2][2][3] = {{{false, false, false}, {true, false, true}},
                                           {{true, true, true}, {false, true, false}}};
    (void)state;
    for (int reverse = 0; reverse < 2; reverse++) {
        for (int mirror = 0; mirror < 2; mirror++) {
            struct text text = {0};
            text_append(&text, "%s %s\n" TRIANGLE "\n" TRIANGLE NORMALS "\n" SPHERE,
                        reverse ? "ReverseOrientation" : "",
                        mirror ? "Scale 1 -1 1" : "");
            struct scene_desc *desc = world(text.data);
            for (int i = 0; i < 3; i++)
                assert_int_equal(desc->shapes[i].reverse_orientation,
                                 expected[reverse][mirror][i]);
            scene_desc_destroy(desc);
            mem_free(text.data);
        }
    }
}

static void test_quadrics(void **state)
{
    (void)state;
    struct scene_desc *desc = world(
        "Shape \"sphere\" \"float radius\" 2 \"float zmin\" -2 \"float zmax\" 9\n"
        "Shape \"disk\" \"float height\" .5 \"float radius\" 3\n"
        "Shape \"cylinder\" \"float zmin\" -2 \"float radius\" 4\n");
    const struct shape_desc *s = desc->shapes;
    assert_true(s[0].kind == SHAPE_SPHERE && s[0].radius == 2.0);
    assert_true(s[1].kind == SHAPE_DISK && s[1].radius == 3.0 && s[1].height == 0.5);
    assert_true(s[2].kind == SHAPE_CYLINDER && s[2].z_min == -2.0 && s[2].z_max == 1.0);
    assert_int_equal(desc->log.count, 0);
    scene_desc_destroy(desc);
}

/* Names of files start at the main file's folder; Include goes on in the same state. */
static void test_include_and_plymesh(void **state)
{
    (void)state;
    import_test_write("m.ply",
                      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                      "property float y\nproperty float z\nelement face 1\n"
                      "property list uchar int vertex_indices\nend_header\n"
                      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    import_test_write("part.pbrt", "Shape \"plymesh\" \"string filename\" \"m.ply\"\n");
    struct scene_desc *desc = world("Scale 2 2 2 Include \"part.pbrt\"");
    assert_true(desc->shapes[0].mesh->p[3] == 2.0f);
    assert_true(text_ends_with(desc->shapes[0].place.file, "part.pbrt"));
    scene_desc_destroy(desc);
}

/* What textures make of a material, and where they do not vary. */
static void test_textures(void **state)
{
    (void)state;
    struct scene_desc *desc = world(
        "Texture \"dark\" \"spectrum\" \"constant\" \"rgb value\" [.2 .3 .4]\n"
        "Texture \"half\" \"spectrum\" \"scale\" \"texture tex1\" \"dark\" "
        "\"rgb tex2\" [.5 .5 .5]\n"
        "Texture \"checks\" \"spectrum\" \"checkerboard\" \"texture tex1\" \"half\" "
        "\"rgb tex2\" [1 1 1] \"float uscale\" 10\n"
        "Translate 5 0 1 Scale 2 2 2 "
        "Texture \"cloud\" \"float\" \"fbm\" \"integer octaves\" 3 Identity\n"
        "Texture \"gone\" \"spectrum\" \"imagemap\" \"string filename\" \"no.png\"\n"
        "Material \"matte\" \"texture Kd\" \"half\" " SPHERE
        "Material \"uber\" \"texture opacity\" \"checks\" " SPHERE
        "Material \"matte\" \"texture Kd\" \"gone\" " SPHERE
        "Material \"glass\" \"texture uroughness\" \"cloud\" \"texture bumpmap\" "
        "\"cloud\" " SPHERE);
    const struct shape_desc *s = desc->shapes;
    import_test_near(import_test_param(desc, s[0].material, "reflectance")[2], 0.2,
                     1e-12);
    const struct bsdf *uber = &desc->materials[s[1].material];
    assert_true(uber->flags & BSDF_TEXTURED);
    struct bsdf_nodes nodes = {0};
    const struct bsdf *odd = bsdf_at(uber, &(struct texture_point){.u = 0.15, .v = 0.5},
                                     &nodes);
    const struct bsdf *even = bsdf_at(uber, &(struct texture_point){.u = 0.05, .v = 0.5},
                                      &nodes);
    int opacity = bsdf_param_find(uber->type, "opacity")->offset;
    import_test_near(odd->param[opacity], 1.0, 1e-12);
    import_test_near(even->param[opacity], 0.1, 1e-12);
    import_test_near(import_test_param(desc, s[2].material, "reflectance")[0], 0.5, 0.0);
    import_test_note(desc, "there is no picture", 1, 6);
    const struct bsdf *glass = &desc->materials[s[3].material];
    assert_true(glass->flags & BSDF_TEXTURED);
    /* (.3, 1.7, -2.4) in the texture's space: tests/unit/test_surface_solid.c. */
    const struct texture_point at = {.p = {5.6, 3.4, -3.8}};
    import_test_near(texture_eval(glass->relief.texture, &at).g, -0.578836793010, 1e-11);
    assert_int_equal(desc->log.count, 1);
    scene_desc_destroy(desc);
}

static const struct light_desc *only_light(const struct scene_desc *desc)
{
    assert_int_equal(desc->light_count, 1);
    return &desc->lights[0];
}

static void test_lights_without_surface(void **state)
{
    (void)state;
    struct scene_desc *desc = world("LightSource \"distant\" \"point from\" [0 0 2] "
                                    "\"point to\" [0 -2 2] \"rgb L\" [1 2 3]");
    struct vec3 axis = xform_vector(&only_light(desc)->to_world, vec3(0, 0, 1));
    assert_ptr_equal(only_light(desc)->type, &light_distant);
    import_test_near((double)axis.y, -1.0, 1e-6);
    assert_true(only_light(desc)->intensity.b == 3.0);
    scene_desc_destroy(desc);
    desc = world("Translate 1 0 0 LightSource \"spot\" \"float coneangle\" 40");
    assert_ptr_equal(only_light(desc)->type, &light_spot);
    assert_true(only_light(desc)->outer == 40.0 && only_light(desc)->inner == 35.0);
    struct vec3 p = xform_point(&only_light(desc)->to_world, vec3(0, 0, 0));
    import_test_near((double)p.x, 1.0, 1e-6);
    scene_desc_destroy(desc);
    desc = world("LightSource \"infinite\" \"rgb L\" [1 1 1] \"rgb scale\" [2 2 2]");
    assert_ptr_equal(only_light(desc)->type, &light_environment);
    assert_null(only_light(desc)->map);
    assert_true(only_light(desc)->intensity.r == 2.0);
    scene_desc_destroy(desc);
}

static void test_objects(void **state)
{
    (void)state;
    struct scene_desc *desc = world(
        "ObjectBegin \"o\" Translate 0 0 1 " SPHERE
        "Shape \"trianglemesh\" \"point P\" [0 0 0 1 0 0 0 1 0] "
        "\"integer indices\" [0 1 2] ObjectEnd\n"
        "Translate 5 0 0 ObjectInstance \"o\" Scale -1 1 1 ObjectInstance \"o\"");
    assert_int_equal(desc->shape_count, 2);
    assert_int_equal(desc->object_count, 1);
    assert_int_equal(desc->instances.count, 2);
    assert_int_equal(desc->shapes[0].object, 1);
    assert_int_equal(desc->shapes[1].object, 1);
    struct vec3 p = xform_point(&desc->shapes[0].to_world, vec3(1, 0, 0));
    import_test_near((double)p.x, 1.0, 1e-6);
    import_test_near((double)p.z, 1.0, 1e-6);
    const struct instance_desc *instance = desc->instances.list;
    p = xform_point(&instance[0].to_world, vec3(1, 0, 0));
    import_test_near((double)p.x, 6.0, 1e-6);
    p = xform_point(&instance[1].to_world, vec3(1, 0, 0));
    import_test_near((double)p.x, 4.0, 1e-6);
    assert_int_equal(instance[1].object, 1);
    assert_int_equal(instance[1].parent, 0);
    assert_int_equal(instance[1].place.line, 4);
    scene_desc_destroy(desc);
}

static void test_more_materials(void **state)
{
    (void)state;
    struct scene_desc *desc = world(
        "MakeNamedMaterial \"a\" \"string type\" \"mirror\"\n"
        "MakeNamedMaterial \"b\" \"string type\" \"matte\"\n"
        "Material \"mix\" \"string namedmaterial1\" \"a\" "
        "\"string namedmaterial2\" \"b\" \"rgb amount\" [.3 .3 .3] " SPHERE
        "Material \"plastic\" " SPHERE "Material \"fourier\" " SPHERE
        "Material \"coateddiffuse\" \"float roughness\" 0 " SPHERE
        "Material \"disney\" \"rgb color\" [.1 .2 .3] " SPHERE
        "NamedMaterial \"unheard\" " SPHERE
        "Material \"matte\" Shape \"sphere\" \"float alpha\" .25\n");
    static const char *const kinds[] = {
        "blend", "uber", "roughplastic", "plastic", "principled", "principled", "blend"};
    assert_int_equal(desc->shape_count, 7);
    for (int i = 0; i < 7; i++)
        assert_string_equal(kind_of(desc, i), kinds[i]);
    const struct bsdf *mix = &desc->materials[desc->shapes[0].material];
    assert_string_equal(mix->child[1]->type->name, "mirror");
    assert_true(import_test_param(desc, desc->shapes[0].material, "weight")[0] == 0.3);
    import_test_note(desc, "\"disney\" is taken as Mitsuba's principled", 1, 8);
    import_test_note(desc, "unknown named material \"unheard\"", 1, 9);
    scene_desc_destroy(desc);
}

/* v4: both names in one list, and the amount is that of the second. */
static void test_mix_of_a_list(void **state)
{
    (void)state;
    struct scene_desc *desc = world(
        "MakeNamedMaterial \"a\" \"string type\" \"mirror\"\n"
        "MakeNamedMaterial \"b\" \"string type\" \"diffuse\"\n"
        "Material \"mix\" \"string materials\" [\"a\" \"b\"] \"float amount\" .2 " SPHERE
        "Material \"mix\" \"string materials\" [\"b\" \"a\"] " SPHERE);
    const struct bsdf *mix = &desc->materials[desc->shapes[0].material];
    assert_string_equal(mix->type->name, "blend");
    assert_string_equal(mix->child[0]->type->name, "mirror");
    assert_string_equal(mix->child[1]->type->name, "diffuse");
    assert_true(import_test_param(desc, desc->shapes[0].material, "weight")[0] == 0.2);
    mix = &desc->materials[desc->shapes[1].material];
    assert_string_equal(mix->child[1]->type->name, "mirror");
    assert_true(import_test_param(desc, desc->shapes[1].material, "weight")[0] == 0.5);
    scene_desc_destroy(desc);
}

static void test_film_scale(void **state)
{
    (void)state;
    struct scene_desc *desc = import_test_good(
        "scene.pbrt", "Film \"image\" \"float scale\" 3 WorldBegin\n"
                      "AreaLightSource \"diffuse\" \"rgb L\" [1 2 4]\n" SPHERE
                      "LightSource \"point\"\nWorldEnd\n");
    assert_true(desc->shapes[0].radiance.b == 12.0);
    assert_true(desc->lights[0].intensity.g == 3.0);
    scene_desc_destroy(desc);
}

/* LuxRender's meaning of the same words. */
static void test_lux(void **state)
{
    (void)state;
    struct scene_desc *desc = import_test_good(
        "scene.lxs",
        "SurfaceIntegrator \"bidirectional\" \"integer eyedepth\" 7 "
        "\"integer lightdepth\" 5\nCamera \"perspective\"\nWorldBegin\n"
        "MakeNamedVolume \"g\" \"clear\" \"float fresnel\" 1.3\n"
        "MakeNamedMaterial \"a\" \"string type\" \"metal\" \"string name\" \"silver\" "
        "\"float uroughness\" .2 \"float vroughness\" .2\n"
        "MakeNamedMaterial \"b\" \"string type\" \"glass2\"\n"
        "MakeNamedMaterial \"m\" \"string type\" \"mix\" \"string namedmaterial1\" \"a\" "
        "\"string namedmaterial2\" \"b\" \"float amount\" .3\n"
        "ObjectBegin \"o\" " SPHERE "ObjectEnd NamedMaterial \"m\" ObjectInstance \"o\"\n"
        "AttributeBegin AreaLightSource \"area\" \"float power\" 10 "
        "\"float efficacy\" 20 \"float gain\" .5 \"color L\" [.3 .3 .3]\n"
        "Shape \"trianglemesh\" \"point P\" [0 0 0 2 0 0 0 2 0] "
        "\"integer indices\" [0 1 2] AttributeEnd\nWorldEnd\n");
    assert_int_equal(desc->max_depth, 12);
    /* Right-handed: +x of the picture is to the other side of pbrt's. */
    assert_true(xform_swaps_handedness(&desc->camera.to_world));
    const struct bsdf *mix = &desc->materials[desc->shapes[0].material];
    assert_string_equal(mix->type->name, "blend");
    assert_string_equal(mix->child[0]->type->name, "roughconductor");
    assert_string_equal(mix->child[1]->type->name, "dielectric");
    import_test_near(mix->child[1]->param[0], 1.3, 1e-12);
    import_test_near(mix->param[0], 0.3, 1e-12);
    int alpha = bsdf_param_find(mix->child[0]->type, "alpha_u")->offset;
    import_test_near(mix->child[0]->param[alpha], 0.2, 1e-12);
    /* 10 W of 20 lm/W by half, from 2 square units: 100 / (2 pi). */
    import_test_near(desc->shapes[1].radiance.g, 100.0 / (2.0 * 3.14159265358979), 1e-6);
    scene_desc_destroy(desc);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_transforms),
        cmocka_unit_test(test_stack),
        cmocka_unit_test(test_state_scope),
        cmocka_unit_test(test_camera),
        cmocka_unit_test(test_camera_defaults),
        cmocka_unit_test(test_scaled_camera),
        cmocka_unit_test(test_mlt),
        cmocka_unit_test(test_material_of_shape),
        cmocka_unit_test(test_materials),
        cmocka_unit_test(test_rough_materials),
        cmocka_unit_test(test_translucent),
        cmocka_unit_test(test_names),
        cmocka_unit_test(test_lights),
        cmocka_unit_test(test_textures),
        cmocka_unit_test(test_lights_without_surface),
        cmocka_unit_test(test_objects),
        cmocka_unit_test(test_more_materials),
        cmocka_unit_test(test_mix_of_a_list),
        cmocka_unit_test(test_film_scale),
        cmocka_unit_test(test_lux),
        cmocka_unit_test(test_mesh),
        cmocka_unit_test(test_orientation),
        cmocka_unit_test(test_quadrics),
        cmocka_unit_test(test_include_and_plymesh),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* import/mitsuba/mitsuba_principled and the table of mitsuba_material: BSDFs that are
 * taken as the nearest that there is, each with a note. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/mitsuba_test.h"

static struct scene_desc *material(const char *type, const char *body)
{
    char text[1000];
    snprintf(text, sizeof text,
             NEW("<shape type=\"rectangle\"><bsdf type=\"%s\">%s</bsdf></shape>"), type,
             body);
    return good(text);
}

/* Every plugin of the documentation becomes something, and says what. */
static void test_table(void **state)
{
    (void)state;
    static const struct {
        const char *type, *body, *kind, *note;
    } rows[] = {
        {"ward", "", "substrate", "a glossy coat over a diffuse base"},
        {"principledthin", "", "diffuse", "its diffuse part"},
        {"pplastic", "", "roughplastic", "roughplastic: nothing is polarised"},
        {"hk", "", "diffuse", "diffuse"},
        {"irawan", "", "diffuse", "diffuse"},
        {"measured", "", "diffuse", "diffuse"},
        {"hair", "", "diffuse", "diffuse"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char note[200];
        struct scene_desc *desc = material(rows[i].type, rows[i].body);
        assert_string_equal(front(desc, 0)->type->name, rows[i].kind);
        snprintf(note, sizeof note, "bsdf \"%s\" is not read as it is: taken as %s",
                 rows[i].type, rows[i].note);
        import_test_note(desc, note, 1, 2);
        scene_desc_destroy(desc);
    }
    static const char *const clear[] = {"polarizer", "retarder", "circular"};
    for (size_t i = 0; i < sizeof clear / sizeof clear[0]; i++) {
        struct scene_desc *desc = material(clear[i], "");
        assert_int_equal(desc->shape_count, 0);
        import_test_note(desc, "light passes it whole", 1, 2);
        scene_desc_destroy(desc);
    }
}

/* Those that are as Mitsuba means them. */
static void test_diffuse_kinds(void **state)
{
    (void)state;
    struct scene_desc *desc = material("difftrans", "");
    const struct bsdf *bsdf = &desc->materials[desc->shapes[0].material];
    assert_string_equal(bsdf->type->name, "translucent");
    assert_true(bsdf->param[0] == 0.0 && bsdf->param[3] == 0.5);
    assert_int_equal(desc->log.count, 0);
    scene_desc_destroy(desc);
    desc = material("roughdiffuse", "<float name=\"alpha\" value=\".4\"/>");
    assert_string_equal(front(desc, 0)->type->name, "orennayar");
    import_test_near(*front_param(desc, 0, "sigma"), 0.4 / sqrt(2.0), 1e-12);
    assert_true(*front_param(desc, 0, "full") == 1.0);
    assert_int_equal(desc->log.count, 0);
    scene_desc_destroy(desc);
    desc = material("roughdiffuse", "<boolean name=\"useFastApprox\" value=\"true\"/>");
    assert_true(*front_param(desc, 0, "full") == 0.0);
    import_test_near(*front_param(desc, 0, "sigma"), 0.2 / sqrt(2.0), 1e-12);
    scene_desc_destroy(desc);
}

static void test_ward(void **state)
{
    (void)state;
    struct scene_desc *desc = material(
        "ward", "<float name=\"alpha_u\" value=\".3\"/><rgb name=\"diffuse_reflectance\" "
                "value=\".1\"/><rgb name=\"specular_reflectance\" value=\".4\"/>");
    import_test_near(*front_param(desc, 0, "alpha_u"), 0.3, 1e-12);
    import_test_near(*front_param(desc, 0, "alpha_v"), 0.1, 1e-12);
    rgb_is(front_param(desc, 0, "kd"), 0.1, 0.1, 0.1);
    rgb_is(front_param(desc, 0, "ks"), 0.4, 0.4, 0.4);
    assert_int_equal(desc->log.count, 1);
    scene_desc_destroy(desc);
}

/* Only the parts that there are; alpha is the square of the roughness. */
static void test_principled_parts(void **state)
{
    (void)state;
#define BASE           "<rgb name=\"base_color\" value=\".25 .5 .04\"/>"
#define N(name, value) "<float name=\"" name "\" value=\"" value "\"/>"
    struct scene_desc *desc = material("principled",
                                       BASE N("roughness", ".4") N("specular", ".5"));
    assert_string_equal(front(desc, 0)->type->name, "roughplastic");
    rgb_is(front_param(desc, 0, "reflectance"), 0.25, 0.5, 0.04);
    import_test_near(*front_param(desc, 0, "alpha_u"), 0.16, 1e-12);
    import_test_near(*front_param(desc, 0, "eta"), 1.5, 1e-9);
    assert_string_equal(desc->materials[desc->shapes[0].material].type->name, "sides");
    scene_desc_destroy(desc);

    /* a metal reflects the base colour straight on: ((eta - 1) / (eta + 1))^2 */
    desc = material("principled", BASE N("metallic", "1"));
    assert_string_equal(front(desc, 0)->type->name, "roughconductor");
    rgb_is(front_param(desc, 0, "eta"), 3.0, (1 + sqrt(0.5)) / (1 - sqrt(0.5)), 1.5);
    rgb_is(front_param(desc, 0, "k"), 0.0, 0.0, 0.0);
    scene_desc_destroy(desc);

    desc = material("principled", BASE N("spec_trans", "1") N("eta", "1.3"));
    assert_string_equal(front(desc, 0)->type->name, "roughdielectric");
    rgb_is(front_param(desc, 0, "transmittance"), 0.25, 0.5, 0.04);
    import_test_near(*front_param(desc, 0, "eta"), 1.3, 1e-12);
    scene_desc_destroy(desc);
}

static void test_principled_blend(void **state)
{
    (void)state;
    struct scene_desc *desc = material(
        "principled", BASE N("metallic", ".3") N("spec_trans", ".2")
                          N("anisotropic", ".5") N("roughness", ".5") N("sheen", ".1"));
    const struct bsdf *all = front(desc, 0);
    assert_string_equal(all->type->name, "blend");
    rgb_is(param_of(all, "weight"), 0.3, 0.3, 0.3);
    assert_string_equal(all->child[1]->type->name, "roughconductor");
    const struct bsdf *below = all->child[0];
    assert_string_equal(below->type->name, "blend");
    rgb_is(param_of(below, "weight"), 0.2, 0.2, 0.2);
    assert_string_equal(below->child[0]->type->name, "roughplastic");
    assert_string_equal(below->child[1]->type->name, "roughdielectric");
    double aspect = sqrt(1.0 - 0.45);
    import_test_near(*param_of(all->child[1], "alpha_u"), 0.25 / aspect, 1e-12);
    import_test_near(*param_of(all->child[1], "alpha_v"), 0.25 * aspect, 1e-12);
    import_test_note(desc, "unused <float> \"sheen\"", 1, 2);
    scene_desc_destroy(desc);
}

/* Textures: of the colour in all parts, of metallic as the weight; roughness by its mean.
 */
static void test_principled_textures(void **state)
{
    (void)state;
#define CHECKER(name, a, b)                                                            \
    "<texture type=\"checkerboard\" name=\"" name "\"><rgb name=\"color0\" value=\"" a \
    "\"/><rgb name=\"color1\" value=\"" b "\"/></texture>"
    struct scene_desc *desc = material(
        "principled", CHECKER("base_color", ".1", ".5") CHECKER("metallic", "0", "1")
                          CHECKER("roughness", ".2", ".6"));
    const struct bsdf *all = front(desc, 0);
    assert_string_equal(all->type->name, "blend");
    assert_non_null(all->bound[0].texture);
    assert_non_null(all->child[0]->bound[0].texture);
    assert_non_null(all->child[1]->bound[0].texture);
    import_test_near(*param_of(all->child[0], "alpha_u"), 0.16, 1e-3);
    import_test_note(desc, "no texture is read here, only its mean", 1, 2);
    scene_desc_destroy(desc);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_table),
        cmocka_unit_test(test_diffuse_kinds),
        cmocka_unit_test(test_ward),
        cmocka_unit_test(test_principled_parts),
        cmocka_unit_test(test_principled_blend),
        cmocka_unit_test(test_principled_textures),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

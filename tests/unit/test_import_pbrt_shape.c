/* import/pbrt: shapes that become meshes, by their areas, normals and sides. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "base/mem.h"
#include "support/import_test.h"

#define PI 3.14159265358979323846

static struct scene_desc *world(const char *body)
{
    struct text text = {0};
    text_append(&text, "Camera \"perspective\" Film \"image\" WorldBegin\n%s\nWorldEnd\n",
                body);
    struct scene_desc *desc = import_test_good("scene.pbrt", text.data);
    mem_free(text.data);
    return desc;
}

static const float *corner(const struct mesh *mesh, const float *array, uint32_t triangle,
                           int k)
{
    return array + 3 * (size_t)mesh->index[3 * (size_t)triangle + (size_t)k];
}

/* Whether every triangle's winding goes with the normals of its corners. */
static bool sides_agree(const struct mesh *mesh)
{
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const float *c[3];
        double e[2][3], n[3], dot = 0.0;
        for (int k = 0; k < 3; k++)
            c[k] = corner(mesh, mesh->p, t, k);
        for (int i = 0; i < 3; i++) {
            e[0][i] = (double)c[1][i] - (double)c[0][i];
            e[1][i] = (double)c[2][i] - (double)c[0][i];
        }
        for (int i = 0; i < 3; i++) {
            int j = (i + 1) % 3, k = (i + 2) % 3;
            n[i] = e[0][j] * e[1][k] - e[0][k] * e[1][j];
        }
        for (int k = 0; k < 3; k++)
            for (int i = 0; i < 3; i++)
                dot += n[i] * (double)corner(mesh, mesh->n, t, k)[i];
        if (!(dot > 0.0))
            return false;
    }
    return true;
}

/* The mesh of the one shape, of that area to a thousandth: 128 corners a turn leave less
 * out. */
static void is_mesh(const char *shape, double area)
{
    struct scene_desc *desc = world(shape);
    assert_int_equal(desc->shape_count, 1);
    assert_int_equal(desc->shapes[0].kind, SHAPE_MESH);
    const struct mesh *mesh = desc->shapes[0].mesh;
    import_test_near(mesh_area(mesh) / area, 1.0, 1e-3);
    if (mesh->n)
        assert_true(sides_agree(mesh));
    assert_false(desc->shapes[0].reverse_orientation);
    struct err err = {0};
    struct log log = {0};
    assert_true(mesh_check(desc->shapes[0].mesh, NULL, &log, &err));
    assert_int_equal(log.count, 0); /* nothing degenerate */
    scene_desc_destroy(desc);
}

/* Length of y = x^2 from 0 to 1, turned. */
#define PARABOLOID (PI / 6.0 * (pow(5.0, 1.5) - 1.0))

static void test_parts(void **state)
{
    (void)state;
    is_mesh("Shape \"sphere\" \"float radius\" 2 \"float zmin\" -1",
            2.0 * PI * 2.0 * 3.0);
    is_mesh("Shape \"sphere\" \"float phimax\" 90", PI);
    is_mesh("Shape \"sphere\" \"float zmin\" .5 \"float zmax\" -.5 \"float phimax\" 180",
            PI);
    is_mesh("Shape \"disk\" \"float radius\" 2 \"float innerradius\" 1.5",
            PI * (4.0 - 2.25));
    is_mesh("Shape \"disk\" \"float phimax\" 45", PI / 8.0);
    is_mesh("Shape \"cylinder\" \"float phimax\" 60 \"float zmax\" 2", PI);
    is_mesh("Shape \"cone\" \"float radius\" 3 \"float height\" 4", PI * 15.0);
    is_mesh("Shape \"paraboloid\"", PARABOLOID);
    is_mesh("Shape \"paraboloid\" \"float zmin\" .25",
            PARABOLOID - PI / 6.0 * (pow(2.0, 1.5) - 1.0));
    is_mesh("Shape \"hyperboloid\" \"point p1\" [1 0 0] \"point p2\" [1 0 2]", 4.0 * PI);
    is_mesh("Shape \"hyperboloid\" \"point p1\" [0 3 0] \"point p2\" [0 0 4]", 15.0 * PI);
    is_mesh("Shape \"heightfield\" \"integer nu\" 3 \"integer nv\" 2 \"float Pz\" "
            "[0 1 2 0 1 2]",
            sqrt(5.0));
}

/* uv of pbrt: u along the turn, v along the profile. */
static void test_uv(void **state)
{
    (void)state;
    struct scene_desc *desc = world("Shape \"cylinder\" \"float phimax\" 90");
    const struct mesh *mesh = desc->shapes[0].mesh;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const float *p = mesh->p + 3 * (size_t)v, *uv = mesh->uv + 2 * (size_t)v;
        double phi = atan2((double)p[1], (double)p[0]);
        import_test_near((double)uv[0], phi / (0.5 * PI), 1e-6);
        import_test_near((double)uv[1], 0.5 * ((double)p[2] + 1.0), 1e-6);
    }
    import_test_note(desc, "a part of a cylinder", 1, 2);
    scene_desc_destroy(desc);
}

/* A lamp keeps its side where the transform mirrors, for pbrt samples it so; what does
 * not shine changes it. Under the transform of an instance all shapes keep theirs. */
static void test_mirrored_lamps(void **state)
{
    static const char lamp[] =
        "AttributeBegin AreaLightSource \"diffuse\" Shape \"sphere\" Shape \"disk\" "
        "Shape \"disk\" \"float innerradius\" .5 AttributeEnd Shape \"sphere\" "
        "Shape \"disk\" \"float innerradius\" .5\n";
    struct text text = {0};
    (void)state;
    text_append(&text, "Scale -1 1 1\n%s ReverseOrientation\n%s", lamp, lamp);
    struct scene_desc *desc = world(text.data);
    assert_int_equal(desc->shape_count, 10);
    for (int i = 0; i < 10; i++) {
        bool shines = i % 5 < 3, reversed = i >= 5;
        assert_int_equal(desc->shapes[i].emits, shines);
        assert_int_equal(desc->shapes[i].reverse_orientation, reversed == shines);
    }
    scene_desc_destroy(desc);
    mem_free(text.data);
    desc = world(
        "ObjectBegin \"o\" AreaLightSource \"diffuse\" Shape \"sphere\" ObjectEnd "
        "Scale 1 -1 1 ObjectInstance \"o\"");
    assert_false(desc->shapes[0].reverse_orientation);
    scene_desc_destroy(desc);
}

/* Lamps of an uneven scale are meshes; what does not shine stays a sphere. */
static void test_sheared_lamp(void **state)
{
    (void)state;
    struct scene_desc *desc = world("Scale 1 1 .5 Shape \"sphere\" AreaLightSource "
                                    "\"diffuse\" Shape \"sphere\" Scale 1 1 2 "
                                    "Shape \"sphere\"");
    assert_int_equal(desc->shapes[0].kind, SHAPE_SPHERE);
    assert_int_equal(desc->shapes[1].kind, SHAPE_MESH);
    assert_int_equal(desc->shapes[2].kind, SHAPE_SPHERE);
    /* An oblate spheroid of axes 1 and 1/2: e^2 = 3/4. */
    double e = sqrt(0.75), area = 2.0 * PI * (1.0 + (1.0 - e * e) / e * atanh(e));
    import_test_near(mesh_area(desc->shapes[1].mesh) / area, 1.0, 2e-3);
    assert_true(sides_agree(desc->shapes[1].mesh));
    scene_desc_destroy(desc);
}

static void test_bilinear(void **state)
{
    (void)state;
    struct scene_desc *desc = world(
        "Shape \"bilinearmesh\" \"point3 P\" [0 0 0 2 0 0 0 1 0 2 1 0]\n"
        "Shape \"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1 0 2 0 1 2 1] "
        "\"integer indices\" [0 1 2 3 2 3 4 5] \"point2 uv\" [0 0 1 0 0 1 1 1 0 2 1 2]\n"
        "Shape \"trianglemesh\" \"point3 P\" [0 0 0 2 0 0 0 1 0]\n");
    const struct mesh *flat = desc->shapes[0].mesh, *bent = desc->shapes[1].mesh;
    assert_int_equal(flat->triangle_count, 2);
    import_test_near(mesh_area(flat), 2.0, 1e-9);
    assert_true(flat->uv[6] == 1.0f && flat->uv[7] == 1.0f);
    /* The first is z = xy; the other a parallelogram, for 3 is over (1, 1). */
    assert_int_equal(bent->triangle_count, 2 * 64 + 2);
    for (uint32_t v = 0; v < 81; v++) {
        const float *p = bent->p + 3 * (size_t)v;
        import_test_near((double)p[2], (double)p[0] * (double)p[1], 1e-6);
        assert_true(bent->uv[2 * v] == p[0] && bent->uv[2 * v + 1] == p[1]);
    }
    import_test_note(desc, "bilinear patches that are no parallelograms are cut", 1, 3);
    assert_int_equal(desc->shapes[2].mesh->triangle_count, 1);
    assert_int_equal(desc->log.count, 1);
    scene_desc_destroy(desc);
}

/* A tube of six sides: 3 / pi of a cylinder's area, whatever the basis writes the line.
 */
static void is_line(const char *parameters, double length)
{
    char text[500];
    snprintf(text, sizeof text, "Shape \"curve\" \"float width\" .2 %s", parameters);
    struct scene_desc *desc = world(text);
    struct mesh *mesh = desc->shapes[0].mesh;
    import_test_near(mesh_area(mesh), 6.0 * 0.1 * length, 1e-5);
    assert_true(sides_agree(mesh));
    import_test_note(desc, "curves are taken as meshes", 1, 2);
    assert_int_equal(desc->log.count, 1);
    scene_desc_destroy(desc);
}

static void test_curves(void **state)
{
    (void)state;
    is_line("\"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0]", 3.0);
    is_line("\"point3 P\" [0 0 0 0 1 0 0 2 0] \"integer degree\" 2 \"string type\" "
            "\"cylinder\"",
            2.0);
    is_line("\"point3 P\" [0 0 0 0 0 1 0 0 2 0 0 3 0 0 4] \"string basis\" \"bspline\" "
            "\"integer splitdepth\" 2",
            2.0);
    is_line("\"point3 P\" [0 0 0 0 0 1 0 0 2 0 0 3] \"string basis\" \"bspline\" "
            "\"integer degree\" 2 \"string type\" \"ribbon\"",
            2.0);
    /* From width 2 to 1 over a length of 3: a trapezium that faces +z. */
    struct scene_desc *desc = world(
        "Shape \"curve\" \"string type\" \"ribbon\" \"point P\" [0 0 0 1 0 0 2 0 0 3 0 "
        "0] \"float width0\" 2 \"float width1\" 1 \"normal N\" [0 0 1 0 0 1]");
    const struct mesh *mesh = desc->shapes[0].mesh;
    import_test_near(mesh_area(mesh), 4.5, 1e-5);
    assert_true(sides_agree(mesh) && mesh->n[2] > 0.99f);
    scene_desc_destroy(desc);
}

static void test_bad(void **state)
{
    static const char *const rows[][2] = {
        {"\"sphere\" \"float radius\" 0", "the radius is not positive"},
        {"\"sphere\" \"float phimax\" 0", "phimax is not positive"},
        {"\"sphere\" \"float zmin\" 1", "zmin and zmax leave nothing of the sphere"},
        {"\"disk\" \"float innerradius\" 1", "innerradius is not below the radius"},
        {"\"cylinder\" \"float zmin\" 1", "zmin is not below zmax"},
        {"\"cone\" \"float radius\" -1", "the radius is not positive"},
        {"\"paraboloid\" \"float zmin\" -1", "a paraboloid wants 0 <= zmin < zmax"},
        {"\"hyperboloid\" \"point p2\" [0 0 0]", "p1 and p2 of a hyperboloid make no"},
        {"\"hyperboloid\" \"point p1\" [0 0 0 1 1 1]", "\"point p1\" is one point"},
        {"\"heightfield\" \"integer nu\" 2 \"integer nv\" 2 \"float Pz\" [1 2 3]",
         "wants nu, nv of 2 or more and nu x nv numbers Pz"},
        {"\"cone\" \"float height\" 3e38 Scale 9 9 9 Shape \"cone\" \"float height\" "
         "3e38",
         "not finite"},
        {"\"curve\" \"point3 P\" [0 0 0 1 1 1 2 2 2]", "\"curve\" wants \"point3 P\""},
        {"\"curve\" \"point3 P\" [0 0 0] \"integer degree\" 4", "degree of a curve is 2"},
        {"\"curve\" \"string type\" \"flt\"", "unknown type \"flt\""},
        {"\"bilinearmesh\" \"point3 P\" [0 0 0]", "\"bilinearmesh\" wants \"point3 P\""},
        {"\"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0] \"integer indices\" "
         "[0 1 2 4]",
         "index 4 is outside the mesh's 4 points"},
        {"\"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0] \"normal N\" [0 0 1]",
         "3 numbers do not fit the mesh's points, 12 are wanted"},
        {"\"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1]",
         "\"trianglemesh\" wants \"integer indices\""},
    };
    (void)state;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char text[400];
        snprintf(text, sizeof text, "WorldBegin\n Shape %s", rows[i][0]);
        import_test_bad("scene.pbrt", text, rows[i][1]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_parts),
        cmocka_unit_test(test_uv),
        cmocka_unit_test(test_mirrored_lamps),
        cmocka_unit_test(test_sheared_lamp),
        cmocka_unit_test(test_bilinear),
        cmocka_unit_test(test_curves),
        cmocka_unit_test(test_bad),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

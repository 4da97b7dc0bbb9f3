/* What accel_intersect fills in, and accel_visible. */

#include "math/rng.h"
#include "math/warp.h"
#include "support/bsdf_make.h"
#include "support/scene_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "support/near.h"

/* The unit square at z = 5 facing the camera at the origin (normal -z), or away. */
static struct mesh *square(bool towards, bool normals)
{
    struct mesh *mesh = mesh_create(4, 2, normals, true);
    const float p[12] = {-1, -1, 5, 1, -1, 5, 1, 1, 5, -1, 1, 5};
    const float uv[8] = {0, 0, 1, 0, 1, 1, 0, 1};
    const uint32_t away[6] = {0, 1, 2, 0, 2, 3}, to[6] = {0, 2, 1, 0, 3, 2};
    memcpy(mesh->p, p, sizeof p);
    memcpy(mesh->uv, uv, sizeof uv);
    memcpy(mesh->index, towards ? to : away, sizeof to);
    for (size_t i = 0; normals && i < 4; i++) {
        mesh->n[3 * i] = p[3 * i] * 0.3f;
        mesh->n[3 * i + 2] = -1.0f;
    }
    return mesh;
}

static struct hit shoot(const struct scene *scene, double x, double y)
{
    struct ray_endpoint from = {.p = vec3(0.0f, 0.0f, 0.0f)};
    struct hit hit;
    struct vec3 w = vec3_normalize(vec3((float)x, (float)y, 5.0f));
    assert_true(accel_intersect(scene, &from, w, &hit));
    return hit;
}

/* Winding, flip and shading normals: who decides the side. */
static void sides(void **state)
{
    (void)state;
    for (int mask = 0; mask < 8; mask++) {
        bool towards = mask & 1, flip = mask & 2, normals = mask & 4;
        struct scene_desc *desc = fixture_desc();
        fixture_point_light(desc);
        fixture_mesh(desc, square(towards, normals))->reverse_orientation = flip;
        struct scene *scene = fixture_build(desc);
        struct hit hit = shoot(scene, 0.5, -0.25);
        /* The shading normals point to -z whatever the winding. */
        bool minus_z = (normals ? true : towards) != flip;
        assert_near(hit.at.ng.z, minus_z ? -1.0 : 1.0, 1e-7);
        assert_true(vec3_dot(hit.at.ng, hit.shading.n) > 0.0f);
        double slope = normals ? 0.5 * 0.3 : 0.0, side = minus_z ? 1.0 : -1.0;
        assert_near(hit.shading.n.x, side * slope / sqrt(1.0 + slope * slope), 1e-6);
        assert_near(hit.at.p.x, 0.5, 1e-6);
        assert_near(hit.at.p.y, -0.25, 1e-6);
        assert_near(hit.at.p.z, 5.0, 0.0);
        assert_int_equal(hit.shape, 0);
        assert_int_equal(hit.light, -1);
        assert_ptr_equal(hit.bsdf, &scene->desc->materials[0]);
        assert_true(scene->needs.shading_normals == normals);
        scene_destroy(scene);
    }
}

/* Shading normals that repeat the geometric ones, on either side, cost nothing more. */
static void flat_normals_are_left_out(void **state)
{
    (void)state;
    for (int mask = 0; mask < 4; mask++) {
        bool towards = mask & 1, flip = mask & 2;
        struct scene_desc *desc = fixture_desc();
        fixture_point_light(desc);
        struct mesh *mesh = square(towards, true);
        for (size_t i = 0; i < 4; i++)
            mesh->n[3 * i] = 0.0f;
        fixture_mesh(desc, mesh)->reverse_orientation = flip;
        struct scene *scene = fixture_build(desc);
        assert_false(scene->needs.shading_normals);
        struct hit hit = shoot(scene, 0.5, -0.25);
        assert_near(hit.at.ng.z, flip ? 1.0 : -1.0, 0.0);
        assert_near(hit.shading.n.z, flip ? 1.0 : -1.0, 0.0);
        scene_destroy(scene);
    }
}

/* An anisotropic material gets s along dp/du, and uv where they are needed. */
static void aligned_frames_and_uv(void **state)
{
    (void)state;
    for (int keep = 0; keep < 2; keep++) {
        struct scene_desc *desc = fixture_desc();
        fixture_point_light(desc);
        desc->materials[0].flags |= BSDF_ANISOTROPIC;
        struct mesh *mesh = square(true, false);
        for (size_t i = 0; i < 4; i++) { /* u along -y, v along x */
            mesh->uv[2 * i] = -mesh->p[3 * i + 1];
            mesh->uv[2 * i + 1] = mesh->p[3 * i];
        }
        fixture_mesh(desc, mesh);
        struct scene_options options = {.threads = 1, .keep_all = keep};
        struct scene *scene = scene_build(desc, &options, NULL);
        assert_non_null(scene);
        struct hit hit = shoot(scene, 0.5, -0.25);
        assert_near(hit.shading.s.y, -1.0, 1e-6);
        assert_near(vec3_dot(hit.shading.s, hit.shading.t), 0.0, 1e-7);
        assert_near(hit.u, keep ? 0.25 : 0.0, 1e-6);
        assert_near(hit.v, keep ? 0.5 : 0.0, 1e-6);
        scene_destroy(scene);
    }
}

/* A sphere in front of a square: the quadric's hit is exact, and the nearest wins. */
static void quadrics_and_meshes_together(void **state)
{
    (void)state;
    struct scene_desc *desc = fixture_desc();
    fixture_point_light(desc);
    fixture_mesh(desc, square(true, false));
    struct xform at = xform_translate(0.0, 0.0, 3.0), grow = xform_scale(0.5, 0.5, 0.5);
    fixture_quadric(desc, SHAPE_SPHERE, xform_mul(&at, &grow));
    struct xform behind = xform_translate(0.0, 0.0, 9.0);
    fixture_quadric(desc, SHAPE_SPHERE, behind);
    struct scene *scene = fixture_build(desc);
    struct hit hit = shoot(scene, 0.0, 0.0);
    assert_int_equal(hit.shape, 1);
    assert_near(hit.at.p.z, 2.5, 0.0);
    assert_near(hit.at.ng.z, -1.0, 0.0);
    hit = shoot(scene, 0.97, 0.0);
    assert_int_equal(hit.shape, 0);
    hit = shoot(scene, 0.4, 0.7);
    double x = (double)hit.at.p.x, y = (double)hit.at.p.y, z = (double)hit.at.p.z - 3.0;
    assert_near(sqrt(x * x + y * y + z * z), 0.5, 2e-7);
    scene_destroy(scene);
}

static void visibility(void **state)
{
    (void)state;
    struct scene_desc *desc = fixture_desc();
    fixture_point_light(desc);
    fixture_mesh(desc, square(true, false));
    struct xform at = xform_translate(0.0, 0.0, 8.0);
    fixture_quadric(desc, SHAPE_SPHERE, at);
    struct scene *scene = fixture_build(desc);
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, 0);
    long seen = 0, odd = 0;
    for (int i = 0; i < 20000; i++) {
        struct ray_endpoint a = {.p = vec3(4.0f * (float)rng_double(&rng) - 2.0f,
                                           4.0f * (float)rng_double(&rng) - 2.0f, 0.0f)};
        struct ray_endpoint b = a;
        b.p = vec3(4.0f * (float)rng_double(&rng) - 2.0f,
                   4.0f * (float)rng_double(&rng) - 2.0f, 10.0f);
        /* By hand: the square at half way, the sphere at eight tenths. */
        double mx = 0.5 * (double)(a.p.x + b.p.x), my = 0.5 * (double)(a.p.y + b.p.y);
        double o[3] = {(double)a.p.x, (double)a.p.y, -8.0};
        double d[3] = {(double)(b.p.x - a.p.x), (double)(b.p.y - a.p.y), 10.0};
        double dd = d[0] * d[0] + d[1] * d[1] + 100.0;
        double od = o[0] * d[0] + o[1] * d[1] + o[2] * d[2];
        double foot = o[0] * o[0] + o[1] * o[1] + 64.0 - od * od / dd;
        double margin = fmin(fabs(fmax(fabs(mx), fabs(my)) - 1.0), fabs(foot - 1.0));
        if (margin < 1e-5)
            continue;
        bool clear = fmax(fabs(mx), fabs(my)) > 1.0 && foot > 1.0;
        assert_true(accel_visible(scene, &a, &b) == clear);
        odd += accel_visible(scene, &b, &a) != clear;
        seen += clear;
    }
    assert_int_equal(odd, 0);
    assert_true(seen > 2000 && seen < 18000);
    scene_destroy(scene);
}

static struct rgb ramp(const struct texture *texture, const struct texture_point *at)
{
    (void)texture;
    return rgb_grey(0.5 * at->u);
}

static struct rgb ramp_in_space(const struct texture *texture,
                                const struct texture_point *at)
{
    (void)texture;
    return rgb_grey(0.25 * at->p[0]);
}

/* x = 2u - 1, so a height of u/2 rises by a quarter along x; as one of x/4 does. */
static void bump_turns_the_shading_normal(void **state)
{
    (void)state;
    static const struct texture slopes[] = {{.eval = ramp}, {.eval = ramp_in_space}};
    for (int mask = 0; mask < 4; mask++) {
        int normals = mask & 1;
        struct scene_desc *desc = fixture_desc();
        fixture_point_light(desc);
        desc->materials[0].relief.texture = &slopes[mask >> 1];
        struct mesh *mesh = square(true, normals != 0);
        for (size_t i = 0; normals && i < 4; i++)
            mesh->n[3 * i] = 0.0f;
        fixture_mesh(desc, mesh);
        struct scene *scene = fixture_build(desc);
        assert_true(scene->needs.uv && scene->needs.bump && scene->needs.shading_normals);
        struct hit hit = shoot(scene, 0.5, -0.25);
        assert_near(hit.at.ng.z, -1.0, 0.0);
        assert_near(hit.shading.n.x, -0.25 / sqrt(1.0625), 1e-5);
        assert_near(hit.shading.n.z, -1.0 / sqrt(1.0625), 1e-5);
        struct texture_point at = hit_texture_point(&hit);
        assert_near(at.p[0], 0.5, 1e-6);
        assert_near(at.p[1], -0.25, 1e-6);
        scene_destroy(scene);
    }
}

/* Normals (3, -4, 12)/13, as colours. */
static struct rgb tilted(const struct texture *texture, const struct texture_point *at)
{
    (void)texture, (void)at;
    return rgb(0.5 * (1.0 + 3.0 / 13.0), 0.5 * (1.0 - 4.0 / 13.0),
               0.5 * (1.0 + 12.0 / 13.0));
}

/* The square's dp/du is +x; the other tangent is n x dp/du: -y where n is -z. */
static void normal_map_turns_the_shading_normal(void **state)
{
    (void)state;
    static const struct texture normals = {.eval = tilted};
    for (int mask = 0; mask < 4; mask++) {
        bool towards = mask & 1, aligned = mask & 2;
        struct scene_desc *desc = fixture_desc();
        fixture_point_light(desc);
        if (aligned)
            desc->materials[0] = bsdf_make("roughconductor", "alpha_u", 0.3, NULL);
        desc->materials[0].relief = (struct bsdf_relief){&normals, true};
        struct mesh *mesh = square(towards, false);
        fixture_mesh(desc, mesh);
        struct scene *scene = fixture_build(desc);
        struct hit hit = shoot(scene, 0.5, -0.25);
        double z = towards ? -1.0 : 1.0;
        assert_true(scene->needs.bump && scene->needs.shading_normals);
        assert_near(hit.at.ng.z, z, 0.0);
        assert_near(hit.shading.n.x, 3.0 / 13.0, 1e-6);
        assert_near(hit.shading.n.y, z * -4.0 / 13.0, 1e-6);
        assert_near(hit.shading.n.z, z * 12.0 / 13.0, 1e-6);
        if (aligned) {
            /* dp/du without its part along the new normal. */
            double along = 3.0 / 13.0, length = sqrt(1.0 - along * along);
            assert_near(hit.shading.s.x, length, 1e-6);
            assert_near(vec3_dot(hit.shading.s, hit.shading.n), 0.0, 1e-6);
        }
        scene_destroy(scene);
    }
}

/* The other half of the square has parameters without a derivative: its normal stays, as
 * a note says; on a sphere nothing is turned. */
static void normal_map_leaves_what_has_no_parameters(void **state)
{
    (void)state;
    static const struct texture normals = {.eval = tilted};
    struct scene_desc *desc = fixture_desc();
    fixture_point_light(desc);
    desc->materials[0].relief = (struct bsdf_relief){&normals, true};
    struct mesh *mesh = square(true, false);
    mesh->uv[2] = mesh->uv[3] = 0.0f; /* of (1, -1): as (-1, -1) */
    fixture_mesh(desc, mesh);
    struct scene *scene = fixture_build(desc);
    struct hit hit = shoot(scene, 0.5, -0.25);
    assert_near(hit.shading.n.z, -1.0, 0.0);
    hit = shoot(scene, -0.5, 0.25);
    assert_near(hit.shading.n.x, 3.0 / 13.0, 0.7); /* turned, in a frame of its own */
    assert_true(hit.shading.n.z > -0.95f);
    bool noted = false;
    for (size_t i = 0; i < desc->log.count; i++)
        noted = noted ||
                strstr(desc->log.notes[i].text, "does not turn 1 of 2 triangles");
    assert_true(noted);
    scene_destroy(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normal_map_turns_the_shading_normal),
        cmocka_unit_test(normal_map_leaves_what_has_no_parameters),
        cmocka_unit_test(sides),
        cmocka_unit_test(flat_normals_are_left_out),
        cmocka_unit_test(aligned_frames_and_uv),
        cmocka_unit_test(bump_turns_the_shading_normal),
        cmocka_unit_test(quadrics_and_meshes_together),
        cmocka_unit_test(visibility),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

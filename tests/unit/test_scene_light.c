/* Lights: densities against emission, picks, kinds by hand. */

#include "math/rng.h"
#include "math/warp.h"
#include "support/scene_fixture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>

#include "support/near.h"

/* A two-sided box lamp, a one-sided sphere, a disk and a point light. */
static struct scene *four_lights(void)
{
    struct scene_desc *desc = fixture_desc();
    struct shape_desc *box = fixture_mesh(desc, mesh_box());
    box->emits = box->two_sided = true;
    box->radiance = rgb(1.0, 2.0, 3.0);
    struct xform at = xform_translate(5.0, 0.0, 0.0), grow = xform_scale(2.0, -2.0, 2.0);
    struct shape_desc *sphere = fixture_quadric(desc, SHAPE_SPHERE,
                                                xform_mul(&at, &grow));
    sphere->emits = true;
    sphere->radiance = rgb(4.0, 0.0, 0.5);
    struct shape_desc *disk = fixture_quadric(desc, SHAPE_DISK, xform_identity());
    disk->emits = disk->reverse_orientation = true;
    disk->radiance = rgb(0.25, 0.25, 0.25);
    fixture_point_light(desc);
    return fixture_build(desc);
}

static void powers_and_picks(void **state)
{
    (void)state;
    struct scene *scene = four_lights();
    assert_int_equal(scene->light_count, 4);
    assert_true(scene->emission_scale == 4.0);
    double box = 0.2126 + 2.0 * 0.7152 + 3.0 * 0.0722;
    double sphere = 4.0 * 0.2126 + 0.5 * 0.0722;
    const double power[4] = {box / 4.0 * 24.0 * MATH_PI * 2.0,
                             sphere / 4.0 * 16.0 * MATH_PI * MATH_PI,
                             0.25 / 4.0 * MATH_PI * MATH_PI, 4.0 * MATH_PI / 4.0};
    const double area[4] = {24.0, 16.0 * MATH_PI, MATH_PI, 1.0};
    double sum = power[0] + power[1] + power[2] + power[3], picks = 0.0;
    for (int i = 0; i < 4; i++) {
        const struct light *light = &scene->lights[i];
        assert_near(light->power, power[i], 1e-9);
        assert_near(light->pick, power[i] / sum, 1e-12);
        assert_near(light->pdf_point * area[i], light->pick, 1e-12);
        picks += light->pick;
        if (i < 3)
            assert_int_equal(scene->shapes[i].light, i);
    }
    assert_near(picks, 1.0, 1e-12);
    assert_true(scene->lights[3].delta_position);
    scene_destroy(scene);
}

/* u_pick chooses by power, in order; the point lies on the shape and knows its side. */
static void samples_lie_on_shapes(void **state)
{
    (void)state;
    struct scene *scene = four_lights();
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, 0);
    int seen[4] = {0};
    for (int i = 0; i < 20000; i++) {
        double pick = rng_double(&rng), u[2] = {rng_double(&rng), rng_double(&rng)};
        struct hit sampled;
        const struct light *light = light_sample(scene, pick, u, &sampled);
        struct ray_endpoint a = sampled.at;
        double below = 0.0;
        for (const struct light *l = scene->lights; l < light; l++)
            below += l->pick;
        assert_true(pick >= below - 1e-12 && pick <= below + light->pick + 1e-12);
        ptrdiff_t index = light - scene->lights;
        seen[index]++;
        struct vec3 p = a.p;
        if (index == 0) {
            assert_near(vec3_max_abs(p), 1.0, 1e-6);
            assert_near(vec3_dot(p, a.ng), 1.0, 1e-6);
        } else if (index == 1) {
            struct vec3 d = vec3_sub(p, vec3(5.0f, 0.0f, 0.0f));
            assert_near(vec3_dot(d, a.ng), 2.0, 2e-6);
        } else if (index == 2) {
            assert_true(p.z == 0.0f && a.ng.z == -1.0f);
        } else {
            assert_true(vec3_max_abs(p) == 0.0f && vec3_max_abs(a.ng) == 0.0f &&
                        a.offset == 0.0f);
        }
    }
    for (int i = 0; i < 4; i++)
        assert_true(seen[i] > 0);
    scene_destroy(scene);
}

/* weight = emission |cos| / pdf, and pdf_direction is the density that was reported. */
static void directions_agree_with_emission(void **state)
{
    (void)state;
    struct scene *scene = four_lights();
    struct rng rng;
    rng_init(&rng, 2, RNG_TEST, 0);
    for (int i = 0; i < 20000; i++) {
        double u[2] = {rng_double(&rng), rng_double(&rng)},
               v[2] = {rng_double(&rng), rng_double(&rng)};
        struct hit sampled;
        const struct light *light = light_sample(scene, rng_double(&rng), u, &sampled);
        struct ray_endpoint a = sampled.at;
        struct vec3 w;
        double pdf;
        struct rgb weight;
        if (!light->type->sample_direction(light, &a, v, &w, &pdf, &weight))
            continue;
        double cos = light->delta_position ? 1.0 : fabs((double)vec3_dot(a.ng, w));
        if (cos < 1e-3)
            continue; /* the relative rounding of the cosine itself */
        struct rgb e = light_emission(light, &a, w);
        assert_near(light->type->pdf_direction(light, &a, w) / pdf, 1.0, 1e-3);
        assert_near(weight.g * pdf, e.g * cos, 1e-6 * (e.g + 1.0));
        assert_near(weight.r * pdf, e.r * cos, 1e-6 * (e.r + 1.0));
        struct vec3 back = vec3_neg(w);
        bool both = light->two_sided || light->delta_position;
        assert_true((light->type->pdf_direction(light, &a, back) > 0.0) == both);
        assert_true((light_emission(light, &a, back).b > 0.0) == both);
    }
    scene_destroy(scene);
}

/* Integral of pdf_direction over the sphere, by a midpoint rule that is exact up to the
 * square of its step. */
static void direction_densities_integrate_to_one(void **state)
{
    (void)state;
    struct scene *scene = four_lights();
    for (int i = 0; i < 4; i++) {
        const struct light *light = &scene->lights[i];
        double u[2] = {0.3, 0.6}, sum = 0.0;
        struct ray_endpoint a;
        light->type->sample_point(scene, light, u, &a);
        const int nz = 400, np = 400;
        for (int k = 0; k < nz * np; k++) {
            double v[2] = {(k % nz + 0.5) / nz, (k / nz + 0.5) / np};
            sum += light->type->pdf_direction(light, &a, warp_sphere(v)) * 4.0 * MATH_PI /
                   (nz * np);
        }
        assert_near(sum, 1.0, 1e-3);
    }
    scene_destroy(scene);
}

/* Found by a ray, a lamp shows the side that emits and the same density. */
static void hit_equals_sample(void **state)
{
    (void)state;
    struct scene *scene = four_lights();
    struct rng rng;
    rng_init(&rng, 3, RNG_TEST, 0);
    for (int i = 0; i < 5000; i++) {
        double u[2] = {rng_double(&rng), rng_double(&rng)};
        struct ray_endpoint a;
        const struct light *light = &scene->lights[1];
        light->type->sample_point(scene, light, u, &a);
        struct ray_endpoint outside = {.p = vec3_mad(a.p, 0.01f, a.ng)};
        struct hit hit;
        assert_true(accel_intersect(scene, &outside, vec3_neg(a.ng), &hit));
        assert_int_equal(hit.light, 1);
        assert_near(vec3_dot(hit.at.ng, a.ng), 1.0, 1e-6);
        assert_near(vec3_length(vec3_sub(hit.at.p, a.p)), 0.0, 4e-6);
    }
    scene_destroy(scene);
}

/* Between its angles a spot falls off by the fourth power of a line in the cosine (pbrt
 * v3), by a cubic of it (v4), or by a line in the angle (Mitsuba). */
static void spot_falls_off(void **state)
{
    (void)state;
    const double radian = MATH_PI / 180.0, inner = cos(30.0 * radian),
                 outer = cos(75.0 * radian);
    for (int kind = 0; kind < 3; kind++) {
        bool linear = kind == 1, smooth = kind == 2;
        struct scene_desc *desc = fixture_desc();
        struct light_desc spot = {.type = &light_spot,
                                  .to_world = xform_identity(),
                                  .intensity = {1.0, 1.0, 1.0},
                                  .inner = 30.0,
                                  .outer = 75.0,
                                  .linear = linear,
                                  .smooth = smooth};
        scene_desc_add_light(desc, &spot);
        struct scene *scene = fixture_build(desc);
        for (double angle = 15.0; angle < 90.0; angle += 10.0) {
            double cosine = cos(angle * radian);
            struct vec3 w = vec3((float)sin(angle * radian), 0.0f, (float)cosine);
            double t = (cosine - outer) / (inner - outer);
            double edge = linear   ? (75.0 - angle) / 45.0
                          : smooth ? 3.0 * t * t - 2.0 * t * t * t
                                   : pow(t, 4.0);
            double expected = angle < 30.0 ? 1.0 : angle > 75.0 ? 0.0 : edge;
            struct rgb got = light_emission(&scene->lights[0], &(struct ray_endpoint){0},
                                            w);
            assert_near(got.g, expected, 1e-6);
        }
        scene_destroy(scene);
    }
}

/* (u, v^2, u v) */
static struct rgb by_place(const struct texture *texture, const struct texture_point *at)
{
    (void)texture;
    return rgb(at->u, at->v * at->v, at->u * at->v);
}

static const struct texture emission_texture = {.eval = by_place};

/* A lamp of two rectangles that meet at an angle, whose uv is no map of space; or flat.
 */
static struct mesh *folded(bool flat)
{
    struct mesh *mesh = mesh_create(6, 4, false, true);
    const float z = flat ? 0.0f : 0.8f, x = flat ? 2.0f : 1.6f;
    const float p[18] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, x, 0, z, x, 1, z};
    const float uv[12] = {0, 0, 0.5f, 0, 0.5f, 1, 0, 1, 1, 0, 1, 1};
    const uint32_t index[12] = {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2};
    memcpy(mesh->p, p, sizeof p);
    memcpy(mesh->uv, uv, sizeof uv);
    memcpy(mesh->index, index, sizeof index);
    return mesh;
}

/* What a lamp sends is the texture's value at the parameters of the hit, and its power
 * follows from the mean: 1/2, 1/3 and 1/4. */
static void check_textured(struct scene_desc *desc, int lights, double area)
{
    struct shape_desc *lamp = &desc->shapes[desc->shape_count - 1];
    lamp->emits = lamp->two_sided = true;
    lamp->radiance = rgb(2.0, 3.0, 4.0);
    lamp->emission = &emission_texture;
    struct err err = {0};
    struct scene_options options = {.keep_all = true, .threads = 1};
    struct scene *scene = scene_build(desc, &options, &err);
    assert_non_null(scene);
    assert_int_equal(scene->light_count, lights);
    double power = 0.0;
    for (int i = 0; i < lights; i++)
        power += scene->lights[i].power;
    double mean = rgb_luminance(rgb(2.0 / 2.0, 3.0 / 3.0, 4.0 / 4.0));
    assert_near(power * scene->emission_scale / (mean * area * 2.0 * MATH_PI), 1.0, 1e-3);
    struct rng rng;
    rng_init(&rng, 9, RNG_TEST, (uint64_t)lights);
    int hits = 0;
    for (int k = 0; k < 2000; k++) {
        struct ray_endpoint from = {.p = vec3(0.7f, 0.4f, 4.0f)};
        struct vec3 w = vec3((float)(2.0 * rng_double(&rng) - 1.0) - 0.1f,
                             (float)(2.0 * rng_double(&rng) - 1.0), -4.0f);
        struct hit hit;
        w = vec3_normalize(w);
        if (!accel_intersect(scene, &from, w, &hit) || hit.light < 0)
            continue;
        struct rgb got = light_emission(&scene->lights[hit.light], &hit.at, vec3_neg(w));
        struct rgb u = by_place(
            NULL, &(struct texture_point){.u = (double)hit.u, .v = (double)hit.v});
        assert_near(got.r * scene->emission_scale, 2.0 * u.r, 1e-4);
        assert_near(got.g * scene->emission_scale, 3.0 * u.g, 1e-4);
        assert_near(got.b * scene->emission_scale, 4.0 * u.b, 1e-4);
        hits++;
    }
    assert_true(hits > 300);
    scene_destroy(scene);
}

static void textures_shine_by_place(void **state)
{
    (void)state;
    struct scene_desc *desc = fixture_desc();
    fixture_mesh(desc, folded(true));
    check_textured(desc, 1, 2.0);
    desc = fixture_desc();
    fixture_mesh(desc, folded(false));
    check_textured(desc, 4, 2.0);
}

/* A disk has formulas for its parameters: u around, v inwards. */
static void textured_disks_shine_by_place(void **state)
{
    (void)state;
    struct scene_desc *desc = fixture_desc();
    struct shape_desc *disk = fixture_quadric(desc, SHAPE_DISK, xform_identity());
    disk->emits = true;
    disk->radiance = rgb_grey(1.0);
    disk->emission = &emission_texture;
    struct scene *scene = fixture_build(desc);
    for (int k = 0; k < 64; k++) {
        const double u[2] = {(k % 8 + 0.5) / 8.0, (k / 8 + 0.5) / 8.0};
        struct hit sampled;
        const struct light *light = light_sample(scene, 0.5, u, &sampled);
        struct ray_endpoint a = sampled.at;
        double x = (double)a.p.x, y = (double)a.p.y, around = atan2(y, x) / (2 * MATH_PI);
        around += around < 0.0 ? 1.0 : 0.0;
        struct rgb got = light_emission(light, &a, a.ng);
        assert_near(got.r * scene->emission_scale, around, 1e-5);
        assert_near(got.g * scene->emission_scale, pow(1.0 - hypot(x, y), 2.0), 1e-5);
    }
    scene_destroy(scene);
}

/* A lamp whose picture is black but for one texel of 1, which lies between the points of
 * a coarse grid: its power is that of 1/256^2 of the square, and its peak is found. */
static void one_texel_shines(void **state)
{
    (void)state;
    enum { SIDE = 256 };
    struct texture_set set = {0};
    struct texture_image *image = texture_image_create(&set, SIDE, SIDE);
    for (int c = 0; c < 3; c++)
        image->floats[3 * (SIDE * 100 + 100) + c] = 1.0f;
    for (int flat = 0; flat < 2; flat++) {
        struct scene_desc *desc = fixture_desc();
        struct shape_desc *lamp = fixture_mesh(desc, folded(flat == 1));
        lamp->emits = true;
        lamp->radiance = rgb_grey(8.0);
        lamp->emission = texture_picture(&set, image, TEXTURE_REPEAT);
        struct scene *scene = fixture_build(desc);
        double power = 0.0, expected = 8.0 * 2.0 * MATH_PI / (SIDE * SIDE);
        for (int i = 0; i < scene->light_count; i++)
            power += scene->lights[i].power * scene->emission_scale;
        assert_true(scene->emission_scale == 8.0);
        assert_near(power / expected, 1.0, 0.1);
        scene_destroy(scene);
    }
    texture_set_deinit(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(powers_and_picks),
        cmocka_unit_test(textures_shine_by_place),
        cmocka_unit_test(textured_disks_shine_by_place),
        cmocka_unit_test(one_texel_shines),
        cmocka_unit_test(samples_lie_on_shapes),
        cmocka_unit_test(directions_agree_with_emission),
        cmocka_unit_test(direction_densities_integrate_to_one),
        cmocka_unit_test(hit_equals_sample),
        cmocka_unit_test(spot_falls_off),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

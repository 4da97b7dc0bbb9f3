/* Cameras: field of view by hand, directions and projections inverse of each other,
 * densities that integrate to 1, mirrored and cropped films. */

#include "math/rng.h"
#include "math/warp.h"
#include "scene/camera.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <cmocka.h>

#include "support/near.h"

static struct camera_desc plain(double fov)
{
    return (struct camera_desc){
        .to_world = xform_identity(), .fov = fov, .crop = {0.0, 1.0, 0.0, 1.0}};
}

static struct camera build(const struct camera_desc *desc, int width, int height)
{
    struct camera camera;
    struct err err = {0};
    assert_true(camera_build(desc, width, height, &camera, &err));
    return camera;
}

static void fov_rules(void **state)
{
    (void)state;
    /* 90 degrees: tan of the half is 1; a film of 400 x 200 and of 200 x 400. */
    static const struct {
        enum fov_axis axis;
        double wide_x, tall_x; /* half extent in x */
    } rows[] = {{FOV_SMALLER, 2.0, 1.0},
                {FOV_LARGER, 1.0, 0.5},
                {FOV_X, 1.0, 1.0},
                {FOV_Y, 2.0, 0.5},
                {FOV_DIAGONAL, 0.894427190999915878, 0.447213595499957939}};
    for (size_t i = 0; i < 5; i++) {
        struct camera_desc desc = plain(90.0);
        desc.fov_axis = rows[i].axis;
        struct camera wide = build(&desc, 400, 200), tall = build(&desc, 200, 400);
        assert_near(wide.x0, -rows[i].wide_x, 1e-12);
        assert_near(wide.dx, 2.0 * rows[i].wide_x, 1e-12);
        assert_near(wide.y0, 0.5 * rows[i].wide_x, 1e-12);
        assert_near(wide.dy, -rows[i].wide_x, 1e-12);
        assert_near(tall.x0, -rows[i].tall_x, 1e-12);
        assert_near(tall.y0, 2.0 * rows[i].tall_x, 1e-12);
        assert_near(tall.area, 8.0 * rows[i].tall_x * rows[i].tall_x, 1e-12);
    }
}

/* The last double below 1, and 1 itself, which (x + u) / width may round to. */
static void ends_of_the_film(void **state)
{
    (void)state;
    static const int sizes[][2] = {{1, 1}, {1, 7}, {7, 1}, {1000, 3}};
    static const double ends[] = {WARP_BELOW_ONE, 1.0};
    for (size_t i = 0; i < 4; i++) {
        struct camera_desc desc = plain(60.0);
        int width = sizes[i][0], height = sizes[i][1];
        struct camera camera = build(&desc, width, height);
        const double centre[2] = {0.5, 0.5}, first[2] = {0.0, 0.0};
        struct ray_endpoint lens = camera_sample_lens(&camera, centre);
        struct vec3 w;
        double pdf;
        assert_int_equal(camera_sample_direction(&camera, &lens, first, &w, &pdf), 0);
        for (int j = 0; j < 2; j++) {
            const double last[2] = {ends[j], ends[j]};
            int32_t pixel = camera_sample_direction(&camera, &lens, last, &w, &pdf);
            assert_int_equal(pixel, width * height - 1);
            assert_true(isfinite(pdf) && pdf > 0.0);
        }
    }
}

static void window_and_crop(void **state)
{
    (void)state;
    struct camera_desc desc = plain(90.0);
    desc.has_window = true;
    const double window[4] = {-0.5, 1.5, -1.0, 0.25};
    const double crop[4] = {0.25, 0.5, 0.1, 0.9};
    for (int i = 0; i < 4; i++) {
        desc.window[i] = window[i];
        desc.crop[i] = crop[i];
    }
    struct camera camera = build(&desc, 100, 50);
    assert_int_equal(camera.width, 25);
    assert_int_equal(camera.height, 40);
    assert_near(camera.x0, 0.0, 1e-12);
    assert_near(camera.dx, 0.5, 1e-12);
    assert_near(camera.y0, 0.125, 1e-12);
    assert_near(camera.dy, -1.0, 1e-12);
    assert_near(camera.area, 0.5, 1e-12);
}

/* A part of the film is that part: its rays are those of the whole film there, in the
 * same pixels, and likelier by the ratio of the areas. */
static void crop_is_a_part(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 3, RNG_TEST, 0);
    for (int kind = 0; kind < 2; kind++) {
        struct camera_desc desc = plain(kind ? 0.0 : 70.0);
        desc.extent = kind ? 3.0 : 0.0;
        struct camera whole = build(&desc, 40, 30);
        const double crop[4] = {0.25, 0.75, 0.1, 0.4};
        for (int i = 0; i < 4; i++)
            desc.crop[i] = crop[i];
        struct camera part = build(&desc, 40, 30);
        assert_int_equal(part.crop_x, 10);
        assert_int_equal(part.crop_y, 3);
        assert_int_equal(part.width, 20);
        assert_int_equal(part.height, 9);
        assert_int_equal(part.whole_width, 40);
        assert_int_equal(part.whole_height, 30);
        double parts = (double)(part.width * part.height) / (40.0 * 30.0);
        for (int i = 0; i < 1000; i++) {
            double u[2] = {rng_double(&rng), rng_double(&rng)}, pdf, pdf2, cos;
            double v[2] = {(10.0 + 20.0 * u[0]) / 40.0, (3.0 + 9.0 * u[1]) / 30.0};
            struct ray_endpoint a = camera_sample_lens(&part, u);
            struct ray_endpoint b = camera_sample_lens(&whole, u);
            struct vec3 w, w2;
            int32_t pixel = camera_sample_direction(&part, &a, u, &w, &pdf);
            int32_t same = camera_sample_direction(&whole, &b, v, &w2, &pdf2);
            assert_near(vec3_length(vec3_sub(w, w2)), 0.0, 1e-6);
            assert_near(vec3_length(vec3_sub(a.p, b.p)), 0.0, 1e-6);
            assert_near(pdf * parts / pdf2, 1.0, 1e-6);
            double fx = u[0] * 20.0, fy = u[1] * 9.0;
            if (fmin(fabs(fx - round(fx)), fabs(fy - round(fy))) < 1e-3)
                continue; /* rounding moves it across a border of pixels */
            assert_int_equal((pixel / 20 + 3) * 40 + pixel % 20 + 10, same);
            assert_int_equal(camera_project(&part, &a, w, &pdf, &cos), pixel);
        }
    }
}

/* Row 0 is at the top, column 0 at the left (camera space has +x right, +y up). A
 * mirrored transform mirrors the picture. */
static void orientation(void **state)
{
    (void)state;
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        struct camera_desc desc = plain(60.0);
        double eye[3] = {0.0, 1.0, 6.8}, target[3] = {0.0, 1.0, 0.0},
               up[3] = {0.0, 1.0, 0.0};
        assert_true(xform_look_at(eye, target, up, &desc.to_world));
        struct xform mirror = xform_scale(-1.0, 1.0, 1.0);
        if (mirrored)
            desc.to_world = xform_mul(&desc.to_world, &mirror);
        struct camera camera = build(&desc, 4, 4);
        double corner[2] = {0.0, 0.0}, pdf;
        struct ray_endpoint lens = camera_sample_lens(&camera, corner);
        struct vec3 w;
        assert_int_equal(camera_sample_direction(&camera, &lens, corner, &w, &pdf), 0);
        assert_true(w.y > 0.0f && w.z < 0.0f);
        /* Looking along -z with +y up, pbrt's left-handed space puts -x at the right. */
        assert_true(mirrored ? w.x < 0.0f : w.x > 0.0f);
        double last[2] = {0.999, 0.999};
        assert_int_equal(camera_sample_direction(&camera, &lens, last, &w, &pdf), 15);
        assert_true(w.y < 0.0f);
    }
}

static struct camera_desc tilted(double lens_radius)
{
    struct camera_desc desc = plain(50.0);
    double eye[3] = {1.0, 2.0, -3.0}, target[3] = {0.2, 0.1, 4.0},
           up[3] = {0.1, 1.0, 0.2};
    assert_true(xform_look_at(eye, target, up, &desc.to_world));
    struct xform scale = xform_scale(-2.5, 2.5, 2.5); /* a scaled mirror */
    desc.to_world = xform_mul(&desc.to_world, &scale);
    desc.lens_radius = lens_radius;
    desc.focus_distance = 4.0;
    desc.crop[0] = 0.1;
    desc.crop[3] = 0.8;
    return desc;
}

static void project_inverts_sample(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, 0);
    for (int lens = 0; lens < 2; lens++) {
        struct camera_desc desc = tilted(lens ? 0.3 : 0.0);
        struct camera camera = build(&desc, 640, 360);
        long moved = 0;
        for (int i = 0; i < 20000; i++) {
            double a[2] = {rng_double(&rng), rng_double(&rng)};
            double b[2] = {rng_double(&rng), rng_double(&rng)}, pdf, pdf2, cos;
            struct ray_endpoint at = camera_sample_lens(&camera, a);
            struct vec3 w;
            int32_t pixel = camera_sample_direction(&camera, &at, b, &w, &pdf);
            int32_t back = camera_project(&camera, &at, w, &pdf2, &cos);
            assert_near(vec3_length(w), 1.0, 4e-7);
            /* Only a position within float rounding of a pixel's border may move. */
            double fx = b[0] * camera.width, fy = b[1] * camera.height;
            double border = fmin(fabs(fx - round(fx)), fabs(fy - round(fy)));
            if (back != pixel) {
                moved++;
                assert_true(border < 1e-3);
                continue;
            }
            assert_near(pdf2 / pdf, 1.0, 2e-6);
            assert_near(cos, (double)vec3_dot(w, camera.axes.n), 1e-7);
        }
        assert_true(moved < 20); /* a strip of 1e-4 pixels on either side: some 8 */
    }
}

/* A film of 3 x 1.5 units of the camera, whose x is three times and whose y is half as
 * long in the world. */
static struct camera_desc parallel(double lens_radius)
{
    struct camera_desc desc = tilted(lens_radius);
    desc.fov = 0.0;
    desc.fov_axis = FOV_X;
    desc.extent = 3.0;
    if (lens_radius == 0.0) {
        struct xform stretch = xform_scale(3.0, 0.5, 7.0);
        desc.to_world = xform_mul(&desc.to_world, &stretch);
    }
    return desc;
}

static void parallel_film(void **state)
{
    (void)state;
    struct camera_desc desc = parallel(0.0);
    desc.crop[0] = 0.0;
    desc.crop[3] = 1.0;
    struct camera camera = build(&desc, 40, 20);
    assert_true(camera.orthographic);
    assert_near(camera.dx, 3.0 * 2.5 * 3.0, 1e-6);
    assert_near(-camera.dy, 1.5 * 2.5 * 0.5, 1e-6);
    assert_near(camera.area, camera.dx * -camera.dy, 1e-9);
    struct err err = {0};
    desc.lens_radius = 0.1; /* would be no disk */
    assert_false(camera_build(&desc, 40, 20, &camera, &err));
    desc.lens_radius = 0.0;
    desc.to_world.m[0][1] += 0.3; /* shear */
    assert_false(camera_build(&desc, 40, 20, &camera, &err));
}

/* Rays start on the film's plane; with a lens all of a film position meet on the plane of
 * focus. From anywhere on a ray one finds its start and its pixel again. The density is
 * that of the film seen along the ray. */
static void parallel_rays(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 2, RNG_TEST, 0);
    for (int lens = 0; lens < 2; lens++) {
        struct camera_desc desc = parallel(lens ? 0.3 : 0.0);
        struct camera camera = build(&desc, 64, 36);
        for (int i = 0; i < 2000; i++) {
            double a[2] = {rng_double(&rng), rng_double(&rng)};
            double b[2] = {rng_double(&rng), rng_double(&rng)}, pdf, pdf2, cos;
            struct ray_endpoint at = camera_sample_lens(&camera, a), found;
            struct vec3 along = camera_parallel(&camera, &at), w;
            int32_t pixel = camera_sample_direction(&camera, &at, b, &w, &pdf);
            assert_near(vec3_dot(along, w), 1.0, 1e-6);
            struct vec3 from = vec3_sub(at.p, camera.origin);
            assert_near(vec3_dot(from, camera.axes.n), 0.0, 1e-5);
            double z = (double)vec3_dot(w, camera.axes.n);
            assert_near(pdf * camera.area * z, 1.0, 1e-5);
            double distance = 4.0 / z;
            struct vec3 focus = vec3_mad(from, (float)distance, w);
            double x = camera.x0 + b[0] * camera.dx, y = camera.y0 + b[1] * camera.dy;
            assert_near(vec3_dot(focus, camera.axes.s), x, 1e-5);
            assert_near(vec3_dot(focus, camera.axes.t), y, 1e-5);
            struct vec3 p = vec3_mad(at.p, 2.5f, w);
            assert_true(camera_meet(&camera, w, p, &found));
            assert_near(vec3_length(vec3_sub(found.p, at.p)), 0.0, 1e-5);
            assert_false(camera_meet(&camera, w, vec3_mad(at.p, -1.0f, w), &found));
            double fx = b[0] * camera.width, fy = b[1] * camera.height;
            if (fmin(fabs(fx - round(fx)), fabs(fy - round(fy))) < 1e-3)
                continue; /* rounding moves it across a border of pixels */
            assert_true(camera_meet(&camera, w, p, &found));
            assert_int_equal(camera_project(&camera, &found, w, &pdf2, &cos), pixel);
            assert_near(pdf2 / pdf, 1.0, 1e-6);
            assert_near(cos, z, 1e-6);
        }
    }
}

static void outside_is_refused(void **state)
{
    (void)state;
    struct camera_desc desc = plain(90.0);
    struct camera camera = build(&desc, 10, 10);
    double u[2] = {0.5, 0.5}, pdf, cos;
    struct ray_endpoint lens = camera_sample_lens(&camera, u);
    assert_int_equal(camera_project(&camera, &lens, vec3(0, 0, -1), &pdf, &cos), -1);
    assert_int_equal(camera_project(&camera, &lens, vec3(1, 0, 0), &pdf, &cos), -1);
    assert_int_equal(camera_project(&camera, &lens, vec3(0.8f, 0, 0.6f), &pdf, &cos), -1);
    assert_int_equal(camera_project(&camera, &lens, vec3(0, 0, 1), &pdf, &cos), 55);
}

/* Quadrature of the density over directions in spherical coordinates: by definition, not
 * by the film. The film fills a part of the sphere with a jagged border, hence the
 * tolerance: one cell's share of the border. */
static void density_integrates_to_one(void **state)
{
    (void)state;
    const int nt = 1500, np = 3000;
    for (int lens = 0; lens < 2; lens++) {
        struct camera_desc desc = tilted(lens ? 0.5 : 0.0);
        struct camera camera = build(&desc, 64, 36);
        double u[2] = {0.9, 0.3}, sum = 0.0;
        struct ray_endpoint at = camera_sample_lens(&camera, u);
        for (int i = 0; i < nt; i++)
            for (int j = 0; j < np; j++) {
                /* Only the cone of 60 degrees about the axis can hold the film. */
                double z = 1.0 - 0.5 * (i + 0.5) / nt;
                double phi = 2.0 * MATH_PI * (j + 0.5) / np, r = sqrt(1.0 - z * z);
                struct vec3 local = {(float)(r * cos(phi)), (float)(r * sin(phi)),
                                     (float)z};
                double pdf, cos_axis;
                struct vec3 w = frame_to_world(&camera.axes, local);
                if (camera_project(&camera, &at, w, &pdf, &cos_axis) >= 0)
                    sum += pdf * 0.5 / nt * 2.0 * MATH_PI / np;
            }
        assert_near(sum, 1.0, 1e-3);
    }
}

/* All rays of one film position meet in one point of the focus plane. */
static void lens_focuses(void **state)
{
    (void)state;
    struct camera_desc desc = plain(40.0);
    desc.lens_radius = 0.25;
    desc.focus_distance = 3.0;
    struct camera camera = build(&desc, 16, 16);
    struct rng rng;
    rng_init(&rng, 2, RNG_TEST, 0);
    const double film[2] = {0.3, 0.8};
    double x = 3.0 * (camera.x0 + 0.3 * camera.dx),
           y = 3.0 * (camera.y0 + 0.8 * camera.dy);
    for (int i = 0; i < 1000; i++) {
        double u[2] = {rng_double(&rng), rng_double(&rng)}, pdf;
        struct ray_endpoint at = camera_sample_lens(&camera, u);
        struct vec3 w;
        assert_true(hypot((double)at.p.x, (double)at.p.y) <= 0.25 * (1.0 + 1e-6));
        camera_sample_direction(&camera, &at, film, &w, &pdf);
        struct vec3 focus = vec3_mad(at.p, 3.0f / w.z, w);
        assert_near(focus.x, x, 2e-6);
        assert_near(focus.y, y, 2e-6);
    }
}

static void bad_cameras_are_refused(void **state)
{
    (void)state;
    struct camera camera;
    struct camera_desc bad[7];
    for (int i = 0; i < 7; i++)
        bad[i] = plain(45.0);
    bad[0].fov = 0.0;
    bad[1].fov = 180.0;
    bad[2].fov = (double)NAN;
    bad[3].to_world = xform_scale(1.0, 2.0, 1.0);
    bad[4].lens_radius = 0.1; /* without a focus distance */
    bad[5].crop[1] = 0.0;
    bad[5].crop[3] = 0.5;
    bad[6].lens_radius = -1.0;
    for (int i = 0; i < 7; i++) {
        struct err err = {0};
        assert_false(camera_build(&bad[i], 8, 8, &camera, &err));
        assert_int_equal(err.code, ERR_VALUE);
    }
    struct camera_desc good = plain(45.0);
    struct err err = {0};
    assert_false(camera_build(&good, 0, 8, &camera, &err));
    assert_non_null(strstr(err.message, "0 x 8"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fov_rules),          cmocka_unit_test(ends_of_the_film),
        cmocka_unit_test(window_and_crop),    cmocka_unit_test(orientation),
        cmocka_unit_test(crop_is_a_part),     cmocka_unit_test(parallel_film),
        cmocka_unit_test(parallel_rays),      cmocka_unit_test(project_inverts_sample),
        cmocka_unit_test(outside_is_refused), cmocka_unit_test(density_integrates_to_one),
        cmocka_unit_test(lens_focuses),       cmocka_unit_test(bad_cameras_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

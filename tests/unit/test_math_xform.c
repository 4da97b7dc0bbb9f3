/* Transforms: directions of turning, inverses, normals, what counts as singular. */
#include "math/rng.h"
#include "math/xform.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include <math.h>

static void check_vec(struct vec3 a, float x, float y, float z, float tolerance)
{
    assert_true(fabsf(a.x - x) <= tolerance && fabsf(a.y - y) <= tolerance &&
                fabsf(a.z - z) <= tolerance);
}

/* |(M M^-1 - 1)_ij| against the size of the products that make it up. */
static void check_inverse(const struct xform *x, double tolerance)
{
    for (int i = 0; i < 4; i++) {
        for (int j = 0; j < 4; j++) {
            double sum = 0.0, size = 1.0;
            for (int k = 0; k < 4; k++) {
                sum += x->m[i][k] * x->inv[k][j];
                size += fabs(x->m[i][k] * x->inv[k][j]);
            }
            assert_true(fabs(sum - (i == j)) <= tolerance * size);
        }
    }
}

static void elementary_transforms(void **state)
{
    (void)state;
    struct vec3 p = vec3(1.0f, 2.0f, 3.0f);
    struct xform id = xform_identity(), move = xform_translate(10.0, 20.0, 30.0);
    struct xform grow = xform_scale(2.0, -3.0, 0.5);
    check_vec(xform_point(&id, p), 1.0f, 2.0f, 3.0f, 0.0f);
    check_vec(xform_point(&move, p), 11.0f, 22.0f, 33.0f, 0.0f);
    check_vec(xform_vector(&move, p), 1.0f, 2.0f, 3.0f, 0.0f);
    check_vec(xform_point(&grow, p), 2.0f, -6.0f, 1.5f, 0.0f);
    check_vec(xform_normal(&grow, p), 0.5f, -2.0f / 3.0f, 6.0f, 1e-7f);
    check_inverse(&move, 0.0);
    check_inverse(&grow, 0.0);
}

static void rotations_turn_the_right_way(void **state)
{
    (void)state;
    struct xform z = xform_rotate(90.0, 0.0, 0.0, 7.0);
    struct xform x = xform_rotate(-270.0, 1.0, 0.0, 0.0);
    struct xform y = xform_rotate(450.0, 0.0, 1e-200, 0.0);
    check_vec(xform_point(&z, vec3(1.0f, 0.0f, 0.0f)), 0.0f, 1.0f, 0.0f, 0.0f);
    check_vec(xform_point(&x, vec3(0.0f, 1.0f, 0.0f)), 0.0f, 0.0f, 1.0f, 0.0f);
    check_vec(xform_point(&y, vec3(0.0f, 0.0f, 1.0f)), 1.0f, 0.0f, 0.0f, 0.0f);
    /* A third of a turn about the diagonal goes round the axes. */
    struct xform d = xform_rotate(120.0, 1.0, 1.0, 1.0);
    check_vec(xform_point(&d, vec3(1.0f, 2.0f, 3.0f)), 3.0f, 1.0f, 2.0f, 1e-6f);
    check_inverse(&d, 1e-15);
    struct xform none = xform_rotate(30.0, 0.0, 0.0, 0.0);
    check_vec(xform_point(&none, vec3(1.0f, 2.0f, 3.0f)), 1.0f, 2.0f, 3.0f, 0.0f);
}

static void look_at_is_left_handed_as_pbrt(void **state)
{
    (void)state;
    const double eye[3] = {1.0, 2.0, 3.0}, target[3] = {1.0, 2.0, 13.0};
    const double up[3] = {0.0, 5.0, 1.0};
    struct xform camera;
    assert_true(xform_look_at(eye, target, up, &camera));
    check_vec(xform_point(&camera, vec3(0.0f, 0.0f, 0.0f)), 1.0f, 2.0f, 3.0f, 0.0f);
    check_vec(xform_vector(&camera, vec3(0.0f, 0.0f, 1.0f)), 0.0f, 0.0f, 1.0f, 1e-7f);
    check_vec(xform_vector(&camera, vec3(0.0f, 1.0f, 0.0f)), 0.0f, 1.0f, 0.0f, 1e-7f);
    check_vec(xform_vector(&camera, vec3(1.0f, 0.0f, 0.0f)), 1.0f, 0.0f, 0.0f, 1e-7f);
    check_inverse(&camera, 1e-15);
    /* Looking back, +x of the camera is -x of the world: still right in the image. */
    const double behind[3] = {1.0, 2.0, -7.0};
    assert_true(xform_look_at(eye, behind, up, &camera));
    check_vec(xform_vector(&camera, vec3(1.0f, 0.0f, 0.0f)), -1.0f, 0.0f, 0.0f, 1e-7f);
}

static void look_at_refuses_what_has_no_answer(void **state)
{
    (void)state;
    const double eye[3] = {0.0, 0.0, 0.0}, ahead[3] = {0.0, 0.0, 1.0};
    const double zero[3] = {0.0, 0.0, 0.0}, along[3] = {0.0, 0.0, -3.0};
    const double up[3] = {0.0, 1.0, 0.0}, bad[3] = {(double)NAN, 0.0, 0.0};
    struct xform camera;
    assert_false(xform_look_at(eye, eye, up, &camera));
    assert_false(xform_look_at(eye, ahead, zero, &camera));
    assert_false(xform_look_at(eye, ahead, along, &camera));
    const double nearly[3] = {1e-14, 0.0, 1.0};
    assert_false(xform_look_at(eye, ahead, nearly, &camera));
    assert_false(xform_look_at(bad, ahead, up, &camera));
}

static void random_matrices_invert(void **state)
{
    (void)state;
    struct rng rng;
    rng_init(&rng, 1, RNG_TEST, 0);
    for (int run = 0; run < 1000; run++) {
        bool affine = run % 2 == 0;
        double m[16];
        for (int i = 0; i < 16; i++)
            m[i] = 2.0 * rng_double(&rng) - 1.0;
        if (affine) {
            m[12] = m[13] = m[14] = 0.0;
            m[15] = 1.0;
        }
        struct xform x;
        assert_true(xform_from_matrix(m, &x));
        check_inverse(&x, 1e-13);
        struct xform inverse = xform_inverse(&x), product = xform_mul(&x, &inverse);
        check_inverse(&product, 1e-12);
        struct vec3 p = vec3(0.5f, -0.25f, 0.125f);
        struct vec3 there = xform_point(&x, p);
        if (affine)
            check_vec(xform_point(&inverse, there), p.x, p.y, p.z, 1e-3f);
    }
}

static void product_applies_the_right_one_first(void **state)
{
    (void)state;
    struct xform move = xform_translate(1.0, 0.0, 0.0), grow = xform_scale(2.0, 2.0, 2.0);
    struct xform both = xform_mul(&move, &grow);
    check_vec(xform_point(&both, vec3(1.0f, 1.0f, 1.0f)), 3.0f, 2.0f, 2.0f, 0.0f);
    check_inverse(&both, 0.0);
}

static void singular_means_singular_not_small(void **state)
{
    (void)state;
    const double flat[16] = {1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0, 0, 0, 0, 1};
    const double zero_row[16] = {1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const double nan_entry[16] = {1, 0, 0, 0, 0, 1, 0,           0,
                                  0, 0, 1, 0, 0, 0, (double)NAN, 1};
    const double tiny_far[16] = {1e-6, 0, 0,   1e9, 0, 1e-20, 0, 0,
                                 0,    0, 1e6, 0,   0, 0,     0, 1};
    const double overflow[16] = {1e-320, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const double doubled[16] = {2, 0, 0, 4, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2};
    struct xform x;
    assert_false(xform_from_matrix(flat, &x));
    assert_false(xform_from_matrix(zero_row, &x));
    assert_false(xform_from_matrix(nan_entry, &x));
    assert_false(xform_from_matrix(overflow, &x));
    assert_true(xform_from_matrix(tiny_far, &x));
    check_inverse(&x, 1e-15);
    assert_true(xform_from_matrix(doubled, &x));
    check_vec(xform_point(&x, vec3(1.0f, 1.0f, 1.0f)), 3.0f, 1.0f, 1.0f, 0.0f);
    check_vec(xform_vector(&x, vec3(1.0f, 1.0f, 1.0f)), 1.0f, 1.0f, 1.0f, 0.0f);
}

static void projective_points_are_divided(void **state)
{
    (void)state;
    const double m[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0.5, 0};
    struct xform x;
    assert_false(xform_from_matrix(m, &x)); /* w = z/2 with no constant: singular */
    const double full[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0.5, 0};
    assert_true(xform_from_matrix(full, &x));
    check_inverse(&x, 1e-15);
    check_vec(xform_point(&x, vec3(1.0f, 2.0f, 4.0f)), 0.5f, 1.0f, 0.5f, 0.0f);
}

static void normals_stay_normal(void **state)
{
    (void)state;
    const double shear[16] = {1, 0.7, -0.2, 5, 0, 3, 0.4, 6, 0.1, 0, 0.5, 7, 0, 0, 0, 1};
    struct xform x;
    assert_true(xform_from_matrix(shear, &x));
    struct rng rng;
    rng_init(&rng, 2, RNG_TEST, 0);
    for (int run = 0; run < 1000; run++) {
        struct vec3 a = vec3((float)rng_double(&rng), (float)rng_double(&rng), -0.5f);
        struct vec3 b = vec3(-0.5f, (float)rng_double(&rng), (float)rng_double(&rng));
        struct vec3 n = vec3_cross(a, b), mapped = xform_normal(&x, n);
        float size = vec3_length(mapped) * vec3_length(xform_vector(&x, a));
        assert_true(fabsf(vec3_dot(mapped, xform_vector(&x, a))) <= 1e-6f * size);
    }
}

static void similarities_are_told_from_the_rest(void **state)
{
    (void)state;
    struct xform turn = xform_rotate(33.0, 1.0, -2.0, 0.5);
    struct xform sizes[3] = {xform_scale(1e-6, 1e-6, 1e-6), xform_scale(-1e6, 1e6, 1e6),
                             xform_scale(2.0, 2.0, 2.0 * 1.0002)};
    double scale = 0.0;
    for (int i = 0; i < 2; i++) {
        struct xform x = xform_mul(&turn, &sizes[i]);
        assert_true(xform_is_similarity(&x, &scale));
        assert_true(fabs(scale / (i == 0 ? 1e-6 : 1e6) - 1.0) < 1e-12);
        assert_int_equal(xform_swaps_handedness(&x), i == 1);
    }
    struct xform stretched = xform_mul(&turn, &sizes[2]);
    assert_false(xform_is_similarity(&stretched, &scale));
    const double shear[16] = {1, 0.001, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    struct xform x;
    assert_true(xform_from_matrix(shear, &x));
    assert_false(xform_is_similarity(&x, &scale));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(elementary_transforms),
        cmocka_unit_test(rotations_turn_the_right_way),
        cmocka_unit_test(look_at_is_left_handed_as_pbrt),
        cmocka_unit_test(look_at_refuses_what_has_no_answer),
        cmocka_unit_test(random_matrices_invert),
        cmocka_unit_test(product_applies_the_right_one_first),
        cmocka_unit_test(singular_means_singular_not_small),
        cmocka_unit_test(projective_points_are_divided),
        cmocka_unit_test(normals_stay_normal),
        cmocka_unit_test(similarities_are_told_from_the_rest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

/* import/spectrum: against what is known of white, of black bodies and of single lines.
 */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "import/spectrum.h"
#include "support/import_test.h"

/* The primaries' matrix sends D65's XYZ to white, within its own digits. */
static void test_xyz(void **state)
{
    (void)state;
    struct rgb white = spectrum_from_xyz(0.950456, 1.0, 1.089058);
    import_test_near(white.r, 1.0, 5e-4);
    import_test_near(white.g, 1.0, 5e-4);
    import_test_near(white.b, 1.0, 5e-4);
}

/* An equal-energy spectrum has X = Y = Z = 1 (the fit errs by less than 1 %). */
static void test_constant(void **state)
{
    static const double pairs[] = {400.0, 2.0, 700.0, 2.0};
    struct rgb c;
    (void)state;
    assert_true(spectrum_from_pairs(pairs, 2, &c));
    import_test_near(c.r, 2.0 * 1.204794, 0.03);
    import_test_near(c.g, 2.0 * 0.948291, 0.03);
    import_test_near(c.b, 2.0 * 0.908916, 0.03);
    assert_true(spectrum_from_pairs(pairs, 1, &c));
    import_test_near(c.g, 2.0 * 0.948291, 0.03);
}

/* Interpolated: half of a ramp is the mean of what bounds it, by linearity. */
static void test_linear(void **state)
{
    static const double low[] = {300.0, 0.0, 900.0, 3.0},
                        high[] = {300.0, 2.0, 900.0, 5.0};
    static const double middle[] = {300.0, 1.0, 500.0, 2.0, 600.0, 2.5, 900.0, 4.0};
    struct rgb a, b, c;
    (void)state;
    assert_true(spectrum_from_pairs(low, 2, &a) && spectrum_from_pairs(high, 2, &b));
    assert_true(spectrum_from_pairs(middle, 4, &c));
    import_test_near(c.r, 0.5 * (a.r + b.r), 1e-12);
    import_test_near(c.g, 0.5 * (a.g + b.g), 1e-12);
    import_test_near(c.b, 0.5 * (a.b + b.b), 1e-12);
}

/* Lines have their colours: 450 nm blue, 530 green, 620 red. */
static void test_lines(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++) {
        static const double centre[] = {620.0, 530.0, 450.0};
        double l = centre[i];
        double pairs[] = {l - 2.0, 0.0, l - 1.0, 1.0, l + 1.0, 1.0, l + 2.0, 0.0};
        struct rgb c;
        assert_true(spectrum_from_pairs(pairs, 4, &c));
        double v[3] = {c.r, c.g, c.b};
        assert_true(v[i] > 0.0 && v[i] > 2.0 * v[(i + 1) % 3] &&
                    v[i] > 2.0 * v[(i + 2) % 3]);
    }
}

/* 6500 K is near white; 2000 K is red, 20000 K blue; the peak is 1, so none exceeds 1.3.
 */
static void test_blackbody(void **state)
{
    (void)state;
    struct rgb day = spectrum_from_blackbody(6500.0);
    assert_true(fabs(day.r / day.g - 1.0) < 0.06 && fabs(day.b / day.g - 1.0) < 0.06);
    struct rgb ember = spectrum_from_blackbody(2000.0);
    assert_true(ember.r > 2.0 * ember.g && ember.g > 2.0 * fmax(ember.b, 0.0));
    struct rgb sky = spectrum_from_blackbody(20000.0);
    assert_true(sky.b > sky.g && sky.g > sky.r);
    assert_true(rgb_max(day) < 1.3 && rgb_is_black(spectrum_from_blackbody(0.0)));
}

static void test_bad_pairs(void **state)
{
    static const double falling[] = {500.0, 1.0, 400.0, 1.0};
    static const double standing[] = {500.0, 1.0, 500.0, 1.0};
    struct rgb c;
    (void)state;
    assert_false(spectrum_from_pairs(falling, 2, &c));
    assert_false(spectrum_from_pairs(standing, 2, &c));
    assert_false(spectrum_from_pairs(standing, 0, &c));
}

static void test_file(void **state)
{
    struct place at = {"scene.pbrt", 3, 4};
    struct rgb c;
    (void)state;
    struct err good = {0}, odd = {0}, word = {0};
    const char *path = import_test_write("a.spd",
                                         "# made by a test\n400 1\n700, 1 # end\n");
    assert_true(import_test_spectrum(path, &at, &c, &good));
    import_test_near(c.g, 0.948291, 0.015);
    path = import_test_write("b.spd", "400 1 700");
    assert_false(import_test_spectrum(path, &at, &c, &odd));
    import_test_error_is(&odd, "scene.pbrt:3:4: ");
    path = import_test_write("c.spd", "400 one");
    assert_false(import_test_spectrum(path, &at, &c, &word));
    import_test_error_is(&word, "is not a list of pairs");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_xyz),       cmocka_unit_test(test_constant),
        cmocka_unit_test(test_linear),    cmocka_unit_test(test_lines),
        cmocka_unit_test(test_blackbody), cmocka_unit_test(test_bad_pairs),
        cmocka_unit_test(test_file),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

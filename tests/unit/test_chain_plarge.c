/* The rule: Zsolnai's Table 1 from its own statistics, every branch, and the interval. */

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "chain/plarge.h"
#include "math/student.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static struct statistics certain(double eta_l, double eta_s, double eta_0)
{
    double r = eta_0 > 0.0 ? eta_l / eta_0 : 0.0;
    return (struct statistics){.eta_s = eta_s,
                               .eta_l = eta_l,
                               .eta_0 = eta_0,
                               .r = r,
                               .r_lo = r,
                               .r_hi = r,
                               .q = eta_l / eta_s,
                               .q_freedom = 255.0,
                               .r_freedom = 255.0,
                               .small = 1000,
                               .large = 1000};
}

static void table_1(void **state)
{
    (void)state;
    /* Printed to two digits; LuxTime's formula gives .964 where .95 is printed. */
    const struct {
        const char *scene;
        double eta_l, eta_s, eta_0;
        double p_l, printed; /* the formula's and the paper's */
    } rows[] = {
        {"LuxTime", 0.377, 0.783, 0.985, 0.964, 0.95},
        {"Spheres", 0.005, 0.394, 0.487, 0.25, 0.25},
        {"Chess Day", 0.061, 0.641, 0.886, 0.25, 0.25},
        {"Cherry", 0.126, 0.487, 0.911, 0.67, 0.67},
        {"Cornell", 0.004, 0.438, 0.022, 0.50, 0.50},
        {"Glass Ball", 0.088, 0.489, 0.87, 0.61, 0.61},
    };
    printf("%-10s %6s %6s %6s %7s %7s %8s\n", "scene", "eta_l", "eta_s", "eta_0", "r",
           "p_l", "printed");
    for (int i = 0; i < 6; i++) {
        struct statistics s = certain(rows[i].eta_l, rows[i].eta_s, rows[i].eta_0);
        struct plarge p = plarge_zsolnai2013(&s);
        printf("%-10s %6.3f %6.3f %6.3f %7.4f %7.4f %8.2f\n", rows[i].scene, s.eta_l,
               s.eta_s, s.eta_0, s.r, p.p_l, rows[i].printed);
        assert_true(fabs(p.p_l - rows[i].p_l) < (i == 0 ? 0.0005 : 0.005));
        assert_int_equal(fabs(p.p_l - rows[i].printed) < 0.005, i != 0);
        assert_int_equal(p.branch, rows[i].p_l == 0.25 ? PLARGE_PEAKED : PLARGE_FLAT);
        assert_false(p.unsure);
        assert_true(fabs(p.p_l_lo - p.p_l) < 1e-15 && fabs(p.p_l_hi - p.p_l) < 1e-15);
    }
    struct statistics cornell = certain(0.004, 0.438, 0.022);
    assert_true(fabs(plarge_zsolnai2013(&cornell).p_l - 0.438 / (2 * 0.434)) < 1e-15);
}

static void one_where_the_formula_leaves_the_range(void **state)
{
    (void)state;
    const double pairs[][2] = {{0.5, 0.9}, {0.5, 0.5}, {0.6, 0.5}, {0.2, 0.0}};
    for (int i = 0; i < 4; i++) {
        struct statistics s = certain(pairs[i][0], pairs[i][1], 1.0);
        struct plarge p = plarge_zsolnai2013(&s);
        assert_int_equal(p.branch, PLARGE_FLAT_ONE);
        assert_true(p.p_l == 1.0 && p.p_l_lo <= 1.0 && p.p_l_hi == 1.0);
        assert_non_null(strstr(p.reason, "not below 1"));
    }
    struct statistics edge = certain(0.25, 0.5, 1.0);
    assert_int_equal(plarge_zsolnai2013(&edge).branch, PLARGE_FLAT);
    assert_true(plarge_zsolnai2013(&edge).p_l == 1.0);
}

static void threshold_belongs_to_the_flat_branch(void **state)
{
    (void)state;
    struct statistics s = certain(0.1, 0.5, 1.0);
    assert_int_equal(plarge_zsolnai2013(&s).branch, PLARGE_FLAT);
    s = certain(0.0999, 0.5, 1.0);
    assert_int_equal(plarge_zsolnai2013(&s).branch, PLARGE_PEAKED);
}

static void dark_scene(void **state)
{
    (void)state;
    struct statistics s = certain(0.0, 0.0, 0.0);
    s.r_hi = 1.0;
    s.eta_s_se = s.eta_l_se = s.q_se = HUGE_VAL;
    struct plarge p = plarge_zsolnai2013(&s);
    assert_int_equal(p.branch, PLARGE_DARK);
    assert_false(p.unsure);
    assert_true(p.p_l == 0.5 && p.p_l_lo == 0.25 && p.p_l_hi == 1.0 && p.p_l_se == 0.0);
    assert_non_null(strstr(p.reason, "1000 large steps"));
}

/* The interval is that of q = eta_l/eta_s by Student's law, sent through the rule; the
 * standard error is to first order that of the delta method. */
static void interval_from_standard_errors(void **state)
{
    (void)state;
    struct statistics s = certain(0.126, 0.487, 0.911);
    s.q_se = 0.006;
    s.q_freedom = 20.0;
    struct plarge p = plarge_zsolnai2013(&s);
    double q = 0.126 / 0.487, half = 0.006 * student_quantile(0.995, 20.0);
    assert_true(fabs(p.p_l_lo - 0.5 / (1.0 - (q - half))) < 1e-14);
    assert_true(fabs(p.p_l_hi - 0.5 / (1.0 - (q + half))) < 1e-14);
    assert_true(p.p_l_lo < p.p_l && p.p_l < p.p_l_hi);
    double slope = 0.5 / ((1.0 - q) * (1.0 - q));
    assert_true(fabs(p.p_l_se / (0.006 * slope) - 1.0) < 0.01);
    assert_true(p.p_l_freedom == 20.0);

    s.q_se = 0.2;
    p = plarge_zsolnai2013(&s);
    assert_true(p.p_l_lo == 0.5 && p.p_l_hi == 1.0);
    s.q_se = HUGE_VAL;
    p = plarge_zsolnai2013(&s);
    assert_true(p.p_l_lo == 0.5 && p.p_l_hi == 1.0);
}

static void unsure_spans_both_branches(void **state)
{
    (void)state;
    struct statistics s = certain(0.088, 0.489, 0.87);
    s.r_lo = 0.09;
    s.r_hi = 0.12;
    struct plarge p = plarge_zsolnai2013(&s);
    assert_true(p.unsure);
    assert_int_equal(p.branch, PLARGE_FLAT);
    assert_true(p.p_l_lo == 0.25 && p.p_l_hi >= p.p_l);
    assert_true(p.p_l_se == 0.5 * (p.p_l_hi - p.p_l_lo));
    assert_non_null(strstr(p.reason, "unsure"));

    s = certain(0.08, 0.489, 0.87);
    s.r_lo = 0.08;
    s.r_hi = 0.11;
    p = plarge_zsolnai2013(&s);
    assert_true(p.unsure && p.p_l == 0.25);
    assert_true(p.p_l_lo == 0.25 && fabs(p.p_l_hi - 0.489 / (2 * 0.409)) < 1e-14);
}

static void reason_states_branch_figures_and_interval(void **state)
{
    (void)state;
    struct statistics s = certain(0.126, 0.487, 0.911);
    s.r_lo = 0.125;
    s.r_hi = 0.155;
    struct plarge p = plarge_zsolnai2013(&s);
    assert_string_equal(
        p.reason, "r = eta_l/eta_0 = 0.1383 in [0.125, 0.155] is at least 0.1: flat "
                  "integrand, p_l = eta_s/(2(eta_s-eta_l)) = 0.675 with eta_s = "
                  "0.487, eta_l = 0.126 (99 %: [0.675, 0.675])");
    s = certain(0.005, 0.394, 0.487);
    p = plarge_zsolnai2013(&s);
    assert_string_equal(p.reason,
                        "r = eta_l/eta_0 = 0.01027 in [0.01027, 0.01027] is below "
                        "0.1: peaked integrand, p_l = 0.25 (99 %: [0.250, 0.250])");
}

/* Per counted state eta_s and eta_l are divided by the shares that do not fail; r is what
 * it was. */
static void counted_by_hand(void **state)
{
    (void)state;
    struct statistics s = certain(0.1, 0.45, 0.5);
    s.z_small = 0.9;
    /* eta_s' = .5, eta_l' = .2, r = .2: .5/(2 (.5 - .2)) */
    assert_true(fabs(plarge_counted(&s) - 5.0 / 6.0) < 1e-15);
    assert_true(fabs(plarge_zsolnai2013(&s).p_l - 0.45 / 0.7) < 1e-15);
    s.z_small = 1.0;
    s.eta_0 = s.r = 0.1; /* eta_l' = 1 is above eta_s' */
    assert_true(plarge_counted(&s) == 1.0);
    s = certain(0.04, 0.45, 0.5); /* r below the threshold: peaked either way */
    s.z_small = 0.5;
    assert_true(plarge_counted(&s) == 0.25);
    /* Without failures it is the rule itself. */
    s = certain(0.2, 0.9, 1.0);
    s.z_small = 1.0;
    assert_true(plarge_counted(&s) == plarge_zsolnai2013(&s).p_l);
}

static void counted_without_a_state(void **state)
{
    (void)state;
    struct statistics s = certain(0.1, 0.45, 0.5);
    assert_true(isnan(plarge_counted(&s))); /* z_small = 0 */
    s = certain(0.0, 0.45, 0.0);
    s.z_small = 0.5;
    assert_true(isnan(plarge_counted(&s)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(table_1),
        cmocka_unit_test(one_where_the_formula_leaves_the_range),
        cmocka_unit_test(threshold_belongs_to_the_flat_branch),
        cmocka_unit_test(dark_scene),
        cmocka_unit_test(interval_from_standard_errors),
        cmocka_unit_test(unsure_spans_both_branches),
        cmocka_unit_test(reason_states_branch_figures_and_interval),
        cmocka_unit_test(counted_by_hand),
        cmocka_unit_test(counted_without_a_state),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

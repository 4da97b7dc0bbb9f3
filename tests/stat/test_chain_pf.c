/* Which density each step keeps: counted and exact the target f; paper f Z, with Z(x) the
 * probability that a proposal from x does not fail. Chains start from exact samples of
 * the one or of the other: a step must keep its own density and must leave the other, so
 * a chain that stood still would be seen too. False-alarm rate of this file: 1e-3. */

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/pf_toy.h"
#include "support/stat_test.h"

#include <gsl/gsl_randist.h>

#define REPLICATES 12000
#define STEPS      25
#define LEVEL      stat_sidak(1e-3, 32)
#define SEEN       1e-9 /* what the p-value of a wrong density must lie below */
#define MAX_CELLS  256

enum law { LAW_F, LAW_FZ, LAWS };

/* Cells whose counts are compared, and what is expected there of each law. */
struct table {
    int cells;
    double expected[LAWS][MAX_CELLS];
    int (*cell)(const struct pf_toy *toy, const double *x, long replicate);
};

static const double heights[] = {0, 3, 3, 0,  1, 0, 0, 5,   .5, .5,
                                 0, 0, 2, .2, 2, 0, 0, .05, 4,  0};
static const double edges[] = {0,       0,        0,       1. / 16,  2. / 16,  4. / 16,
                               6. / 16, 8. / 16,  9. / 16, 11. / 16, 13. / 16, 14. / 16,
                               0.,      15. / 16, 8. / 16, 8. / 16};

static void normalise(struct table *t)
{
    for (int law = 0; law < LAWS; law++) {
        double sum = 0.0;
        for (int i = 0; i < t->cells; i++)
            sum += t->expected[law][i];
        for (int i = 0; i < t->cells; i++)
            t->expected[law][i] *= REPLICATES / sum;
    }
}

#define ISLAND_SPLIT 3

static int island_cell(const struct pf_toy *toy, const double *x, long replicate)
{
    (void)replicate;
    return (int)(ISLAND_SPLIT * toy->pixels * x[0]);
}

/* Midpoints; f is constant in a cell, and Z smooth. */
static void islands_expect(const struct pf_toy *toy, double p_large, struct table *t)
{
    enum { POINTS = 64 };
    t->cells = ISLAND_SPLIT * toy->pixels;
    t->cell = island_cell;
    for (int i = 0; i < t->cells * POINTS; i++) {
        double x = (i + 0.5) / (t->cells * POINTS), f = pf_density(toy, &x);
        t->expected[LAW_F][i / POINTS] += f;
        t->expected[LAW_FZ][i / POINTS] += f * pf_z(toy, &x, p_large);
    }
    normalise(t);
}

static int penumbra_cell(const struct pf_toy *toy, const double *x, long replicate)
{
    (void)replicate;
    return pf_pixel(toy, x[0]) * 16 + (int)(16 * x[1]);
}

static void penumbra_expect(const struct pf_toy *toy, double p_large, struct table *t)
{
    enum { POINTS = 16, SIDE = 16 * POINTS };
    t->cells = 256;
    t->cell = penumbra_cell;
    for (int i = 0; i < SIDE * SIDE; i++) {
        double x[] = {(i / SIDE + 0.5) / SIDE, (i % SIDE + 0.5) / SIDE};
        double f = pf_density(toy, x);
        int cell = penumbra_cell(toy, x, 0);
        t->expected[LAW_F][cell] += f;
        if (f > 0.0)
            t->expected[LAW_FZ][cell] += f * pf_z(toy, x, p_large);
    }
    normalise(t);
}

#define BOX_CELLS 9             /* of one number */
#define BOX_NEAR  9             /* classes of how many others are near an edge */
#define BOX_RIM   (PF_BOX / 18) /* what is near */

static bool near_edge(double x)
{
    return x < BOX_RIM || x >= PF_BOX - BOX_RIM;
}

/* One number, in turn an early, a middle and the last one; and how many others are near
 * an edge, where Z falls. */
static int box_cell(const struct pf_toy *toy, const double *x, long replicate)
{
    int which = (int)(replicate % 3), i = which * (toy->dims - 1) / 2, near = 0;
    for (int j = 0; j < toy->dims; j++)
        near += j != i && near_edge(x[j]);
    near = near < BOX_NEAR ? near : BOX_NEAR - 1;
    return (which * BOX_CELLS + (int)(x[i] * (BOX_CELLS / PF_BOX))) * BOX_NEAR + near;
}

/* Of one number alone, under a density g: its integral, that over each cell and that near
 * an edge. */
struct factor_law {
    double all, cells[BOX_CELLS], near;
};

static void factor_add(struct factor_law *g, double x, double value)
{
    g->all += value;
    g->cells[(int)(x * (BOX_CELLS / PF_BOX))] += value;
    g->near += near_edge(x) ? value : 0.0;
}

/* `weight` times what the product of g over all numbers gives to each cell. */
static void box_add(const struct pf_toy *toy, const struct factor_law *g, double weight,
                    double *expected)
{
    unsigned others = (unsigned)toy->dims - 1;
    for (int i = 0; i < 3 * BOX_CELLS * BOX_NEAR; i++) {
        unsigned near = (unsigned)(i % BOX_NEAR);
        double q = g->near / g->all, cell = g->cells[i / BOX_NEAR % BOX_CELLS];
        double share = near < BOX_NEAR - 1 ? gsl_ran_binomial_pdf(near, q, others)
                                           : gsl_cdf_binomial_Q(near - 1, q, others);
        expected[i] += weight * cell * share;
    }
}

/* f Z is a sum of two products over the numbers: p_l eta_0 prod g and (1-p_l) prod g z.
 */
static void box_expect(const struct pf_toy *toy, double p_large, struct table *t)
{
    enum { POINTS = 128 };
    struct factor_law g = {0}, gz = {0};
    for (int i = 0; i < BOX_CELLS * POINTS; i++) {
        double x = (i + 0.5) * PF_BOX / (BOX_CELLS * POINTS);
        double factor = pf_box_factor(toy, &x, 0);
        factor_add(&g, x, factor);
        factor_add(&gz, x, factor * pf_mass(x, toy->sigma, 0.0, PF_BOX));
    }
    t->cells = 3 * BOX_CELLS * BOX_NEAR;
    t->cell = box_cell;
    box_add(toy, &g, 1.0, t->expected[LAW_F]);
    box_add(toy, &g, p_large * toy->eta_0, t->expected[LAW_FZ]);
    box_add(toy, &gz, (1.0 - p_large) * pow(gz.all / g.all, toy->dims - 1),
            t->expected[LAW_FZ]);
    normalise(t);
}

struct mode {
    const char *name;
    const struct step_type *step;
    int second_stage; /* of the kernel */
    enum law law;
};

/* A second step a tenth as wide moves so little that an error in its acceptance hardly
 * shows beside what first steps do; one as wide as the first shows it. */

static const struct mode modes[] = {
    {"counted", &step_mh, KERNEL_SECOND_STAGE, LAW_F},
    {"exact", &step_pf_exact, KERNEL_SECOND_STAGE, LAW_F},
    {"exact, wide", &step_pf_exact, 1, LAW_F},
    {"paper", &step_pf_paper, KERNEL_SECOND_STAGE, LAW_FZ},
};

#define MODES ((int)(sizeof modes / sizeof *modes))

/* What the chain has made of states: paper's law is that of these, while after a number
 * of paths it stands where counted does. */
static int64_t states(const struct tally *t)
{
    return t->proposed[MOVE_SMALL] + t->proposed[MOVE_LARGE] - t->excluded;
}

/* Counts after STEPS states from samples of `from`. */
static void run(const struct pf_toy *toy, double p_large, const struct mode *mode,
                enum law from, const struct table *t, double *counts)
{
    struct chain chain;
    struct film_sinks films;
    film_sinks_create(&films, toy->pixels, ESTIMATOR_KELEMEN, false);
    struct chain_params params = {p_large, 1.0, ESTIMATOR_KELEMEN};
    struct target target = {pf_eval, (void *)(uintptr_t)toy};
    pf_chain_init(&chain, toy, mode->second_stage);
    for (long r = 0; r < REPLICATES; r++) {
        double x[PF_MAX_DIMS];
        rng_init(&chain.rng, 41, RNG_TEST, (uint64_t)r);
        if (from == LAW_F)
            pf_sample(toy, &chain.rng, x);
        else
            pf_sample_biased(toy, p_large, &chain.rng, x);
        pf_start(&chain, toy, x);
        while (states(&chain.tally) < STEPS)
            mode->step->advance(&chain, &params, &target, &films.sinks, 1);
        pf_state(&chain, toy, x);
        counts[t->cell(toy, x, r)]++;
    }
    chain_deinit(&chain);
    film_sinks_destroy(&films);
}

static void check(const char *name, const struct pf_toy *toy, double p_large,
                  void (*expect)(const struct pf_toy *, double, struct table *))
{
    static struct table t;
    t = (struct table){0};
    expect(toy, p_large, &t);
    for (int m = 0; m < MODES; m++) {
        char what[80];
        enum law own = modes[m].law, other = own == LAW_F ? LAW_FZ : LAW_F;
        double kept[MAX_CELLS] = {0}, left[MAX_CELLS] = {0};
        run(toy, p_large, &modes[m], own, &t, kept);
        run(toy, p_large, &modes[m], other, &t, left);
        double p_own = stat_chi2_p(kept, t.expected[own], t.cells);
        double p_other = stat_chi2_p(kept, t.expected[other], t.cells);
        double p_left = stat_chi2_p(left, t.expected[other], t.cells);
        snprintf(what, sizeof what, "%s, p_l %g, %s", name, p_large, modes[m].name);
        print_message(
            "%-26s keeps %-2s p = %-8.3g and not %-2s p = %-8.3g which it leaves "
            "p = %.3g\n",
            what, own == LAW_F ? "f" : "fZ", p_own, own == LAW_F ? "fZ" : "f", p_other,
            p_left);
        assert_true(stat_ok(what, p_own, LEVEL));
        assert_true(p_other < SEEN && p_left < SEEN);
    }
}

static void islands(void **state)
{
    (void)state;
    struct pf_toy toy = pf_islands(0.04, heights, 20);
    check("islands", &toy, 0.05, islands_expect);
    check("islands", &toy, 0.3, islands_expect);
}

static void penumbra(void **state)
{
    (void)state;
    struct pf_toy toy = pf_penumbra(0.04, edges, 16);
    check("penumbra", &toy, 0.05, penumbra_expect);
    check("penumbra", &toy, 0.3, penumbra_expect);
}

static void box(void **state)
{
    (void)state;
    struct pf_toy box8 = pf_box(0.06, 8), box20 = pf_box(0.04, 20),
                  box40 = pf_box(0.03, 40);
    check("box of 8", &box8, 0.05, box_expect);
    check("box of 8", &box8, 0.3, box_expect);
    check("box of 20", &box20, 0.05, box_expect);
    check("box of 40", &box40, 0.05, box_expect);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(islands),
        cmocka_unit_test(penumbra),
        cmocka_unit_test(box),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

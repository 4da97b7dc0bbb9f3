/* eta_s, eta_l, eta_0 and b against their exact values, and their standard errors by the
 * share of intervals that hold these. False-alarm rate of this file: 1e-3. */

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "chain/startup.h"
#include "math/student.h"
#include "support/stat_test.h"
#include "support/toy_target.h"

#define CHAINS     48
#define MUTATIONS  200
#define REPLICATES 1000
#define LEVEL      stat_sidak(1e-3, 2 * 11)

struct exact {
    double eta_s, eta_l, eta_0, b;
};

/* The toy of one number: target c_i on cell i of width w. For a displacement |d| < w the
 * mean of min(I(x), I(x+d)) is linear in |d|, so that E|d| is all that eta_s asks for. */
static struct exact exact_values(const struct kernel *k)
{
    double w = 1.0 / TOY_CELLS, mean_step = k->type == &kernel_gaussian
                                                ? k->sigma * sqrt(2.0 / TOY_PI)
                                                : (k->s2 - k->s1) / k->log_ratio;
    struct exact e = {.b = toy_integral()};
    for (int i = 0; i < TOY_CELLS; i++) {
        double here = toy_cell(i), next = toy_cell((i + 1) % TOY_CELLS);
        e.eta_s += (here * (w - mean_step) + fmin(here, next) * mean_step) / e.b;
        e.eta_0 += here > 0.0 ? w : 0.0;
        for (int j = 0; j < TOY_CELLS; j++)
            e.eta_l += w * w * fmin(here, toy_cell(j)) / e.b;
    }
    return e;
}

static void measure(struct chain *chain, uint64_t replicate, struct statistics *s,
                    struct tally *sum)
{
    static const struct toy toy = {1};
    struct target target = {toy_eval, (void *)(uintptr_t)&toy};
    struct film_sinks films;
    film_sinks_create(&films, TOY_CELLS, ESTIMATOR_KELEMEN, false);
    struct chain_params params = {0.5, 1.0, ESTIMATOR_KELEMEN};
    struct tally tallies[CHAINS];
    *sum = (struct tally){0};
    for (int c = 0; c < CHAINS; c++) {
        toy_start(chain, &toy, 51, replicate * CHAINS + (uint64_t)c);
        step_mh.advance(chain, &params, &target, &films.sinks, MUTATIONS);
        tallies[c] = chain->tally;
        tally_add(sum, &tallies[c]);
    }
    statistics_measure(&(struct statistics_part){.tallies = tallies, .chains = CHAINS}, 1,
                       s);
    film_sinks_destroy(&films);
}

/* Collects what replicates say of one figure: its error, and whether the 99 % interval
 * holds the truth. */
struct figure {
    double errors[REPLICATES];
    long held;
};

static void note(struct figure *f, int r, double estimate, double se, double freedom,
                 double exact)
{
    double quantile = student_quantile(0.5 * (1.0 + 0.99), freedom);
    f->errors[r] = estimate - exact;
    f->held += fabs(estimate - exact) <= quantile * se;
}

static void judge(const char *what, const struct figure *f)
{
    assert_true(stat_ok(what, stat_mean_p(f->errors, REPLICATES, 0.0), LEVEL));
    assert_true(stat_ok(what, stat_binomial_p(f->held, REPLICATES, 0.99), LEVEL));
}

static void check(const struct kernel_type *type)
{
    static struct figure s, l, zero, r, q, b;
    s.held = l.held = zero.held = r.held = q.held = 0;
    struct chain chain;
    toy_chain_init(&chain, type);
    struct exact e = exact_values(&pss_of(&chain)->kernel);
    for (int i = 0; i < REPLICATES; i++) {
        struct statistics m;
        struct tally sum;
        measure(&chain, (uint64_t)i, &m, &sum);
        double ratio = e.eta_l / e.eta_0, decides = e.eta_l / e.eta_s;
        note(&s, i, m.eta_s, m.eta_s_se, m.eta_s_freedom, e.eta_s);
        note(&l, i, m.eta_l, m.eta_l_se, m.eta_l_freedom, e.eta_l);
        note(&zero, i, m.eta_0, m.eta_0_se, m.eta_0_freedom, e.eta_0);
        note(&r, i, m.r, m.r_se, m.r_freedom, ratio);
        note(&q, i, m.q, m.q_se, m.q_freedom, decides);
        assert_true(m.r_lo <= m.r && m.r <= m.r_hi);
        b.errors[i] = sum.large_sum - e.b * (double)sum.proposed[MOVE_LARGE];
        /* Moves are counted once each. */
        assert_int_equal(m.small + m.large, (long)CHAINS * MUTATIONS);
    }
    judge("eta_s", &s);
    judge("eta_l", &l);
    judge("eta_0", &zero);
    judge("r", &r);
    judge("q", &q);
    assert_true(stat_ok("b", stat_mean_p(b.errors, REPLICATES, 0.0), LEVEL));
    chain_deinit(&chain);
}

static void exponential(void **state)
{
    (void)state;
    check(&kernel_exponential);
}

static void gaussian(void **state)
{
    (void)state;
    check(&kernel_gaussian);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exponential),
        cmocka_unit_test(gaussian),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

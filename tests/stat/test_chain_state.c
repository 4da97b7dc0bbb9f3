/* The chain's code on a state that is no list of numbers: a point of the plane, with a
 * move whose transition density is not symmetric. Chains that start from exact samples
 * must keep their law, by mh and by delayed rejection, and their splats must give it.
 *
 * False-alarm rate of this file: 1e-3. Power: the same tests reject, with p < SEEN, a log
 * ratio that is left out, one that is a quarter too small, and second stages without the
 * density of the first (faults below). */

#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>

#include "chain/startup.h"
#include "support/film_sinks.h"
#include "support/stat_test.h"

#include <string.h>

#define SIDE       8
#define CELLS      (SIDE * SIDE)
#define REPLICATES 60000
#define STEPS      20
#define LEVEL      stat_sidak(1e-3, 5)
#define SEEN       1e-9

/* --- the target: a Gaussian of the unit square, 0 beyond ---------------------------- */

static const double centre[2] = {0.35, 0.6};
#define SPREAD 0.25

static double density(const double x[2])
{
    double square = 0.0;
    for (int i = 0; i < 2; i++) {
        if (!(x[i] > 0.0 && x[i] < 1.0))
            return 0.0;
        square += (x[i] - centre[i]) * (x[i] - centre[i]);
    }
    return exp(-0.5 * square / (SPREAD * SPREAD));
}

/* Integral of the density's factor of coordinate i over the j-th stripe. */
static double stripe(int i, int j)
{
    double scale = 1.0 / (sqrt(2.0) * SPREAD);
    double a = (j / (double)SIDE - centre[i]) * scale;
    double b = ((j + 1) / (double)SIDE - centre[i]) * scale;
    return SPREAD * sqrt(0.5 * M_PI) * (erf(b) - erf(a));
}

static double cell_mass(int cell)
{
    return stripe(0, cell % SIDE) * stripe(1, cell / SIDE);
}

static double whole_mass(void)
{
    double sum = 0.0;
    for (int i = 0; i < CELLS; i++)
        sum += cell_mass(i);
    return sum;
}

static int cell_of(const double x[2])
{
    return (int)(SIDE * x[1]) * SIDE + (int)(SIDE * x[0]);
}

static void fill(const double x[2], struct contrib *out)
{
    double f = density(x);
    contrib_clear(out);
    if (!(f > 0.0))
        return;
    contrib_add(out, cell_of(x), (struct rgb){f, f, f}, 0, 0);
    out->target = f;
}

/* --- the moves ---------------------------------------------------------------------- */

enum { MOVE_SCALE = MOVE_LOCAL, MOVE_SHIFT };

#define SCALE  0.5 /* standard deviation of the log of each coordinate's factor */
#define SHIFT  0.4 /* of each coordinate */
#define NARROW 0.2 /* the same, of the second stage */

struct walker {
    struct state state; /* must be first */
    double x[2], y[2];  /* current, proposed */
    double y1[2];       /* what the first stage proposed, */
    int first;          /* and by which move */
};

static double normal(struct rng *rng)
{
    double radius = sqrt(-2.0 * log1p(-rng_double(rng)));
    return radius * cos(2.0 * M_PI * rng_double(rng));
}

static double square(double x)
{
    return x * x;
}

/* ln q(to|x) - ln q(to|y) per coordinate, each but for a factor that depends on `to`. */
static double log_first_stage(const struct walker *w, int i)
{
    double to = w->y1[i], x = w->x[i], y = w->y[i];
    if (w->first == MOVE_SCALE)
        return (square(log(to / x)) - square(log(to / y))) / (2.0 * SCALE * SCALE);
    return (square(to - x) - square(to - y)) / (2.0 * SHIFT * SHIFT);
}

/* Draws w->y; the log ratio of what was drawn. A factor e^z of a coordinate, z symmetric,
 * has density g(z)/y at y. */
static double draw(struct walker *w, int move)
{
    struct rng *rng = w->state.rng;
    double log_ratio = 0.0;
    for (int i = 0; i < 2; i++) {
        if (move == MOVE_LARGE)
            w->y[i] = rng_double(rng);
        else if (move == MOVE_SCALE)
            w->y[i] = w->x[i] * exp(SCALE * normal(rng));
        else
            w->y[i] = w->x[i] + (move == MOVE_SHIFT ? SHIFT : NARROW) * normal(rng);
        if (move == MOVE_SCALE)
            log_ratio += log(w->y[i] / w->x[i]);
    }
    for (int i = 0; move == MOVE_SECOND_STAGE && density(w->y) > 0.0 && i < 2; i++)
        log_ratio += log_first_stage(w, i);
    if (move != MOVE_SECOND_STAGE) {
        memcpy(w->y1, w->y, sizeof w->y1);
        w->first = move;
    }
    return log_ratio;
}

/* What the log ratio of each move is multiplied by: 1 is right. */
struct faults {
    double factor[MOVES_MOST];
};

/* --- all that joins it to a chain --------------------------------------------------- */

static struct proposal propose(struct state *state, const struct target *target,
                               enum move move, struct contrib *out)
{
    struct walker *w = (struct walker *)state;
    int row = move == MOVE_LOCAL && rng_double(state->rng) < 0.5 ? MOVE_SHIFT : (int)move;
    double log_ratio = draw(w, row);
    fill(w->y, out);
    return (struct proposal){row, log_ratio *
                                      ((const struct faults *)target->ctx)->factor[row]};
}

static void accept(struct state *state)
{
    memcpy(((struct walker *)state)->x, ((struct walker *)state)->y, 2 * sizeof(double));
}

static void reject(struct state *state)
{
    (void)state;
}

static const struct state_type state_walker = {
    .moves = {"large", "second_stage", "scale", "shift"},
    .size = sizeof(struct walker),
    .propose = propose,
    .accept = accept,
    .reject = reject,
};

/* --- the law of states -------------------------------------------------------------- */

static void start(struct chain *chain, uint64_t seed, uint64_t index)
{
    struct walker *w = (struct walker *)chain->state;
    rng_init(&chain->rng, seed, RNG_TEST, index);
    do {
        w->x[0] = rng_double(&chain->rng);
        w->x[1] = rng_double(&chain->rng);
    } while (rng_double(&chain->rng) >= density(w->x));
    fill(w->x, chain->current);
    chain->pending_weight = 0.0;
}

struct outcome {
    double p; /* of the law of the last states */
    struct tally tally;
};

static struct outcome run(const struct step_type *step, double p_large,
                          const struct faults *faults)
{
    struct chain chain;
    struct chain_sinks none = {0};
    struct chain_params params = {p_large, 1.0, ESTIMATOR_PLAIN};
    struct target target = {NULL, (void *)(uintptr_t)faults};
    double observed[CELLS] = {0}, expected[CELLS];
    chain_init(&chain, &state_walker, NULL, 1);
    for (int i = 0; i < CELLS; i++)
        expected[i] = REPLICATES * cell_mass(i) / whole_mass();
    for (uint64_t r = 0; r < REPLICATES; r++) {
        start(&chain, 41, r);
        step->advance(&chain, &params, &target, &none, STEPS);
        observed[cell_of(((struct walker *)chain.state)->x)]++;
    }
    struct outcome outcome = {stat_chi2_p(observed, expected, CELLS), chain.tally};
    chain_deinit(&chain);
    return outcome;
}

static const struct faults no_fault = {{1, 1, 1, 1}};

static void stays_stationary(void **state)
{
    (void)state;
    const struct step_type *const steps[] = {&step_mh, &step_pf_exact};
    for (int s = 0; s < 2; s++)
        for (int p = 0; p < 2; p++) {
            struct outcome o = run(steps[s], p ? 0.3 : 0.02, &no_fault);
            print_message(
                "%s: p %.3g, acceptance of scale %.3f, shift %.3f\n", steps[s]->name, o.p,
                o.tally.acceptance[MOVE_SCALE] / (double)o.tally.proposed[MOVE_SCALE],
                o.tally.acceptance[MOVE_SHIFT] / (double)o.tally.proposed[MOVE_SHIFT]);
            assert_true(stat_ok(steps[s]->name, o.p, LEVEL));
        }
}

static void wrong_ratios_are_seen(void **state)
{
    (void)state;
    const struct {
        const char *what;
        const struct step_type *step;
        struct faults faults;
    } wrong[] = {
        {"log ratio left out", &step_mh, {{[MOVE_SCALE] = 0.0}}},
        {"log ratio a quarter too small", &step_mh, {{[MOVE_SCALE] = 0.75}}},
        {"first stage's density left out", &step_pf_exact, {{[MOVE_SCALE] = 1.0}}},
    };
    for (int i = 0; i < 3; i++) {
        struct outcome o = run(wrong[i].step, 0.02, &wrong[i].faults);
        print_message("%s: p %.3g\n", wrong[i].what, o.p);
        assert_true(o.p < SEEN);
    }
}

/* --- moves by name, and splats ------------------------------------------------------ */

static void moves_are_tallied_by_row(void **state)
{
    (void)state;
    struct outcome o = run(&step_pf_exact, 0.3, &no_fault);
    const struct tally *t = &o.tally;
    struct statistics s;
    int64_t mutations = (int64_t)REPLICATES * STEPS, failed = 0;
    struct statistics_part part = {.tallies = t, .chains = 1};
    statistics_measure(&part, 1, &s);
    for (int move = 0; move < MOVES_MOST; move++) {
        assert_true((t->proposed[move] > 0) == (state_walker.moves[move] != NULL));
        if (move != MOVE_SECOND_STAGE)
            failed += t->proposed[move] - t->nonzero[move];
    }
    assert_int_equal(tally_first(t->proposed), mutations);
    assert_int_equal(t->proposed[MOVE_SECOND_STAGE], failed);
    assert_int_equal(s.small, t->proposed[MOVE_SCALE] + t->proposed[MOVE_SHIFT]);
    assert_int_equal(s.large, t->proposed[MOVE_LARGE]);
    assert_true(s.eta_s == (t->acceptance[MOVE_SCALE] + t->acceptance[MOVE_SHIFT]) /
                               (double)s.small);
}

/* One cell's share, by splats of the kelemen estimator, over independent chains. */
static void splats_give_the_density(void **state)
{
    (void)state;
    enum { CHAINS = 400, CELL = 2 * SIDE + 1 };
    double b = whole_mass(), values[CHAINS];
    struct chain chain;
    struct film_sinks films;
    struct chain_params params = {0.2, b, ESTIMATOR_KELEMEN};
    struct target target = {NULL, (void *)(uintptr_t)&no_fault};
    chain_init(&chain, &state_walker, NULL, 1);
    film_sinks_create(&films, CELLS, ESTIMATOR_KELEMEN, false);
    for (int r = 0; r < CHAINS; r++) {
        film_clear(films.chain);
        film_clear(films.large);
        start(&chain, 43, (uint64_t)r);
        step_mh.advance(&chain, &params, &target, &films.sinks, 200);
        chain_flush(&chain, &params, &films.sinks);
        values[r] = b / 200.0 *
                    (film_value(films.chain, CELL).g + film_value(films.large, CELL).g);
    }
    assert_true(stat_ok("splats", stat_mean_p(values, CHAINS, cell_mass(CELL)), LEVEL));
    chain_deinit(&chain);
    film_sinks_destroy(&films);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stays_stationary),
        cmocka_unit_test(wrong_ratios_are_seen),
        cmocka_unit_test(moves_are_tallied_by_row),
        cmocka_unit_test(splats_give_the_density),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

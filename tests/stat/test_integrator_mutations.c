/* Mutations of paths satisfy detailed balance with f [Veach97, section 11.3]: for
 * independent paths x with density p, y proposed from x and accepted with probability
 * a(x,y), every function g of paths and every symmetric s,
 *     E[f(x)/p(x) a(x,y) s(x,y) (g(y) - g(x))] = 0,
 * as the pairs (x,y) and (y,x) cancel. That holds only if f, the transition densities of
 * both directions and the choice of the mutation are those of what is really done; no
 * chain has to converge. In all kinds of scenes, for each mutation alone and for all.
 * With w = f/p over its mean, s = 1 / ((1 + w(x)) (1 + w(y))) bounds what one pair
 * weighs; its factor 1 / cosh(log ratio), what it weighs on the way that is hardly ever
 * drawn.
 * Pair by pair: test_integrator_balance.c. With ETALON_LONG ten times as many paths.
 *
 * False-alarm rate of this file: 1e-3. Power: the same test rejects, with p < SEEN, a log
 * ratio that is left out. */

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>

#include "math/accum.h"
#include "support/mutation_bench.h"
#include "support/stat_test.h"

#include <stdlib.h>

#define PATHS  40000
#define GROUPS 100 /* of paths: the units of the t-tests */
#define SEEN   1e-6

enum {
    FILM_X,
    FILM_Y,
    FIRST,
    LAST,
    COSINE,
    DENSITY,
    BEFORE_LIGHT,
    EDGES,
    TURN,
    PANES,
    FUNCTIONS
};
static const char *const function_names[FUNCTIONS] = {
    "film x", "film y",       "first edge", "last edge", "cosine",
    "weight", "before light", "edges",      "turn",      "panes"};

#define LEVEL stat_sidak(1e-3, SCENES *DESIGNS *FUNCTIONS)

static void functions(const struct full_path *path, double g[FUNCTIONS])
{
    int k = path->edges;
    const struct full_vertex *x = path->x;
    g[FILM_X] = path->film[0];
    g[FILM_Y] = path->film[1];
    g[FIRST] = exp(-1.0 / sqrt(x[0].edge.inverse_square));
    g[LAST] = exp(-1.0 / sqrt(x[k - 1].edge.inverse_square));
    g[COSINE] = k > 1 ? x[1].cos[SIDE_LIGHT] : 0.0;
    g[DENSITY] = atan(log(rgb_luminance(path->ratio)));
    g[BEFORE_LIGHT] = k > 1 ? atan((double)x[k - 1].hit.at.p.x) : 0.0;
    g[EDGES] = k;
    /* Where multi-chain perturbations turn a direction. */
    g[TURN] = (double)vec3_dot(x[mutation_camera_first(path) % k].edge.w,
                               vec3(0.64f, 0.6f, 0.48f));
    g[PANES] = 0.0;
    for (int i = 0; i < k; i++)
        g[PANES] += x[i].crossed;
}

struct outcome {
    struct welford of[FUNCTIONS];
    double paths, proposed, acceptance; /* carrying something; sum of a */
};

static void add_pair(struct bench *b, double mean, double factor, struct outcome *out,
                     double sums[FUNCTIONS])
{
    struct proposal p = state_mlt.propose(b->state, &b->target, MOVE_LOCAL, &b->y);
    double x = b->x.target, y = b->y.target, gx[FUNCTIONS], gy[FUNCTIONS];
    out->paths++;
    if (y > 0.0) {
        double a = fmin(1.0, y / x * exp(factor * p.log_ratio));
        double weight = x * a / ((1.0 + x / mean) * (1.0 + y / mean)) / cosh(p.log_ratio);
        functions(mlt_state_current(b->state), gx);
        functions(mlt_state_proposed(b->state), gy);
        for (int i = 0; i < FUNCTIONS; i++)
            sums[i] += weight * (gy[i] - gx[i]);
        out->proposed++;
        out->acceptance += a;
    }
    state_mlt.reject(b->state);
}

/* factor: of the log ratio; 1 is right. */
static struct outcome run(const struct scene *scene, const struct design *design,
                          uint64_t index, double factor, int paths)
{
    struct bench b;
    struct outcome out = {{{0}}, 0, 0, 0};
    double mean = 0.0;
    bench_init(&b, scene, design, index);
    for (int i = 0; i < PATHS / 10; i++)
        mean += bench_draw(&b) ? b.x.target / (PATHS / 10) : 0.0;
    for (int group = 0; group < GROUPS; group++) {
        double sums[FUNCTIONS] = {0.0};
        for (int i = 0; i < paths / GROUPS; i++)
            if (bench_draw(&b))
                add_pair(&b, mean, factor, &out, sums);
        for (int i = 0; i < FUNCTIONS; i++)
            welford_add(&out.of[i], sums[i]);
    }
    assert_int_equal(b.y.nonfinite, 0);
    bench_deinit(&b);
    return out;
}

/* p-value of one function; 1 where it never changes. */
static double p_of(const struct outcome *o, int function)
{
    const struct welford *w = &o->of[function];
    double se = welford_se(w);
    return se > 0.0 ? stat_t_p(w->mean / se, GROUPS - 1) : 1.0;
}

static double least_p(const struct outcome *o, const char *what)
{
    double least = 1.0;
    for (int i = 0; i < FUNCTIONS; i++) {
        double p = p_of(o, i);
        if (p < LEVEL && what)
            fprintf(stderr, "%s: %s\n", what, function_names[i]);
        least = fmin(least, p);
    }
    return least;
}

/* Few paths of other scenes have delta events. */
static int paths_of(int c)
{
    int times = getenv("ETALON_LONG") ? 10 : 1;
    return times * (c == TEST_GLASS || c == WATER || c == POOL ? 4 * PATHS : PATHS);
}

static void detailed_balance(void **unused)
{
    (void)unused;
    bool ok = true;
    for (int c = 0; c < SCENES; c++) {
        struct scene *scene = scene_of(c);
        for (int d = 0; d < DESIGNS; d++) {
            struct outcome o = run(scene, &designs[d], (uint64_t)(100 * c + d), 1.0,
                                   paths_of(c));
            char what[100];
            snprintf(what, sizeof what, "%s, %s", name_of(c), designs[d].name);
            double p = least_p(&o, what);
            printf("%s: %.0f paths, %.0f proposals, mean acceptance %.3f, least p %.2g\n",
                   what, o.paths, o.proposed, o.acceptance / fmax(o.paths, 1.0), p);
            ok = stat_ok(what, p, LEVEL) && ok;
        }
        scene_destroy(scene);
    }
    assert_true(ok);
}

/* What the test sees, with more paths where few of them suit the mutation. */
static void wrong_ratios_are_seen(void **unused)
{
    (void)unused;
    static const struct {
        int scene;
        int paths; /* in PATHS */
    } trials[DESIGNS] = {
        {TEST_DIFFUSE, 6},  {TEST_DIFFUSE, 12}, {TEST_GLASS, 80}, {TEST_DIFFUSE, 12},
        {TEST_DIFFUSE, 12}, {TEST_DIFFUSE, 6},  {0, 0},           {TEST_GLASS, 12}};
    for (int d = 0; d < DESIGNS; d++) {
        if (trials[d].paths ==
            0) /* steps of numbers have none: integrator/mlt_numbers.h */
            continue;
        struct scene *scene = scene_of(trials[d].scene);
        struct outcome o = run(scene, &designs[d], 9000, 0.0, trials[d].paths * PATHS);
        double p = least_p(&o, NULL);
        printf("%s: without the log ratio: p %.2g\n", designs[d].name, p);
        assert_true(p < SEEN);
        scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(detailed_balance),
        cmocka_unit_test(wrong_ratios_are_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

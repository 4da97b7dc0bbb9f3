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
 *
 * Of each pair it is looked at, too, whether f(x) q(x->y) a(x->y) = f(y) q(y->x) a(y->x)
 * holds to rounding, where all but the chain's own ratio follows from the two lists of
 * vertices. With ETALON_LONG ten times as many.
 *
 * False-alarm rate of this file: 1e-3. Power: the same test rejects, with p < SEEN, a log
 * ratio that is left out. */

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>

#include "base/mem.h"
#include "integrator/mlt_state.h"
#include "math/accum.h"
#include "support/stat_test.h"
#include "support/water_scene.h"

#include <stdlib.h>
#include <string.h>

#define DEPTH 6
#define PATHS 40000
enum { WATER = TEST_CONTENTS, POOL, SCENES };
#define GROUPS 100 /* of paths: the units of the t-tests */
#define SEEN   1e-6

#define BALANCE_ERROR 1e-9 /* seen: 4e-15 */
#define LOBE_ERROR    0.01 /* of a chance, by rounded directions */
static long lobes_checked;

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

/* Which mutations are tried: all weight on one of them, or some on each. */
static const struct design {
    const char *name;
    double weights[MUTATIONS];
    bool weighted;
    int first; /* shortest paths: those of two chains have four edges at least */
} designs[] = {
    {"lens", {1, 0, 0, 0}, false, 1},
    {"caustic", {0, 1, 0, 0}, false, 1},
    {"multichain", {0, 0, 1, 0}, false, 4},
    {"bidirectional, uniform", {0, 0, 0, 1}, false, 1},
    {"bidirectional, weighted", {0, 0, 0, 1}, true, 1},
    {"lens subpath", {0, 0, 0, 0, 1}, false, 1},
    {"all", {2, 1, 3, 1, 2}, true, 1},
};
#define DESIGNS ((int)(sizeof designs / sizeof designs[0]))

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

/* A state without a chain. */
struct bench {
    struct path_space space;
    struct mlt_options options;
    struct rng rng;
    struct target target;
    struct state *state;
    struct contrib x, y;
    struct full_path pair; /* the current path */
};

static void eval(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    full_path_sample(ctx, numbers, out);
}

static void bench_init(struct bench *b, const struct scene *scene,
                       const struct design *design, uint64_t index)
{
    *b = (struct bench){.options = {.scene = scene, .depth = DEPTH}};
    b->options.mutation = (struct mutation_options){{0.5, 12.0}, {0.01, 1.0}, false};
    if (design->first > 1) /* two chains in a row seldom bear such a turn */
        b->options.mutation = (struct mutation_options){{0.1, 6.0}, {0.001, 0.3}, false};
    memcpy(b->options.weights, design->weights, sizeof b->options.weights);
    b->options.mutation.weighted = design->weighted;
    path_space_init(&b->space, scene, design->first, DEPTH);
    rng_init(&b->rng, 11, RNG_TEST, index);
    b->target = (struct target){eval, &b->space};
    b->state = mem_alloc(1, state_mlt.size);
    *b->state = (struct state){
        .type = &state_mlt, .rng = &b->rng, .seed = 11, .chain = index};
    state_mlt.init(b->state, &b->options);
    state_mlt.rng_changed(b->state);
    full_path_init(&b->pair, DEPTH);
    contrib_init(&b->x, 1);
    contrib_init(&b->y, 1);
}

static void bench_deinit(struct bench *b)
{
    full_path_deinit(&b->pair);
    contrib_deinit(&b->x);
    contrib_deinit(&b->y);
    state_mlt.deinit(b->state);
    mem_free(b->state);
    path_space_deinit(&b->space);
}

/* An independent path becomes current; false if it carries nothing. */
static bool draw(struct bench *b)
{
    state_mlt.propose(b->state, &b->target, MOVE_LARGE, &b->x);
    state_mlt.accept(b->state);
    return b->x.target > 0.0;
}

/* Of pairs (x,y), x current and y proposed: how far f(x) q(x->y) a(x->y) is from f(y)
 * q(y->x) a(y->x), relative to it. a(x->y) is the chain's; all else follows from the two
 * lists of vertices: f, the suitable mutations and both transition densities. */
struct balance {
    double pairs, beyond, worst;
};

struct outcome {
    struct welford of[FUNCTIONS];
    double paths, proposed, acceptance; /* carrying something; sum of a */
    struct balance balance;
};

/* Density of the direction in which a lobe leaves that is taken with certainty: 1 in
 * units of the delta from the side that sampled it, and from the other side the Jacobian
 * of directions, |cos| over sin^2 on both sides by Snell's law. */
static void check_lobe(const struct full_path *path, int i)
{
    const struct full_vertex *v = &path->x[i];
    double cosine[2] = {fabs((double)vec3_dot(v->hit.shading.n, path->x[i - 1].edge.w)),
                        fabs((double)vec3_dot(v->hit.shading.n, v->edge.w))};
    for (enum side side = SIDE_CAMERA; side <= SIDE_LIGHT; side++) {
        double in = cosine[side], out = cosine[1 - side], jacobian = 1.0;
        if (!(v->lobe[side] > 0.0) || fmin(in, out) < 0.05 || fmax(in, out) > 0.99)
            continue;
        if (v->transmits)
            jacobian = out / in * (1.0 - in * in) / (1.0 - out * out);
        double pdf = mutation_lobe_pdf(path, i, side);
        assert_true(fabs(pdf - 1.0) < LOBE_ERROR ||
                    fabs(pdf * jacobian - 1.0) < LOBE_ERROR ||
                    fabs(pdf / jacobian - 1.0) < LOBE_ERROR);
        lobes_checked++;
    }
}

static void check_lobes(const struct full_path *path)
{
    for (int i = 1; i < path->edges; i++)
        if (path->x[i].delta)
            check_lobe(path, i);
}

/* --- pairs -------------------------------------------------------------------------- */

static double weight_of(struct bench *b, struct full_path *path)
{
    double sum = 0.0;
    for (int i = 0; i < MUTATIONS; i++)
        if (b->options.weights[i] > 0.0 && mutation_types[i]->suits(&b->space, path))
            sum += b->options.weights[i];
    return sum;
}

/* Where an end is a direction its place changes with that of its neighbour. */
static bool same_place(const struct bench *b, const struct full_vertex *v,
                       const struct full_vertex *w)
{
    const struct scene *scene = b->options.scene;
    bool lens = v->kind == VERTEX_CAMERA;
    if (v->kind != w->kind || v->light != w->light)
        return false;
    if (lens ? scene->camera.orthographic
             : v->light >= 0 && scene->lights[v->light].infinite)
        return lens || memcmp(&v->hit.at.ng, &w->hit.at.ng, sizeof v->hit.at.ng) == 0;
    return memcmp(&v->hit.at.p, &w->hit.at.p, sizeof v->hit.at.p) == 0;
}

/* log q(y->x)/q(x->y) of deleting what lies between l and m of x. */
static double log_bidirectional(struct bench *b, const struct full_path *x,
                                const struct full_path *y, int l, int m)
{
    bool weighted = b->options.mutation.weighted;
    int end = m + y->edges - x->edges;
    struct scaled there = mutation_bidirectional_density(&b->space, weighted, x, l, m, y);
    struct scaled back = mutation_bidirectional_density(&b->space, weighted, y, l, end,
                                                        x);
    return scaled_log(scaled_div(back, there));
}

/* The nearest to `stated` of all l and m that lead from x to y: where a lens or a light
 * is a single point, or a delta lobe is sampled again, vertices that were made anew are
 * the same. */
static double nearest_bidirectional(struct bench *b, const struct full_path *x,
                                    const struct full_path *y, double stated)
{
    int kept[2] = {0, 0}, least = x->edges < y->edges ? x->edges : y->edges;
    double nearest = HUGE_VAL;
    while (kept[0] <= least && same_place(b, &x->x[kept[0]], &y->x[kept[0]]))
        kept[0]++;
    while (kept[1] <= least &&
           same_place(b, &x->x[x->edges - kept[1]], &y->x[y->edges - kept[1]]))
        kept[1]++;
    if (x->edges == y->edges && kept[0] > least) /* a point took its own place */
        return stated;
    for (int i = 0; i <= kept[0]; i++)
        for (int j = 0; j <= kept[1]; j++) {
            int l = kept[0] - i - 1, m = x->edges + 1 - (kept[1] - j);
            double ratio = log_bidirectional(b, x, y, l, m);
            if (fabs(ratio - stated) < 1e-12)
                return ratio;
            if (fabs(ratio - stated) < fabs(nearest - stated))
                nearest = ratio;
        }
    return nearest;
}

/* y: evaluated anew from its vertices. */
static void check_pair(struct bench *b, struct full_path *x, struct full_path *y,
                       struct proposal p, struct balance *out)
{
    const struct mutation *mutation = mutation_types[p.move - MOVE_LOCAL];
    double other = scaled_log(scaled_div(y->pdf, x->pdf)) +
                   log(weight_of(b, x) / weight_of(b, y));
    double ratio = mutation->density
                       ? scaled_log(
                             scaled_div(mutation->density(x), mutation->density(y)))
                       : nearest_bidirectional(b, x, y, p.log_ratio - other);
    double f = log(rgb_luminance(y->ratio) / rgb_luminance(x->ratio));
    /* log of f(y) q(y->x) / (f(x) q(x->y)); of the chain: of a(x->y) / a(y->x). */
    double chain = log(b->y.target / b->x.target) + p.log_ratio;
    double apart = fabs(expm1(f + ratio + other - chain));
    out->pairs++;
    out->beyond += !(apart < BALANCE_ERROR);
    out->worst = fmax(out->worst, apart);
}

/* What a proposal says of itself is what follows from its vertices: nothing of the path
 * that it comes from is left. */
static void check_whole(struct bench *b)
{
    const struct full_path *y = mlt_state_proposed(b->state);
    struct full_path *again = &b->space.sampled;
    full_path_copy(again, y);
    for (int i = 0; i < y->edges; i++) {
        if (i > 0)
            assert_int_equal(full_path_scatter(&b->space, again, i), FAILURE_NONE);
        if (b->space.paths.passed)
            assert_int_equal(full_path_unobstructed(&b->space, again, i), FAILURE_NONE);
    }
    assert_int_equal(full_path_emit(&b->space, again), FAILURE_NONE);
    full_path_weigh(&b->space, again);
    double error = fabs(rgb_luminance(again->ratio) / rgb_luminance(y->ratio) - 1.0);
    assert_true(error < 1e-5 && fabs(scaled_ratio(again->pdf, y->pdf) - 1.0) < 1e-5);
}

static void add_pair(struct bench *b, double mean, double factor, struct outcome *out,
                     double sums[FUNCTIONS])
{
    struct proposal p = state_mlt.propose(b->state, &b->target, MOVE_LOCAL, &b->y);
    double x = b->x.target, y = b->y.target, gx[FUNCTIONS], gy[FUNCTIONS];
    out->paths++;
    if (y > 0.0) {
        double a = fmin(1.0, y / x * exp(factor * p.log_ratio));
        double weight = x * a / ((1.0 + x / mean) * (1.0 + y / mean)) / cosh(p.log_ratio);
        check_whole(b);
        full_path_copy(&b->pair, mlt_state_current(b->state));
        check_pair(b, &b->pair, &b->space.sampled, p, &out->balance);
        check_lobes(mlt_state_current(b->state));
        check_lobes(mlt_state_proposed(b->state));
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
    struct outcome out = {{{0}}, 0, 0, 0, {0, 0, 0}};
    double mean = 0.0;
    bench_init(&b, scene, design, index);
    for (int i = 0; i < PATHS / 10; i++)
        mean += draw(&b) ? b.x.target / (PATHS / 10) : 0.0;
    for (int group = 0; group < GROUPS; group++) {
        double sums[FUNCTIONS] = {0.0};
        for (int i = 0; i < paths / GROUPS; i++)
            if (draw(&b))
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

static const char *name_of(int c)
{
    return c < TEST_CONTENTS ? test_contents_name[c] : c == WATER ? "water" : "pool";
}

/* Few paths of other scenes have delta events. */
static int paths_of(int c)
{
    int times = getenv("ETALON_LONG") ? 10 : 1;
    return times * (c == TEST_GLASS || c == WATER || c == POOL ? 4 * PATHS : PATHS);
}

static struct scene *scene_of(int c)
{
    return c < TEST_CONTENTS ? test_scene((enum test_contents)c, false)
                             : water_scene(c == POOL);
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
            printf("    %.0f pairs, %.0f beyond %g, worst %.2g\n", o.balance.pairs,
                   o.balance.beyond, BALANCE_ERROR, o.balance.worst);
            ok = stat_ok(what, p, LEVEL) && o.balance.beyond == 0.0 && ok;
        }
        scene_destroy(scene);
    }
    printf("%ld lobes\n", lobes_checked);
    assert_true(lobes_checked > 10000);
    assert_true(ok);
}

/* What the test sees, with more paths where few of them suit the mutation. */
static void wrong_ratios_are_seen(void **unused)
{
    (void)unused;
    static const struct {
        int scene;
        int paths; /* in PATHS */
    } trials[DESIGNS] = {{TEST_DIFFUSE, 6},  {TEST_DIFFUSE, 12}, {TEST_GLASS, 80},
                         {TEST_DIFFUSE, 12}, {TEST_DIFFUSE, 12}, {TEST_DIFFUSE, 6},
                         {TEST_GLASS, 12}};
    for (int d = 0; d < DESIGNS; d++) {
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

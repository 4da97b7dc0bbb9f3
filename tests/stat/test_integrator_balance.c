/* Detailed balance of each mutation, pair by pair: of x and y, which is proposed from it,
 *     f(x) q(x->y) a(x->y) = f(y) q(y->x) a(y->x)
 * to rounding. a(x->y)/a(y->x) is what the chain uses; all else follows from the two
 * lists of vertices: f, the suitable mutations and both transition densities. Of each
 * mutation, in each kind of scene, PAIRS pairs; 100,000 with ETALON_LONG, where a path
 * that suits is found often enough.
 *
 * Pairs are those of a chain of FOLLOWED proposals from an independent path, which is
 * what makes them many where few independent paths suit.
 *
 * Nothing here is a test of chance: every pair must balance within ERROR, so a factor
 * that is wrong in a single pair is seen. Where paths go: test_integrator_mutations.c. */

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>

#include "support/mutation_bench.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define PAIRS    1000
#define FOLLOWED 20

/* Independent paths that are drawn at most; where none suits, UNSUITED. */
#define DRAWN      60000L
#define DRAWN_LONG 200000000L
#define UNSUITED   300000L

#define ERROR      1e-9 /* seen: 9e-15 */
#define LOBE_ERROR 0.01 /* of a chance, by rounded directions */

struct balance {
    long drawn, suited, proposed; /* paths, those that suit, proposals from them */
    long pairs, beyond, steps;    /* steps: through a texture's step, not looked at */
    long nonfinite;               /* proposals, which a chain counts and rejects */
    double worst;                 /* relative error */
};

static long lobes_checked;

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
    for (int i = 0; i < MLT_MOVES; i++)
        if (b->options.weights[i] > 0.0 &&
            (i == MUTATIONS || mutation_types[i]->suits(&b->space, path)))
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

/* log q(y->x)/q(x->y) of the mutation. Small steps of numbers are symmetric under the law
 * of independent paths: integrator/mlt_numbers.h. */
static double log_densities(struct bench *b, const struct full_path *x,
                            const struct full_path *y, int choice, double stated)
{
    if (choice == MUTATIONS)
        return scaled_log(scaled_div(x->pdf, y->pdf));
    const struct mutation *mutation = mutation_types[choice];
    return mutation->density
               ? scaled_log(scaled_div(mutation->density(x), mutation->density(y)))
               : nearest_bidirectional(b, x, y, stated);
}

/* y: evaluated anew from its vertices. */
static void check_pair(struct bench *b, struct full_path *x, struct full_path *y,
                       struct proposal p, struct balance *out)
{
    double other = scaled_log(scaled_div(y->pdf, x->pdf)) +
                   log(weight_of(b, x) / weight_of(b, y));
    double ratio = log_densities(b, x, y, p.move - MOVE_LOCAL, p.log_ratio - other);
    double f = log(rgb_luminance(y->ratio) / rgb_luminance(x->ratio));
    /* log of f(y) q(y->x) / (f(x) q(x->y)); of the chain: of a(x->y) / a(y->x). */
    double chain = log(b->y.target / b->x.target) + p.log_ratio;
    double apart = fabs(expm1(f + ratio + other - chain));
    out->pairs++;
    out->beyond += !(apart < ERROR);
    out->worst = fmax(out->worst, apart);
}

/* Whether edge i passes the same parts of the same panes. Where a texture has steps, a
 * segment and a ray along it may be rounded to its two sides. */
static bool same_panes(const struct full_path *a, const struct full_path *b, int i)
{
    double of_a = rgb_luminance(a->x[i].transmittance);
    double of_b = rgb_luminance(b->x[i].transmittance);
    return a->x[i].crossed == b->x[i].crossed && fabs(of_a - of_b) < 1e-3 * of_b;
}

/* What a proposal says of itself is what follows from its vertices: nothing of the path
 * that it comes from is left. Evaluates it anew into space->sampled; false if it passes a
 * texture's step. */
static bool check_whole(struct bench *b)
{
    const struct full_path *y = mlt_state_proposed(b->state);
    struct full_path *again = &b->space.sampled;
    full_path_copy(again, y);
    for (int i = 0; i < y->edges; i++) {
        if (i > 0)
            assert_int_equal(full_path_scatter(&b->space, again, i), FAILURE_NONE);
        if (b->space.paths.passed)
            assert_int_equal(full_path_unobstructed(&b->space, again, i), FAILURE_NONE);
        if (!same_panes(again, y, i))
            return false;
    }
    assert_int_equal(full_path_emit(&b->space, again), FAILURE_NONE);
    full_path_weigh(&b->space, again);
    double error = fabs(rgb_luminance(again->ratio) / rgb_luminance(y->ratio) - 1.0);
    assert_true(error < 1e-5 && fabs(scaled_ratio(again->pdf, y->pdf) - 1.0) < 1e-5);
    return true;
}

/* One proposal, which is checked and becomes current as a chain would have it. */
static void follow(struct bench *b, struct full_path *current, struct balance *out)
{
    struct proposal p = state_mlt.propose(b->state, &b->target, MOVE_LOCAL, &b->y);
    double x = b->x.target, y = b->y.target;
    out->proposed++;
    if (y > 0.0 && !check_whole(b)) {
        out->steps++;
    } else if (y > 0.0) {
        full_path_copy(current, mlt_state_current(b->state));
        check_pair(b, current, &b->space.sampled, p, out);
        check_lobes(mlt_state_current(b->state));
        check_lobes(mlt_state_proposed(b->state));
    }
    if (y > 0.0 && rng_double(&b->rng) < y / x * exp(p.log_ratio)) {
        b->x.target = y;
        state_mlt.accept(b->state);
    } else {
        state_mlt.reject(b->state);
    }
}

static struct balance run(const struct scene *scene, const struct design *design,
                          uint64_t index, long pairs, long most)
{
    struct bench b;
    struct balance out = {0};
    struct full_path current;
    bench_init(&b, scene, design, index);
    full_path_init(&current, DEPTH);
    while (out.pairs < pairs && out.drawn < most &&
           (out.suited > 0 || out.drawn < UNSUITED)) {
        out.drawn++;
        if (!bench_draw(&b))
            continue;
        full_path_copy(&current, mlt_state_current(b.state));
        if (!(weight_of(&b, &current) > 0.0))
            continue;
        out.suited++;
        for (int i = 0; i < FOLLOWED && out.pairs < pairs; i++)
            follow(&b, &current, &out);
    }
    out.nonfinite = b.y.nonfinite;
    full_path_deinit(&current);
    bench_deinit(&b);
    return out;
}

/* SCENES: names of kinds, apart by commas, of which alone the table is made. */
static bool wanted(int c)
{
    const char *only = getenv("SCENES"), *name = name_of(c);
    size_t length = strlen(name);
    for (const char *at = only; at; at = strchr(at, ','), at += at != NULL)
        if (strncmp(at, name, length) == 0 && (at[length] == ',' || at[length] == 0))
            return true;
    return only == NULL;
}

static void pairs_balance(void **unused)
{
    (void)unused;
    bool many = getenv("ETALON_LONG") != NULL;
    long pairs = many ? 100 * PAIRS : PAIRS, most = many ? DRAWN_LONG : DRAWN;
    long beyond = 0, all = 0, steps = 0, nonfinite = 0;
    printf("| kind | mutation | paths drawn | that suit | proposals | pairs | worst |\n"
           "|---|---|---|---|---|---|---|\n");
    for (int c = 0; c < SCENES; c++) {
        if (!wanted(c))
            continue;
        struct scene *scene = scene_of(c);
        for (int d = 0; d < DESIGNS; d++) {
            struct balance o = run(scene, &designs[d], (uint64_t)(100 * c + d), pairs,
                                   most);
            printf("| %s | %s | %ld | %ld | %ld | %ld | %.2g |\n", name_of(c),
                   designs[d].name, o.drawn, o.suited, o.proposed, o.pairs, o.worst);
            fflush(stdout);
            beyond += o.beyond;
            all += o.pairs;
            steps += o.steps;
            nonfinite += o.nonfinite;
        }
        scene_destroy(scene);
    }
    printf("%ld pairs, %ld beyond %g, %ld more at steps of textures, %ld not finite; %ld "
           "lobes\n",
           all, beyond, ERROR, steps, nonfinite, lobes_checked);
    assert_true(getenv("SCENES") || lobes_checked > 10000);
    assert_int_equal(beyond, 0);
    assert_true((double)steps < 1e-4 * (double)all);
    assert_int_equal(nonfinite, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(pairs_balance)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}

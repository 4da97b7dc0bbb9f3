/* Where mutations go, against the transition densities that they state: from one path x,
 * proposals y whose new vertices lie in a cell A of the surfaces have
 *     E[1_A(y) / q(x->y)] = area of A,
 * if q is the density of y per area, its symmetric kernel included. All points of the
 * cells are reachable. The deviations of all cells, in standard errors, make a
 * chi-squared test for each mutation. Of film points: each is uniform, and those of all
 * chains are evenly spread.
 *
 * False-alarm rate of this file: 1e-4. Power: the test rejects, with p < SEEN, densities
 * that are 8 % wrong, and such as change over the film (multi-chain: wrong by a factor of
 * 2). */

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>

#include "math/accum.h"
#include "math/warp.h"
#include "path/mutation.h"
#include "support/stat_test.h"
#include "support/test_scene.h"

#include <string.h>

#define DEPTH     4
#define PROPOSALS 100000
#define CELLS     4 /* of a surface, 2 x 2; where two vertices are new it is one cell */
#define MOST      3 /* new vertices of a path that is looked at */
#define SEEN      1e-6
#define LEVEL     stat_sidak(1e-4, DESIGNS + 2)

/* --- scene and cells ---------------------------------------------------------------- */

enum surface { FLOOR, SCREEN, MIRROR, SURFACES };

/* Each is a plane across one axis, with a square of cells on it that the lens, the lamp
 * and the squares of other surfaces see. */
static const struct patch {
    int axis;
    float at, corner[3], side;
} patches[SURFACES] = {
    {1, 0.0f, {-0.4f, 0.0f, -0.8f}, 2.0f},
    {2, -2.0f, {-0.4f, 0.3f, 0.0f}, 2.0f},
    {0, -1.0f, {0.0f, 0.2f, -1.9f}, 0.8f},
};

/* coated: the floor has a delta lobe beside its diffuse one. */
static struct scene *corner_scene(bool coated)
{
    struct scene_desc *desc = test_desc(vec3(0.5f, 2.0f, 4.0f), vec3(0.2f, 0.4f, -0.5f),
                                        60.0, 64);
    struct rgb dark = {0.0, 0.0, 0.0};
    int white = test_diffuse(desc, 0.7, 0.6, 0.5);
    int mirror = test_material(desc, "mirror", NULL, dark, NULL, 0.0);
    int floor = coated ? test_material(desc, "plastic", NULL, dark, NULL, 0.0) : white;
    desc->camera.lens_radius = 0.05;
    desc->camera.focus_distance = 4.0;
    test_quad(desc, vec3(4, 0, 0), vec3(0, 0, 9), vec3(9, 0, 0), floor, dark);
    test_quad(desc, vec3(4, 4, -2), vec3(9, 0, 0), vec3(0, 9, 0), white, dark);
    test_quad(desc, vec3(-1, 4, 0), vec3(0, 9, 0), vec3(0, 0, 9), mirror, dark);
    test_quad(desc, vec3(1.5f, 5, 1.5f), vec3(0.7f, 0, 0), vec3(0, 0, 0.7f), white,
              rgb(9.0, 8.0, 7.0));
    return test_build(desc, false);
}

static float component(struct vec3 p, int axis)
{
    return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
}

/* Cell of the vertex: surface * CELLS + place; -1: in none. */
static int cell_of(const struct full_vertex *v)
{
    for (int i = 0; i < SURFACES; i++) {
        const struct patch *s = &patches[i];
        int place = 0;
        bool inside = fabsf(component(v->hit.at.p, s->axis) - s->at) < 1e-3f;
        for (int axis = 0; axis < 3 && inside; axis++) {
            float x = component(v->hit.at.p, axis) - s->corner[axis];
            if (axis == s->axis)
                continue;
            inside = x >= 0.0f && x < s->side;
            place = 2 * place + (x > 0.5f * s->side);
        }
        if (inside)
            return i * CELLS + place;
    }
    return -1;
}

/* --- designs ------------------------------------------------------------------------ */

/* The surfaces of x, and those on which new vertices are looked at, l and m of
 * path/mutation_bidirectional.c being the vertices that are kept. */
static const struct design {
    const char *name;
    const struct mutation *mutation;
    int inner; /* vertices between lens and light */
    enum surface at[MOST];
    bool weighted;
    int l, m, added; /* new vertices */
    enum surface to[MOST];
    bool coated;
} designs[] = {
    {"lens", &mutation_lens, 1, {FLOOR}, false, 0, 2, 1, {FLOOR}, false},
    {"caustic", &mutation_caustic, 1, {FLOOR}, false, 0, 2, 1, {FLOOR}, false},
    {"multichain",
     &mutation_multichain,
     3,
     {FLOOR, MIRROR, SCREEN},
     false,
     0,
     4,
     2,
     {FLOOR, MIRROR},
     false},
    {"lens sub-path",
     &mutation_lens_subpath,
     1,
     {FLOOR},
     false,
     -1,
     2,
     1,
     {FLOOR},
     false},
    {"lens sub-path on a longer path",
     &mutation_lens_subpath,
     2,
     {FLOOR, SCREEN},
     false,
     -1,
     2,
     1,
     {FLOOR},
     false},
    {"lens sub-path on a coated floor",
     &mutation_lens_subpath,
     1,
     {FLOOR},
     false,
     -1,
     2,
     1,
     {FLOOR},
     true},
    {"bidirectional, first vertex",
     &mutation_bidirectional,
     2,
     {FLOOR, SCREEN},
     false,
     0,
     2,
     1,
     {FLOOR},
     false},
    {"bidirectional, last vertex",
     &mutation_bidirectional,
     2,
     {FLOOR, SCREEN},
     false,
     1,
     3,
     1,
     {SCREEN},
     false},
    {"bidirectional, one less",
     &mutation_bidirectional,
     2,
     {FLOOR, SCREEN},
     false,
     0,
     2,
     0,
     {0},
     false},
    {"bidirectional, one more",
     &mutation_bidirectional,
     1,
     {FLOOR},
     false,
     1,
     2,
     1,
     {SCREEN},
     false},
    {"weighted, first vertex",
     &mutation_bidirectional,
     2,
     {FLOOR, SCREEN},
     true,
     0,
     2,
     1,
     {FLOOR},
     false},
    /* RARE */
    {"bidirectional, both",
     &mutation_bidirectional,
     2,
     {FLOOR, SCREEN},
     false,
     0,
     3,
     2,
     {FLOOR, SCREEN},
     false},
    {"weighted, both",
     &mutation_bidirectional,
     2,
     {FLOOR, SCREEN},
     true,
     0,
     3,
     2,
     {FLOOR, SCREEN},
     false},
};
#define DESIGNS ((int)(sizeof designs / sizeof designs[0]))
#define RARE    2 /* the last designs, of which few proposals are: long form only */

static const struct mutation_options options_of_kernels = {
    .film = {0.3, 100.0}, .angle = {5e-3, 2.5}, .weighted = false};

/* An independent path of the design's class whose vertices lie in cells. */
static void find_path(struct path_space *space, const struct design *d, struct rng *rng,
                      struct full_path *x)
{
    struct ustream_random stream;
    struct contrib out;
    ustream_random_init(&stream, rng);
    struct numbers numbers = {&stream.stream, &stream.stream, &stream.stream};
    contrib_init(&out, 1);
    for (bool found = false; !found;) {
        full_path_sample(space, &numbers, &out);
        found = out.target > 0.0 && space->sampled.edges == d->inner + 1;
        for (int i = 0; found && i < d->inner; i++) {
            int cell = cell_of(&space->sampled.x[i + 1]);
            found = cell >= 0 ? cell / CELLS == (int)d->at[i]
                              : d->at[i] == SCREEN && d->inner == 3;
        }
    }
    full_path_copy(x, &space->sampled);
    contrib_deinit(&out);
}

/* --- densities ---------------------------------------------------------------------- */

/* The law r2 exp(-log(r2/r1) u), per unit of length. */
static double law(const double range[2], double distance)
{
    return 1.0 / (distance * log(range[1] / range[0]));
}

static double film_kernel(const struct mutation_options *o, const struct camera *camera,
                          const struct full_path *x, const struct full_path *y)
{
    double dx = (y->film[0] - x->film[0]) * camera->width;
    double dy = (y->film[1] - x->film[1]) * camera->height, r = hypot(dx, dy);
    /* Per area of the film as a whole. */
    return law(o->film, r) / (2.0 * MATH_PI * r) * camera->width * camera->height;
}

/* Of turns from w to v, per solid angle. */
static double angle_kernel(const struct mutation_options *o, struct vec3 w, struct vec3 v)
{
    struct vec3 apart = vec3_sub(v, w);
    double angle = 2.0 * asin(0.5 * sqrt((double)vec3_dot(apart, apart)));
    return law(o->angle, angle) / (2.0 * MATH_PI * sin(angle));
}

static double density(struct path_space *space, const struct design *d,
                      const struct mutation_options *o, const struct full_path *x,
                      const struct full_path *y)
{
    const struct scaled one = scaled(1.0);
    if (d->mutation == &mutation_bidirectional)
        return scaled_ratio(
            mutation_bidirectional_density(space, d->weighted, x, d->l, d->m, y), one);
    double q = scaled_ratio(d->mutation->density(y), one);
    if (d->mutation == &mutation_caustic)
        return q * angle_kernel(o, x->x[1].edge.w, y->x[1].edge.w);
    if (d->mutation != &mutation_lens_subpath)
        q *= film_kernel(o, &space->paths.scene->camera, x, y);
    if (d->mutation == &mutation_multichain) /* x[3] follows from the others */
        q *= angle_kernel(o, x->x[1].edge.w, y->x[1].edge.w) /
             full_path_conversion(y, 3, SIDE_CAMERA) /
             mutation_lobe_pdf(y, 2, SIDE_CAMERA);
    return q;
}

/* --- the test ----------------------------------------------------------------------- */

static bool same_place(const struct full_vertex *a, const struct full_vertex *b)
{
    return memcmp(&a->hit.at.p, &b->hit.at.p, sizeof a->hit.at.p) == 0;
}

/* The cell of y's new vertices, as one number; -1: the proposal is of another kind. */
static int cells_of(const struct design *d, const struct full_path *x,
                    const struct full_path *y)
{
    bool determined = d->mutation == &mutation_multichain;
    int added = d->added + determined, tail = x->edges - d->m, cell = 0;
    int first = d->l < 0 ? 1 : d->l + 1;
    if (y->edges != first + added + tail)
        return -1;
    for (int i = 0; i <= y->edges; i++) {
        bool head = i <= d->l, kept = head || i >= first + added;
        int from = head ? i : i - first - added + d->m;
        if (i == 0 && d->l < 0)
            continue;
        if (kept && !same_place(&y->x[i], &x->x[from]))
            return -1;
        if (kept || i >= first + d->added)
            continue;
        int at = cell_of(&y->x[i]);
        bool fresh = from < 0 || from > x->edges || i > x->edges ||
                     !same_place(&y->x[i], &x->x[i]);
        if (at < 0 || at / CELLS != (int)d->to[i - first] || !fresh)
            return -1;
        cell = d->added == 1 ? at % CELLS : 0;
    }
    return cell;
}

static double area_of_cells(const struct design *d)
{
    double area = d->added == 1 ? 1.0 / CELLS : 1.0;
    for (int i = 0; i < d->added; i++) {
        double side = (double)patches[d->to[i]].side;
        area *= side * side;
    }
    return area;
}

static bool is_long(void)
{
    return getenv("ETALON_LONG") != NULL;
}

static long proposals(void)
{
    return is_long() ? 40L * PROPOSALS : PROPOSALS;
}

/* p of the density times `factor`, which is `tilt` from left to right of the film. */
static double p_of(int design, double factor, double tilt, double *error)
{
    const struct design *d = &designs[design];
    struct mutation_options o = options_of_kernels;
    struct path_space space;
    struct full_path x, y;
    struct rng rng;
    struct welford of[CELLS] = {{0}};
    o.weighted = d->weighted;
    struct scene *scene = corner_scene(d->coated);
    path_space_init(&space, scene, 1, DEPTH);
    full_path_init(&x, DEPTH);
    full_path_init(&y, DEPTH);
    rng_init(&rng, 3, RNG_TEST, (uint64_t)design);
    struct mutation_random random = {&rng, {3, (uint64_t)design, 0}};
    find_path(&space, d, &rng, &x);
    assert_true(d->mutation->suits(&space, &x));
    int cells = d->added == 1 ? CELLS : 1;
    for (long i = 0; i < proposals(); i++) {
        struct scaled ratio;
        bool made = mutation_propose(d->mutation, &space, &o, &x, &random, &y, &ratio) ==
                    FAILURE_NONE;
        int cell = made ? cells_of(d, &x, &y) : -1;
        double value = 0.0;
        if (cell >= 0)
            value = 1.0 / (factor * pow(tilt, 4.0 * (y.film[0] - x.film[0])) *
                           density(&space, d, &o, &x, &y));
        for (int j = 0; j < cells; j++)
            welford_add(&of[j], j == cell ? value : 0.0);
    }
    double chi2 = 0.0, area = area_of_cells(d);
    *error = 0.0;
    for (int j = 0; j < cells; j++) {
        double z = (of[j].mean - area) / welford_se(&of[j]);
        *error = fmax(*error, welford_se(&of[j]) / area);
        chi2 += z * z;
    }
    full_path_deinit(&x);
    full_path_deinit(&y);
    path_space_deinit(&space);
    scene_destroy(scene);
    return gsl_cdf_chisq_Q(chi2, cells);
}

static void mutations_go_where_they_say(void **state)
{
    (void)state;
    bool ok = true;
    for (int i = 0; i < DESIGNS - (is_long() ? 0 : RARE); i++) {
        double error, p = p_of(i, 1.0, 1.0, &error);
        printf("%s: p %.3g, largest error of a cell %.1f %%\n", designs[i].name, p,
               100.0 * error);
        ok = stat_ok(designs[i].name, p, LEVEL) && ok;
    }
    assert_true(ok);
}

/* What the test sees of errors of a density: of its scale, and of its course over the
 * film. */
static void wrong_densities_are_seen(void **state)
{
    (void)state;
    static const struct {
        int design;
        double deviation;
    } tried[] = {{0, 1.08}, {1, 1.08}, {2, 2.0}, {3, 1.08}}; /* the most proposals */
    for (int i = 0; i < 4; i++) {
        double error, factor = tried[i].deviation;
        double scaled = p_of(tried[i].design, factor, 1.0, &error);
        double tilted = p_of(tried[i].design, 1.0, 4.0 * factor, &error);
        printf("%s: p %.2g times %.2f, %.2g tilted\n", designs[tried[i].design].name,
               scaled, factor, tilted);
        assert_true(scaled < SEEN && (tilted < SEEN || factor > 1.5));
    }
}

/* --- film points -------------------------------------------------------------------- */

#define SIDE   4
#define CHAINS 256
#define POINTS 200 /* of each chain */

static void add_point(struct film_points *points, double count[SIDE * SIDE])
{
    double film[2];
    film_points_next(points, film);
    count[(int)(film[1] * SIDE) * SIDE + (int)(film[0] * SIDE)]++;
}

static double chi2(const double *count, double expected)
{
    double sum = 0.0;
    for (int i = 0; i < SIDE * SIDE; i++)
        sum += (count[i] - expected) * (count[i] - expected) / expected;
    return sum;
}

static void film_points_are_uniform_and_stratified(void **state)
{
    (void)state;
    struct film_points points[CHAINS];
    double one[SIDE * SIDE] = {0.0}, spread = 0.0;
    for (int i = 0; i < CHAINS; i++)
        points[i] = (struct film_points){7, (uint64_t)i, 0};
    for (int n = 0; n < POINTS; n++) {
        double all[SIDE * SIDE] = {0.0};
        for (int i = 0; i < CHAINS; i++)
            add_point(&points[i], all);
        spread += chi2(all, (double)CHAINS / (SIDE * SIDE)) / POINTS;
    }
    points[0].drawn = 0;
    for (int n = 0; n < 20 * POINTS; n++)
        add_point(&points[0], one);
    double p = gsl_cdf_chisq_Q(chi2(one, 20.0 * POINTS / (SIDE * SIDE)), SIDE * SIDE - 1);
    printf("a chain's points: p %.2g; all chains': %.2f of the spread of random ones\n",
           p, spread / (SIDE * SIDE - 1));
    assert_true(stat_ok("film points", p, LEVEL));
    assert_true(spread < 0.3 * (SIDE * SIDE - 1));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mutations_go_where_they_say),
        cmocka_unit_test(wrong_densities_are_seen),
        cmocka_unit_test(film_points_are_uniform_and_stratified),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

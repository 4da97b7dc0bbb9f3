/* Inverse sampling of whole paths: all techniques that can make a path get numbers with
 * which they make it again, vertex by vertex and with the same target. With ETALON_LONG a
 * million paths, and how far apart they are. */

#include "base/mem.h"
#include "chain/pss_jump.h"
#include "path/whole_path.h"
#include "support/inverse_sample.h"

#include <stdlib.h>

#define DEPTH      6
#define PATHS      3000
#define LONG_PATHS 70000

/* Differences of a vertex's place are in units of 2^-24 times the scene's size. They come
 * from the rounding of directions, which grows with the distance and with the inverse of
 * the cosine at which a surface is met, and is carried from vertex to vertex. What it can
 * be on plane surfaces,
 *     B_i = |x_i| + (distance + B_{i-1}) / cos_i   along each walk,
 * is the unit of `by rounding`; at curved and bumped surfaces directions turn as well.
 * Of all jumps PLACE_MOST may be beyond PLACE_ULPS (seen: .0013, and .012 with bumps
 * where events are not inverted once more from where the walk is), and OTHER_MOST may end
 * elsewhere, where rounding makes another path of it or changes its target by
 * PSS_JUMP_TOLERANCE (seen: 1 in 3000, with bumps). A wrong inverse is wrong for most
 * jumps. */
#define PLACE_ULPS 64.0
#define PLACE_MOST 0.004
#define OTHER_MOST 0.001
#define SIZE       4.5 /* of test scenes */

struct list {
    double *value;
    size_t count, capacity;
};

struct tried {
    long paths, blocked, jumps, refused, other, moved;
    double worst_target;
    struct list place, rounding; /* of each jump: in ulp, and by rounding */
};

static void list_add(struct list *list, double value)
{
    if (list->count == list->capacity) {
        list->capacity = 2 * list->capacity + 1024;
        list->value = mem_resize(list->value, list->capacity, sizeof *list->value);
    }
    list->value[list->count++] = value;
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double quantile(const struct list *list, double q)
{
    return list->value[(size_t)(q * (double)(list->count - 1))];
}

/* How far apart vertex i is; 0 where its place is a direction. */
static double apart(const struct whole_path *a, const struct whole_path *b, int i)
{
    if (vertex_is_direction(a->x[i], &a->scene->camera))
        return 0.0;
    struct vec3 d = vec3_sub(a->x[i]->hit.at.p, b->x[i]->hit.at.p);
    return sqrt((double)vec3_dot(d, d));
}

/* B of vertex i over 2^-24, if that of the vertex before it on the walk, at edge e, is
 * `before`. */
static double rounding_bound(const struct whole_path *p, int i, int e, double before)
{
    const struct hit *hit = &p->x[i]->hit;
    double cosine = fabs((double)vec3_dot(hit->at.ng, p->w[e]));
    double distance = fmin(1.0 / sqrt(p->inverse_square[e]), SIZE);
    return sqrt((double)vec3_dot(hit->at.p, hit->at.p)) + (distance + before) / cosine;
}

/* Adds the vertices that a walk makes, from `first` on by `step`. */
static void compare_walk(const struct whole_path *a, const struct whole_path *b,
                         int first, int end, int step, double *place, double *rounding)
{
    double bound = 0.0;
    for (int i = first; i != end; i += step) {
        double d = apart(a, b, i) * 0x1p24;
        bool starts = i == first || (d == 0.0 && bound == 0.0);
        bound = starts ? d : rounding_bound(b, i, step > 0 ? i - 1 : i, bound);
        *place = fmax(*place, d / SIZE);
        if (!starts)
            *rounding = fmax(*rounding, d / bound);
    }
}

static void compare(const struct whole_path *a, const struct whole_path *b,
                    struct tried *tried)
{
    double place = 0.0, rounding = 0.0;
    compare_walk(a, b, 0, b->s, 1, &place, &rounding);
    compare_walk(a, b, b->edges, b->s - 1, -1, &place, &rounding);
    tried->moved += place > PLACE_ULPS;
    list_add(&tried->place, place);
    list_add(&tried->rounding, rounding);
}

static void check_jump(const struct sample *from, const struct whole_path *path,
                       const struct techniques *techniques, int index, struct sample *to,
                       struct rng *rng, struct tried *tried)
{
    int t = techniques->t[index], old_t = path->edges + 1 - path->s;
    sample_clear(to);
    tried->jumps++;
    if (!invert_to(&from->paths, techniques, path->s, old_t, index, rng, &to->inverted,
                   found_of(to))) {
        tried->refused++;
        return;
    }
    keep(to, from);
    int made = estimate_mmlt_again(&to->paths, techniques, &to->numbers, &to->out);
    assert_int_equal(made, t);
    double error = fabs(to->out.target / from->out.target - 1.0);
    if (!(error < PSS_JUMP_TOLERANCE)) {
        tried->other++;
        return;
    }
    struct whole_path again;
    if (!whole_path_collect(&to->paths, techniques->length + 1 - t, t, &again)) {
        tried->blocked++;
        return;
    }
    compare(path, &again, tried);
    tried->worst_target = fmax(tried->worst_target, error);
}

static void check_length(const struct scene *scene, int length, struct rng *rng,
                         struct tried *tried)
{
    int count = getenv("ETALON_LONG") ? LONG_PATHS : PATHS;
    struct techniques techniques;
    struct sample from, to;
    techniques_init(&techniques, &scene->needs, length);
    sample_init(&from, scene, length, rng);
    sample_init(&to, scene, length, rng);
    for (int i = 0; i < count; i++) {
        struct whole_path path;
        double weight[DIMS_MAX_DEPTH + 1];
        sample_clear(&from);
        int t = estimate_mmlt_again(&from.paths, &techniques, &from.numbers, &from.out);
        if (!(from.out.target > 0.0))
            continue;
        tried->paths++;
        if (!whole_path_collect(&from.paths, length + 1 - t, t, &path)) {
            tried->blocked++;
            continue;
        }
        assert_true(whole_path_weights(&path, &techniques, weight));
        for (int k = 0; k < techniques.count; k++)
            if (weight[k] > 1e-4)
                check_jump(&from, &path, &techniques, k, &to, rng, tried);
    }
    sample_deinit(&from);
    sample_deinit(&to);
}

static void print_tried(const char *name, struct tried *t)
{
    qsort(t->place.value, t->place.count, sizeof *t->place.value, ascending);
    qsort(t->rounding.value, t->rounding.count, sizeof *t->rounding.value, ascending);
    printf(
        "%-13s %ld paths, blocked %ld, %ld jumps, refused %ld, other %ld; ulp, half "
        "%.3g, "
        ".99 %.3g, .999 %.3g, most %.3g, %ld beyond %g; by rounding .99 %.2g, .999 %.2g, "
        "most %.2g; target %.2g\n",
        name, t->paths, t->blocked, t->jumps, t->refused, t->other,
        quantile(&t->place, 0.5), quantile(&t->place, 0.99), quantile(&t->place, 0.999),
        quantile(&t->place, 1.0), t->moved, PLACE_ULPS, quantile(&t->rounding, 0.99),
        quantile(&t->rounding, 0.999), quantile(&t->rounding, 1.0), t->worst_target);
}

static void test_techniques_make_the_same_path(void **state)
{
    (void)state;
    for (int i = 0; i < TEST_CONTENTS; i++) {
        struct scene *scene = test_scene((enum test_contents)i, false);
        struct tried tried = {0};
        struct rng rng;
        rng_init(&rng, 31, RNG_TEST, (uint64_t)i);
        for (int length = 2; length <= DEPTH; length++)
            check_length(scene, length, &rng, &tried);
        print_tried(test_contents_name[i], &tried);
        assert_true(tried.jumps > 5000);
        assert_int_equal(tried.blocked + tried.refused, 0);
        assert_true((double)tried.other <= OTHER_MOST * (double)tried.jumps);
        assert_true((double)tried.moved <= PLACE_MOST * (double)tried.jumps);
        mem_free(tried.place.value);
        mem_free(tried.rounding.value);
        scene_destroy(scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_techniques_make_the_same_path),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}

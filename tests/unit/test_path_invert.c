/* Inverse sampling of whole paths: all techniques that can make a path get numbers with
 * which they make it again, vertex by vertex and with the same target. */

#include "chain/pss_jump.h"
#include "path/whole_path.h"
#include "support/inverse_sample.h"

#define DEPTH 6
#define PATHS 3000

/* Differences of a vertex's place are in units of 2^-24 times the largest coordinate.
 * They come from the rounding of directions, which grows with the distance, with the
 * inverse of the cosine at which a surface is met, and at curved and bumped surfaces at
 * each event. Of all jumps 2 % at most may be beyond PLACE_ULPS (seen: 1.3 %, with
 * bumps), and 1 in 1000 may end elsewhere, where rounding makes another path of it or
 * changes its target by PSS_JUMP_TOLERANCE (seen: 1 in 3000, with bumps). A wrong inverse
 * is wrong for most jumps. */
#define PLACE_ULPS 64.0
#define PLACE_MOST 0.02
#define OTHER_MOST 0.001

struct tried {
    long paths, blocked, jumps, refused, other, moved;
    double worst_place, worst_target;
};

/* Of all vertices that are places. */
static double apart(const struct whole_path *a, const struct whole_path *b)
{
    double most = 0.0;
    for (int i = 0; i <= a->edges; i++) {
        if (vertex_is_direction(a->x[i], &a->scene->camera))
            continue;
        struct vec3 d = vec3_sub(a->x[i]->hit.at.p, b->x[i]->hit.at.p);
        most = fmax(most, sqrt((double)vec3_dot(d, d)));
    }
    return most / (4.5 * 0x1p-24);
}

static void check_jump(const struct sample *from, const struct whole_path *path,
                       const struct techniques *techniques, int index, struct sample *to,
                       struct rng *rng, struct tried *tried)
{
    int t = techniques->t[index], old_t = path->edges + 1 - path->s;
    sample_clear(to);
    struct found found = found_of(to);
    tried->jumps++;
    if (!invert_to(&from->paths, techniques, path->s, old_t, index, rng, &found)) {
        tried->refused++;
        return;
    }
    keep(to, from, &found);
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
    double ulps = apart(path, &again);
    tried->moved += ulps > PLACE_ULPS;
    tried->worst_place = fmax(tried->worst_place, ulps);
    tried->worst_target = fmax(tried->worst_target, error);
}

static void check_length(const struct scene *scene, int length, struct rng *rng,
                         struct tried *tried)
{
    struct techniques techniques;
    struct sample from, to;
    techniques_init(&techniques, &scene->needs, length);
    sample_init(&from, scene, length, rng);
    sample_init(&to, scene, length, rng);
    for (int i = 0; i < PATHS; i++) {
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
        printf("%-13s %ld paths, blocked %ld, %ld jumps, refused %ld, other %ld, beyond "
               "%g ulp: %ld, "
               "worst %.3g ulp, target %.2g\n",
               test_contents_name[i], tried.paths, tried.blocked, tried.jumps,
               tried.refused, tried.other, PLACE_ULPS, tried.moved, tried.worst_place,
               tried.worst_target);
        assert_true(tried.jumps > 5000);
        assert_int_equal(tried.blocked + tried.refused, 0);
        assert_true((double)tried.other <= OTHER_MOST * (double)tried.jumps);
        assert_true((double)tried.moved <= PLACE_MOST * (double)tried.jumps);
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

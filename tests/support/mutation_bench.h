#ifndef ETALON_TESTS_SUPPORT_MUTATION_BENCH_H
#define ETALON_TESTS_SUPPORT_MUTATION_BENCH_H

/* Mutations of paths without a chain: one or some of them, in a kind of scene. */

#include "base/mem.h"
#include "integrator/mlt_state.h"
#include "support/water_scene.h"

#include <string.h>

#define DEPTH 6
enum { WATER = TEST_CONTENTS, POOL, SCENES };

static inline const char *name_of(int c)
{
    return c < TEST_CONTENTS ? test_contents_name[c] : c == WATER ? "water" : "pool";
}

static inline struct scene *scene_of(int c)
{
    return c < TEST_CONTENTS ? test_scene((enum test_contents)c, false)
                             : water_scene(c == POOL);
}

/* Which mutations are tried: all weight on one of them, or some on each. */
static const struct design {
    const char *name;
    double weights[MLT_MOVES];
    bool weighted;
    int first; /* shortest paths: those of two chains have four edges at least */
} designs[] = {
    {"lens", {1, 0, 0, 0}, false, 1},
    {"caustic", {0, 1, 0, 0}, false, 1},
    {"multichain", {0, 0, 1, 0}, false, 4},
    {"bidirectional, uniform", {0, 0, 0, 1}, false, 1},
    {"bidirectional, weighted", {0, 0, 0, 1}, true, 1},
    {"lens subpath", {0, 0, 0, 0, 1}, false, 1},
    {"numbers", {0, 0, 0, 0, 0, 1}, false, 1},
    {"all", {2, 1, 3, 1, 2, 2}, true, 1},
};
#define DESIGNS ((int)(sizeof designs / sizeof designs[0]))

/* A state without a chain. */
struct bench {
    struct path_space space;
    struct mlt_options options;
    struct rng rng;
    struct target target;
    struct state *state;
    struct contrib x, y;
};

static inline void bench_eval(void *ctx, const struct numbers *numbers,
                              struct contrib *out)
{
    full_path_sample(ctx, numbers, out);
}

static inline void bench_init(struct bench *b, const struct scene *scene,
                              const struct design *design, uint64_t index)
{
    *b = (struct bench){.options = {.scene = scene, .depth = DEPTH}};
    b->options.mutation = (struct mutation_options){{0.5, 12.0}, {0.01, 1.0}, false};
    if (design->first > 1) /* two chains in a row seldom bear such a turn */
        b->options.mutation = (struct mutation_options){{0.1, 6.0}, {0.001, 0.3}, false};
    memcpy(b->options.weights, design->weights, sizeof b->options.weights);
    kernel_init(&b->options.kernel, &kernel_exponential, 0.0, 0.01, 0.25);
    b->options.mutation.weighted = design->weighted;
    path_space_init(&b->space, scene, design->first, DEPTH);
    rng_init(&b->rng, 11, RNG_TEST, index);
    b->target = (struct target){bench_eval, &b->space};
    b->state = mem_alloc(1, state_mlt.size);
    *b->state = (struct state){
        .type = &state_mlt, .rng = &b->rng, .seed = 11, .chain = index};
    state_mlt.init(b->state, &b->options);
    state_mlt.rng_changed(b->state);
    contrib_init(&b->x, 1);
    contrib_init(&b->y, 1);
}

static inline void bench_deinit(struct bench *b)
{
    contrib_deinit(&b->x);
    contrib_deinit(&b->y);
    state_mlt.deinit(b->state);
    mem_free(b->state);
    path_space_deinit(&b->space);
}

/* An independent path becomes current; false if it carries nothing. */
static inline bool bench_draw(struct bench *b)
{
    state_mlt.propose(b->state, &b->target, MOVE_LARGE, &b->x);
    state_mlt.accept(b->state);
    return b->x.target > 0.0;
}

#endif

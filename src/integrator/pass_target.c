#include "integrator/pass_target.h"

#include "base/mem.h"

struct pass_target {
    struct subpaths paths;
    estimate_function estimate;
};

static void eval(void *ctx, const struct numbers *numbers, struct contrib *out)
{
    struct pass_target *t = ctx;
    t->estimate(&t->paths, numbers, out);
}

struct target pass_target_create(const struct scene *scene, int depth,
                                 estimate_function estimate)
{
    struct pass_target *t = mem_aligned(MEM_APART, 1, sizeof *t);
    subpaths_init(&t->paths, scene, depth);
    t->estimate = estimate;
    return (struct target){eval, t};
}

void pass_target_destroy(struct target *target)
{
    if (target->eval != eval)
        return;
    struct pass_target *t = target->ctx;
    subpaths_deinit(&t->paths);
    mem_free(t);
}

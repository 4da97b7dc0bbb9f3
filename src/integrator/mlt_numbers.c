#include "integrator/mlt_numbers.h"

#include "base/pack.h"

/* The numbers found, each moved by a small step; those that the path did not determine
 * are new. */
struct moved {
    struct ustream stream; /* must be first */
    const double *found;   /* by place */
    struct mlt_numbers *batch;
    const struct kernel *kernel;
    struct rng *rng;
    double values[USTREAM_MAX_COUNT];
};

static double displacement(struct moved *m)
{
    if (m->batch->left == 0) {
        m->kernel->type->draw(m->kernel, m->rng, m->batch->displacements);
        m->batch->left = KERNEL_BATCH;
    }
    return m->batch->displacements[--m->batch->left];
}

static const double *take(struct ustream *self, int place, int count)
{
    struct moved *m = (struct moved *)self;
    for (int i = 0; i < count; i++) {
        double u = m->found[place + i];
        m->values[i] = u < 0.0 ? rng_double(m->rng) : kernel_wrap(u + displacement(m));
    }
    return m->values;
}

static void refuse(struct contrib *out)
{
    contrib_clear(out);
    out->failure = FAILURE_INVERSE;
}

void mlt_numbers_propose(struct mlt_numbers *batch, const struct kernel *kernel,
                         struct rng *rng, struct path_space *space,
                         const struct full_path *x, struct contrib *out)
{
    struct found found;
    int t = full_path_technique(space, x, rng_double(rng));
    if (t == 0 || !full_path_invert(space, x, t, rng, &found)) {
        refuse(out);
        return;
    }
    struct moved camera = {{take}, found.camera.value, batch, kernel, rng, {0.0}};
    struct moved light = {{take}, found.light.value, batch, kernel, rng, {0.0}};
    struct numbers numbers = {&camera.stream, &light.stream, NULL};
    full_path_remake(space, &numbers, x->edges, t, out);
    if (out->target > 0.0 && !full_path_invert(space, &space->sampled, t, rng, &found))
        refuse(out);
}

void mlt_numbers_drop(struct mlt_numbers *batch)
{
    batch->left = 0;
}

void mlt_numbers_pack(struct pack *pack, struct mlt_numbers *batch)
{
    pack_int(pack, "displacements_left", &batch->left, 0, KERNEL_BATCH);
    pack_doubles(pack, "displacements", batch->displacements, KERNEL_BATCH);
}

/* Lens sub-path mutation [Veach97, section 11.4.4]: E S* D of a path E S* D (D|L) is
 * replaced by another of any length, which goes through a film position that is
 * stratified over all chains, and joined to the rest of the path. Lens and film position
 * are new, so that the proposal does not depend on what it replaces.
 *
 * The walk ends at the first vertex that it can be joined at; where a material has both,
 * delta lobes beside others, it ends there or takes a delta lobe, with equal chances. */

#include "path/mutation.h"

/* Whether a walk may end at a surface, and whether it may go on from there. */
static bool ends(const struct full_vertex *v)
{
    return (v->hit.bsdf->flags & BSDF_DELTA) == 0;
}

static bool goes_on(const struct full_vertex *v)
{
    unsigned flags = v->hit.bsdf->flags;
    return flags & BSDF_DELTA ||
           (flags & BSDF_SOME_DELTA && !(flags & BSDF_ONLY_STRAIGHT));
}

static bool suits(struct path_space *space, struct full_path *x)
{
    int first = mutation_camera_first(x);
    (void)space;
    return first < x->edges && !full_path_delta(x, first + 1);
}

/* Walks to the D vertex; its index, of at most `most`, or 0. */
static int walk(struct path_space *space, int most, struct mutation_random *random,
                struct full_path *y)
{
    mutation_new_lens(space, y, random->rng);
    film_points_next(&random->film, y->film);
    struct vec3 w = mutation_leave_lens(space, y);
    y->edges = most + 1; /* no light is to be hit before */
    for (int i = 1; i <= most; i++) {
        const struct full_vertex *v = &y->x[i];
        if (!mutation_follow(space, &y->x[i - 1].hit.at, w, NULL, i - 1, SIDE_CAMERA,
                             random->rng, y))
            return 0;
        if (ends(v) && (!goes_on(v) || rng_double(random->rng) < 0.5))
            return i;
        if (!mutation_leave_surface(space, y, i, SIDE_CAMERA, false, random->rng, &w) ||
            !v->delta)
            return 0;
    }
    return 0;
}

static struct scaled density(const struct full_path *to)
{
    int first = mutation_camera_first(to);
    struct scaled product = scaled(to->x[first].end[SIDE_CAMERA]);
    for (int i = 1; i <= first; i++) {
        const struct full_vertex *v = &to->x[i];
        double choice = ends(v) && goes_on(v) ? 0.5 : 1.0;
        product = scaled_by(product, choice * full_path_pdf(to, i, SIDE_CAMERA));
    }
    return product;
}

static enum failure propose(struct path_space *space, const struct mutation_options *o,
                            const struct full_path *x, struct mutation_random *random,
                            struct full_path *y, struct scaled *ratio)
{
    int kept = x->edges - mutation_camera_first(x); /* edges after D */
    (void)o, (void)ratio;
    full_path_copy_ends(y, x);
    int d = walk(space, space->last - kept, random, y);
    y->edges = d + kept;
    if (d == 0 || !(space->length_pdf[y->edges] > 0.0)) /* not sampled: not reached */
        return FAILURE_CAMERA_PATH;
    for (int i = 1; i <= kept; i++)
        y->x[d + i] = x->x[x->edges - kept + i];
    return mutation_finish(space, y, 0, d + 1, d + 1);
}

const struct mutation mutation_lens_subpath = {
    .name = "lens_subpath",
    .suits = suits,
    .propose = propose,
    .density = density,
};

/* Caustic perturbation [Veach97, section 11.4.3.2; CMU17]: (D|L) S* D E. The direction in
 * which light leaves (D|L) is turned, the chain of delta events traced anew up to D, and
 * this joined to the lens. From a light at infinity, whose direction is its place, the
 * ray is moved sideways instead. The angles do not depend on the path, so that this
 * kernel is symmetric too. */

#include "path/mutation.h"

/* The vertex that stays: the first after x[1] that is D or L. */
static int pivot(const struct full_path *path)
{
    int i = 2;
    while (full_path_delta(path, i))
        i++;
    return i;
}

static bool suits(struct path_space *space, struct full_path *x)
{
    if (x->edges < 2 || x->x[1].delta)
        return false;
    for (int i = 2; i < pivot(x); i++)
        if (!mutation_repeats(space, x, i, SIDE_LIGHT))
            return false;
    return true;
}

/* Another ray from vertex `from` of x. */
static struct vec3 move_ray(struct path_space *space, const struct mutation_options *o,
                            const struct full_path *x, int from, struct rng *rng,
                            struct ray_endpoint *start)
{
    const struct full_vertex *v = &x->x[from];
    struct vec3 w = vec3_neg(x->x[from - 1].edge.w);
    double distance = mutation_distance(o->angle, rng_double(rng)), u = rng_double(rng);
    const struct light *light = v->kind == VERTEX_LIGHT
                                    ? &space->paths.scene->lights[v->light]
                                    : NULL;
    *start = v->hit.at;
    if (!light || !light->infinite)
        return mutation_turn(w, distance, u);
    float far = (float)(-2.0 * light->sphere.radius);
    struct vec3 aside = mutation_offset(w, distance * light->sphere.radius, u);
    *start = (struct ray_endpoint){
        .p = vec3_add(vec3_mad(x->x[from - 1].hit.at.p, far, w), aside)};
    return w;
}

/* The transition density per area to the path `to`, but for the symmetric kernel. */
static struct scaled density(const struct full_path *to)
{
    struct scaled product = scaled(1.0);
    for (int i = pivot(to) - 1; i >= 1; i--) {
        product = scaled_by(product, full_path_conversion(to, i, SIDE_LIGHT));
        if (i > 1)
            product = scaled_by(product, mutation_lobe_pdf(to, i, SIDE_LIGHT));
    }
    return product;
}

static enum failure propose(struct path_space *space, const struct mutation_options *o,
                            const struct full_path *x, struct mutation_random *random,
                            struct full_path *y, struct scaled *ratio)
{
    int last = pivot(x);
    struct ray_endpoint start;
    struct vec3 w = move_ray(space, o, x, last, random->rng, &start);
    (void)ratio;
    full_path_copy(y, x);
    for (int i = last - 1; i >= 1; i--) {
        if (!mutation_follow(space, &start, w, x, i, SIDE_LIGHT, NULL, y) ||
            (i > 1 && !mutation_lobe(space, y, i, SIDE_LIGHT, &w)))
            return FAILURE_CLASS;
        start = y->x[i].hit.at;
    }
    return mutation_finish(space, y, 0, last, 1);
}

const struct mutation mutation_caustic = {
    .name = "caustic",
    .suits = suits,
    .propose = propose,
    .density = density,
};

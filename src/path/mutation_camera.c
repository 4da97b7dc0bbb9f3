/* Perturbation of the film position, and of the directions at D vertices that are
 * followed by S: the sub-path from the lens is traced anew through its chains of delta
 * events, up to the first D that is followed by (D|L), which is joined to the rest of the
 * path; or up to the light, if there is no such D. */

#include "math/warp.h"
#include "path/mutation.h"

int mutation_camera_first(const struct full_path *path)
{
    int i = 1;
    while (full_path_delta(path, i))
        i++;
    return i;
}

int mutation_camera_last(const struct full_path *path)
{
    int i = 1;
    while (i < path->edges && (full_path_delta(path, i) || full_path_delta(path, i + 1)))
        i++;
    return i;
}

bool mutation_camera_suits(struct path_space *space, struct full_path *x)
{
    int last = mutation_camera_last(x);
    if (last == x->edges && space->paths.scene->lights[x->x[last].light].delta_position)
        return false;
    for (int i = 1; i < last; i++)
        if (full_path_delta(x, i) && !mutation_repeats(space, x, i, SIDE_CAMERA))
            return false;
    return true;
}

/* Another film position and its ray; false outside the film. */
static bool move_film(struct path_space *space, const double range[2], struct rng *rng,
                      struct full_path *y, struct vec3 *w)
{
    const struct camera *camera = &space->paths.scene->camera;
    double distance = mutation_distance(range, rng_double(rng));
    struct vec2 round = warp_circle(rng_double(rng));
    y->film[0] += distance * round.x / camera->width;
    y->film[1] += distance * round.y / camera->height;
    if (!warp_in_square(y->film))
        return false;
    *w = mutation_leave_lens(space, y);
    return true;
}

/* Traces the sub-path up to vertex `last`. */
static bool trace(struct path_space *space, const struct mutation_options *o,
                  const struct full_path *x, int last, struct vec3 w, struct rng *rng,
                  struct full_path *y)
{
    for (int i = 0; i < last; i++) {
        if (i > 0 && x->x[i].delta) {
            if (!mutation_lobe(space, y, i, SIDE_CAMERA, &w))
                return false;
        } else if (i > 0) {
            double angle = mutation_distance(o->angle, rng_double(rng));
            w = mutation_turn(x->x[i].edge.w, angle, rng_double(rng));
        }
        if (!mutation_follow(space, &y->x[i].hit.at, w, x, i, SIDE_CAMERA, NULL, y))
            return false;
    }
    return true;
}

/* The transition density per area to the path `to`, but for the symmetric kernels: the
 * film position has one, and so have directions. */
struct scaled mutation_camera_density(const struct full_path *to)
{
    int last = mutation_camera_last(to);
    struct scaled product = scaled(to->pdf_film);
    for (int i = 1; i <= last; i++) {
        product = scaled_by(product, full_path_conversion(to, i, SIDE_CAMERA));
        if (i < last && to->x[i].delta)
            product = scaled_by(product, mutation_lobe_pdf(to, i, SIDE_CAMERA));
    }
    return product;
}

enum failure mutation_camera(struct path_space *space, const struct mutation_options *o,
                             const struct full_path *x, struct mutation_random *random,
                             struct full_path *y, struct scaled *ratio)
{
    int last = mutation_camera_last(x);
    struct vec3 w;
    (void)ratio;
    full_path_copy(y, x);
    if (!move_film(space, o->film, random->rng, y, &w))
        return FAILURE_CAMERA_PATH;
    if (!trace(space, o, x, last, w, random->rng, y))
        return FAILURE_CLASS;
    return mutation_finish(space, y, 0, last + 1, last + 1);
}

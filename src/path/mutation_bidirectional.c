/* Bidirectional mutation [Veach97, section 11.4.2; CMU17]: the vertices between x[l] and
 * x[m], -1 <= l < m <= k + 1, are deleted, and others added by walks of l' vertices from
 * x[l] and m' from x[m], whose ends are joined. l = -1: the lens is sampled anew; m = k +
 * 1: the light, or it is hit by the walk from x[l] (m' = 0).
 *
 * Counted in edges, m - l = k_d are deleted and k_a = l' + m' + 1 added. p_d1[k_d] is
 * .25, .5, 2^-k_d, and p_a1[k_a | k_d] .5, .15, .2 2^-j at distance j = |k_a - k_d|, both
 * normalised over what is possible; l' is uniform. Given k_d, l is uniform, or has a
 * probability in proportion to the density with which the deleted vertices would be added
 * again: w_{l,m} of [CMU17], where f is common to all l. The transition density is the
 * sum over l'. A path of which nothing is kept is left to independent sampling, and k_d =
 * k_a = 1 out, which changes nothing. */

#include "math/warp.h"
#include "path/mutation.h"

#include <float.h>
#include <stdlib.h>

/* --- densities of additions --------------------------------------------------------- */

/* The end vertex i of a walk from `side`: chance of ending there rather than passing it.
 */
static double end_of_walk(const struct full_path *path, int i, enum side side, bool added)
{
    bool inner = i > 0 && i < path->edges;
    return added && inner ? path->x[i].end[side] : 1.0;
}

/* The densities of one path, those of each vertex over the larger one, so that products
 * of many stay within range. */
struct densities {
    const struct full_path *path;
    double camera[DIMS_MAX_DEPTH + 1], light[DIMS_MAX_DEPTH + 1]; /* by vertex */
    struct scaled
        scale[DIMS_MAX_DEPTH + 2];     /* product of those of all vertices below i */
    double missing[2];                 /* see find_densities */
    bool connects[DIMS_MAX_DEPTH + 2]; /* the edge t-1 to t; or a hit light */
};

/* The density of a lens point, and that of a light without a place of its own, are not
 * per area. So that weights of deletions with and without them can be compared in any
 * unit of length, they have for another factor what is per area in a scene of this size.
 */
static void find_missing(const struct path_space *space, const struct full_path *path,
                         double missing[2])
{
    const struct scene *scene = space->paths.scene;
    const struct light *light = &scene->lights[path->x[path->edges].light];
    double size = hit_square_distance(scene->bounds_min, scene->bounds_max);
    missing[SIDE_CAMERA] = size > 0.0 ? 1.0 / size : 1.0;
    bool placed = !light->infinite && !light->delta_position;
    missing[SIDE_LIGHT] = placed ? 1.0 : missing[SIDE_CAMERA];
}

static void find_densities(const struct path_space *space, const struct full_path *path,
                           struct densities *d)
{
    d->path = path;
    d->scale[0] = scaled(1.0);
    for (int i = 0; i <= path->edges; i++) {
        /* The lens point is uniform: its density is left out of f as well. */
        double camera = i > 0 ? full_path_pdf(path, i, SIDE_CAMERA) : 1.0;
        double light = i > 0 ? full_path_pdf(path, i, SIDE_LIGHT) : 0.0;
        double scale = fmax(fmax(camera, light), DBL_MIN);
        d->camera[i] = camera / scale;
        d->light[i] = light / scale;
        d->scale[i + 1] = scaled_by(d->scale[i], scale);
        d->connects[i + 1] = full_path_connects(space, path, i + 1) > 0.0;
    }
    d->connects[0] = false; /* no light walk hits the lens */
    find_missing(space, path, d->missing);
}

/* Visits m = l + 1, l + 2, ... of one l: `sum` is the density of adding the vertices
 * between l and m, over all l', in units of their scale. */
struct addition {
    int l, m;
    double camera; /* all of them by the walk from x[l] */
    double ended;  /* the sum over walks from x[m] that are not empty, */
    double sum;    /* and over all */
};

/* The walk from x[l] adds all vertices below m, and is joined to x[m] or has hit a light.
 */
static void add_last(const struct densities *d, struct addition *a)
{
    bool exists = d->connects[a->m] && (a->l >= 0 || a->m > a->l + 1);
    double end = end_of_walk(d->path, a->m - 1, SIDE_CAMERA, a->m - 1 > a->l);
    a->sum = a->ended + (exists ? a->camera * end : 0.0);
}

static struct addition addition_begin(const struct densities *d, int l)
{
    struct addition a = {.l = l, .m = l + 1, .camera = 1.0};
    add_last(d, &a);
    return a;
}

static void addition_next(const struct densities *d, struct addition *a)
{
    /* x[m] is added by the walk from the new m now; the walk that ended below it is
     * joined to it as that walk's end. */
    double end = end_of_walk(d->path, a->m, SIDE_LIGHT, true);
    double joined = (a->sum - a->ended) * end;
    a->ended = (a->ended + joined) * d->light[a->m];
    a->camera *= d->camera[a->m];
    a->m++;
    add_last(d, a);
}

/* The sum as a density per area. */
static struct scaled addition_density(const struct densities *d, const struct addition *a)
{
    return scaled_by(scaled_div(d->scale[a->m], d->scale[a->l + 1]), a->sum);
}

/* The density, per area, of adding the vertices between l and m, over all l'. */
static struct scaled added_density(const struct densities *d, int l, int m)
{
    struct addition a = addition_begin(d, l);
    while (a.m < m)
        addition_next(d, &a);
    return addition_density(d, &a);
}

/* --- which vertices are deleted ----------------------------------------------------- */

#define DELETIONS (DIMS_MAX_DEPTH + 2) /* values of k_d, from 1 on, and of l + 1 */

struct deletions {
    int most;                          /* k_d */
    double length[DELETIONS + 1], all; /* p_d1 of each k_d, and their sum */
    bool weighted;                     /* else the next two are not used */
    /* Of [k_d][l + 1]; 0: impossible. */
    struct scaled weight[DELETIONS + 1][DELETIONS];
    struct scaled greatest[DELETIONS + 1];
    double sum[DELETIONS + 1]; /* in units of the greatest; uniform: of ones */
};

/* Nothing would be kept, or no vertex deleted at an end: the way back does not exist. */
static bool impossible(int k, int l, int m)
{
    return (l < 0 && m > k) || l == k || m == 0;
}

static struct scaled deletion_weight(const struct densities *d, const struct addition *a)
{
    if (impossible(d->path->edges, a->l, a->m))
        return scaled(0.0);
    double missing = a->l < 0 ? d->missing[SIDE_CAMERA] : 1.0;
    missing *= a->m > d->path->edges ? d->missing[SIDE_LIGHT] : 1.0;
    return scaled_normal(scaled_by(addition_density(d, a), missing));
}

static void weigh_deletions(const struct densities *d, struct deletions *out)
{
    int k = d->path->edges;
    for (int l = -1; l <= k; l++) {
        struct addition a = addition_begin(d, l);
        for (;; addition_next(d, &a)) {
            out->weight[a.m - l][l + 1] = deletion_weight(d, &a);
            if (a.m > k)
                break;
        }
    }
}

static bool less(struct scaled a, struct scaled b)
{
    return a.m == 0.0 || b.m == 0.0 || a.e == b.e ? a.m < b.m : a.e < b.e;
}

/* The greatest weight of so many edges, and the sum in its units. */
static void sum_weights(struct deletions *d, int edges)
{
    const struct scaled *w = d->weight[edges];
    int last = d->most + 1 - edges;
    d->greatest[edges] = w[0];
    d->sum[edges] = 0.0;
    for (int i = 1; i <= last; i++)
        if (less(d->greatest[edges], w[i]))
            d->greatest[edges] = w[i];
    for (int i = 0; i <= last && d->greatest[edges].m > 0.0; i++)
        d->sum[edges] += scaled_ratio(w[i], d->greatest[edges]);
}

/* Number of possible l: those from -1 to k + 1 - n, but for n = 1 not both ends. */
static double count_deletions(const struct deletions *d, int edges)
{
    return edges == 1 ? d->most - 1 : d->most + 2 - edges;
}

static void find_deletions(const struct densities *d, bool weighted,
                           struct deletions *out)
{
    out->most = d->path->edges + 1;
    out->all = 0.0;
    out->weighted = weighted;
    if (weighted)
        weigh_deletions(d, out);
    for (int n = 1; n <= out->most; n++) {
        if (weighted)
            sum_weights(out, n);
        else
            out->sum[n] = count_deletions(out, n);
        /* p_d1 [CMU17]. */
        double law = n == 1 ? 0.25 : n == 2 ? 0.5 : scaled_power(-n);
        out->length[n] = out->sum[n] > 0.0 ? law : 0.0;
        out->all += out->length[n];
    }
}

/* The weight of x[l], x[l + n], in units of the greatest of n edges. */
static double relative_weight(const struct deletions *d, int l, int n)
{
    if (d->weighted)
        return scaled_ratio(d->weight[n][l + 1], d->greatest[n]);
    return impossible(d->most - 1, l, l + n) ? 0.0 : 1.0;
}

/* p_d[l, m]; 0 if it is impossible. */
static double deletion_probability(const struct deletions *d, int l, int m)
{
    int n = m - l;
    if (!(d->length[n] > 0.0))
        return 0.0;
    return d->length[n] / d->all * relative_weight(d, l, n) / d->sum[n];
}

/* Index of a weight drawn in proportion; -1 if all are 0. */
static int draw_weight(const double *weights, int count, double u, double sum)
{
    int choice = -1;
    u *= sum;
    for (int i = 0; i < count; i++) {
        if (!(weights[i] > 0.0))
            continue;
        choice = i;
        if (u < weights[i])
            break;
        u -= weights[i];
    }
    return choice;
}

/* False if nothing can be deleted. */
static bool draw_deletion(const struct deletions *d, struct rng *rng, int *l, int *m)
{
    double weights[DELETIONS], u = rng_double(rng), v = rng_double(rng);
    int n = draw_weight(d->length + 1, d->most, u, d->all) + 1, count = d->most + 2 - n;
    if (n < 1)
        return false;
    for (int i = 0; i < count; i++)
        weights[i] = relative_weight(d, i - 1, n);
    *l = draw_weight(weights, count, v, d->sum[n]) - 1;
    *m = *l + n;
    return true;
}

/* --- how many are added ------------------------------------------------------------- */

/* p_a1 before it is normalised. kept: edges of the path that are not deleted; ends: the
 * lens or the light is, so that one vertex at least must be added. */
static double addition_weight(const struct path_space *space, int kept, bool ends,
                              int deleted, int added)
{
    int length = kept + added, apart = abs(added - deleted);
    if (added < (ends ? 2 : 1) || (added == 1 && deleted == 1) || length < space->first ||
        length > space->last || !(space->length_pdf[length] > 0.0))
        return 0.0;
    return apart == 0 ? 0.5 : apart == 1 ? 0.15 : 0.2 * scaled_power(-apart);
}

static double all_additions(const struct path_space *space, int kept, bool ends,
                            int deleted)
{
    double sum = 0.0;
    for (int added = 1; kept + added <= space->last; added++)
        sum += addition_weight(space, kept, ends, deleted, added);
    return sum;
}

/* 0 if none is possible. */
static int draw_addition(const struct path_space *space, struct rng *rng, int kept,
                         bool ends, int deleted)
{
    double weights[DIMS_MAX_DEPTH + 1], sum = 0.0;
    int count = 0;
    for (int added = 1; kept + added <= space->last && count < DIMS_MAX_DEPTH + 1;
         added++)
        sum += weights[count++] = addition_weight(space, kept, ends, deleted, added);
    return draw_weight(weights, count, rng_double(rng), sum) + 1;
}

/* p_a[l', m'], the same for all l'; the lens is never hit, so l' > 0 for l = -1. */
static double addition_probability(const struct path_space *space, int kept, bool ends,
                                   int l, int deleted, int added)
{
    return addition_weight(space, kept, ends, deleted, added) /
           all_additions(space, kept, ends, deleted) / (added - (l < 0));
}

/* Of deleting as many vertices after l, and adding as many. */
static double choice_probability(const struct path_space *space,
                                 const struct deletions *deletions, int kept, bool ends,
                                 int l, int deleted, int added)
{
    return deletion_probability(deletions, l, l + deleted) *
           addition_probability(space, kept, ends, l, deleted, added);
}

struct scaled mutation_bidirectional_density(const struct path_space *space,
                                             bool weighted, const struct full_path *from,
                                             int l, int m, const struct full_path *to)
{
    struct densities densities;
    struct deletions deletions;
    int deleted = m - l, kept = from->edges - deleted, added = to->edges - kept;
    find_densities(space, from, &densities);
    find_deletions(&densities, weighted, &deletions);
    find_densities(space, to, &densities);
    bool ends = l < 0 || m > from->edges;
    return scaled_by(
        added_density(&densities, l, l + added),
        choice_probability(space, &deletions, kept, ends, l, deleted, added));
}

/* --- the mutation ------------------------------------------------------------------- */

/* y begins as what is kept of x: x[0..l], and x[m..] moved by the change of length. */
static void keep(const struct full_path *x, int l, int m, int added, struct full_path *y)
{
    full_path_copy_ends(y, x);
    y->edges = x->edges - (m - l) + added;
    for (int i = 0; i <= l; i++)
        y->x[i] = x->x[i];
    for (int i = m; i <= x->edges; i++)
        y->x[i - m + l + added] = x->x[i];
}

static enum failure propose(struct path_space *space, const struct mutation_options *o,
                            const struct full_path *x, struct mutation_random *random,
                            struct full_path *y, struct scaled *ratio)
{
    struct rng *rng = random->rng;
    struct densities dx, dy;
    struct deletions deletions;
    int l, m;
    find_densities(space, x, &dx);
    find_deletions(&dx, o->weighted, &deletions);
    if (!draw_deletion(&deletions, rng, &l, &m))
        return FAILURE_ZERO;
    int deleted = m - l, kept = x->edges - deleted;
    bool ends = l < 0 || m > x->edges;
    int added = draw_addition(space, rng, kept, ends, deleted);
    if (added == 0)
        return FAILURE_ZERO;
    int least = l < 0;
    int from_lens = least + (int)(rng_double(rng) * (added - least)); /* l' */
    double there = choice_probability(space, &deletions, kept, ends, l, deleted, added);
    keep(x, l, m, added, y);
    int end = l + added, t = l + from_lens + 1; /* the new m */
    if (!mutation_walk_camera(space, y, l, t - 1, rng))
        return FAILURE_CAMERA_PATH;
    if (!mutation_walk_light(space, y, end, t, rng))
        return FAILURE_LIGHT_PATH;
    enum failure failure = mutation_finish(space, y, l, end, t);
    if (failure != FAILURE_NONE)
        return failure;
    find_densities(space, y, &dy);
    find_deletions(&dy, o->weighted, &deletions);
    double back = choice_probability(space, &deletions, kept, ends, l, added, deleted);
    struct scaled quotient = scaled_div(added_density(&dx, l, m),
                                        added_density(&dy, l, end));
    *ratio = scaled_by(quotient, back / there);
    return ratio->m > 0.0 ? FAILURE_NONE : FAILURE_ZERO;
}

static bool suits(struct path_space *space, struct full_path *x)
{
    (void)space, (void)x;
    return true;
}

const struct mutation mutation_bidirectional = {
    .name = "bidirectional",
    .suits = suits,
    .propose = propose,
};

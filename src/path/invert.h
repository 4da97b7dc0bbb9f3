#ifndef ETALON_PATH_INVERT_H
#define ETALON_PATH_INVERT_H

/* Inverse sampling of multiplexed paths [Bitterli18]: the numbers with which another
 * technique makes the same path. Let P_t be the density of technique t and f the chain's
 * target. With the balance heuristic f = C / sum P_t has the same value whichever of the
 * techniques made the path. Over all numbers, those of the choice of the technique
 * included, the chain's density is f, so that of the path made by t is f P_t. A jump to t
 * drawn in proportion to P_t, that is by its weight in MIS, is therefore accepted with
 * probability 1, if the new numbers have the law that uniform numbers have given the
 * path: a Gibbs step on the technique. What the techniques have in common keeps its
 * numbers; those of the vertices that change sides are inverted, with new ones for what
 * is lost [Pantaleoni17]; all others are drawn anew. The number of a lobe is that of the
 * decisions before it to go straight through surfaces (path/passage.h) too.
 *
 * Directions are rounded, and at curved surfaces an error grows from vertex to vertex. So
 * each event is inverted twice: before the jump, which tells whether there are numbers,
 * and when the new walk asks for them, from its vertex to where the next one was.
 *
 * Not inverted is a delta event of which two lobes may be the cause. */

#include "math/found_numbers.h"
#include "path/whole_path.h"

/* A path as it was when its numbers were found; `paths` makes it again. */
struct inverted {
    const struct subpaths *paths;
    struct rng *rng;
    int edges;
    struct {
        struct vec3 p, to_light; /* to_light: direction of the edge from it */
        bool is_direction, delta;
    } x[DIMS_MAX_DEPTH + 1]; /* x[0] on the light, as in path/whole_path.h */
};

/* The numbers for the path of `current` by a technique drawn by the balance heuristic's
 * weights. Evaluates `current` again, into *again. */
enum inversion invert_mmlt(struct subpaths *paths, const struct techniques *techniques,
                           const struct numbers *current, struct rng *rng,
                           struct inverted *inverted, struct found *found,
                           struct contrib *again);

/* The same for the path that s light and t camera vertices of the sub-paths make, and for
 * the technique of that index. */
bool invert_to(const struct subpaths *paths, const struct techniques *techniques, int s,
               int t, int index, struct rng *rng, struct inverted *inverted,
               struct found *found);

/* All numbers of the technique with s light and t camera vertices for this path, of which
 * vertices, directions and `pass` are read. False if there are none. */
bool invert_all(const struct whole_path *path, int s, int t, struct rng *rng,
                struct found *found);

#endif

#ifndef ETALON_PATH_BLIND_H
#define ETALON_PATH_BLIND_H

/* Paths that a set of techniques cannot sample at all, known before a run. Families are
 * written as by Heckbert, from the light to the eye, L (S|D)* E [Veach97, section 8.3.1]:
 * S is a delta event, D any other. All families begin at delta lights (point, spot,
 * distant): any other light can be hit by chance (s = 0), whatever lies between.
 *
 * A technique (s,t) connects two neighbours of the path, neither of which may be S. For a
 * delta light the pairs are LD (s = 1), DE (t = 1) and DD (s, t >= 2): a path without
 * such a pair has density 0 under all techniques. LE would be (1,1), which is not used: a
 * delta light seen directly is a single point of a pinhole's film, which is left out of
 * the picture, but a disk with a lens. */

#include "scene/needs.h"

/* Sets of techniques. */
enum technique_kind {
    TECHNIQUE_HIT = 1,      /* s = 0 */
    TECHNIQUE_LIGHT = 2,    /* s = 1, t >= 2 */
    TECHNIQUE_CAMERA = 4,   /* s >= 2, t = 1 */
    TECHNIQUE_SURFACES = 8, /* s, t >= 2 */
};
#define TECHNIQUES_PT   (TECHNIQUE_HIT | TECHNIQUE_LIGHT)
#define TECHNIQUES_BDPT (TECHNIQUES_PT | TECHNIQUE_CAMERA | TECHNIQUE_SURFACES)

struct blind_family {
    const char *paths;          /* Heckbert's notation, a regular expression */
    const char *words;          /* description of its light */
    int edges;                  /* edges of the shortest path */
    bool lens, specular, rough; /* features that the scene must have */
    unsigned seen_by;           /* techniques each of which can sample all of it */
};

#define BLIND_FAMILIES 5
#define BLIND_TEXT     128 /* of blind_text */

/* The families that a scene with these needs may have, with at most max_depth edges, and
 * that `techniques` cannot sample. No path is in two families. techniques must include
 * TECHNIQUES_PT, and TECHNIQUE_CAMERA if it includes TECHNIQUE_SURFACES. needs: from
 * needs_of_desc, which keep_all does not change. Returns their number. */
int blind_find(const struct needs *needs, unsigned techniques, int max_depth,
               const struct blind_family *found[BLIND_FAMILIES]);

/* Their paths, comma-separated; "" if there are none. */
void blind_text(const struct needs *needs, unsigned techniques, int max_depth,
                char text[BLIND_TEXT]);

#endif

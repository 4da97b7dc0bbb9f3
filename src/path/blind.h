#ifndef ETALON_PATH_BLIND_H
#define ETALON_PATH_BLIND_H

/* Paths that a set of techniques cannot sample at all, known before a run. Families are
 * written as by Heckbert, from the light to the eye, L (S|D)* E [Veach97, section 8.3.1]:
 * S is a delta event, D any other. All are of delta lights (point, spot, distant): any
 * other light is hit by chance (s = 0), whatever is between.
 *
 * A technique (s,t) joins two neighbours of the path by a connection, and neither of them
 * may be S. Of a delta light these are LD (s = 1), DE (t = 1) and DD (s, t >= 2): a path
 * without such a pair has density 0 under all of them. LE is (1,1), which nothing uses:
 * a delta light seen directly is a point of a pinhole's film and no part of a picture
 * here, but a disk where there is a lens. */

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
    const char *words;          /* what is seen of it */
    int edges;                  /* of the shortest */
    bool lens, specular, rough; /* what there must be in the scene */
    unsigned seen_by;           /* techniques of which any samples all of it */
};

#define BLIND_FAMILIES 5
#define BLIND_TEXT     128 /* of blind_text */

/* The families that a scene with these needs may have, on at most max_depth edges, and
 * that `techniques` cannot sample; no path is in two of them. techniques holds at least
 * TECHNIQUES_PT, and TECHNIQUE_CAMERA if it holds TECHNIQUE_SURFACES. Needs: those of
 * needs_of_desc, which keep_all does not raise. Returns how many. */
int blind_find(const struct needs *needs, unsigned techniques, int max_depth,
               const struct blind_family *found[BLIND_FAMILIES]);

/* Their paths, comma-separated; "" if there are none. */
void blind_text(const struct needs *needs, unsigned techniques, int max_depth,
                char text[BLIND_TEXT]);

#endif

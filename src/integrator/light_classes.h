#ifndef ETALON_INTEGRATOR_LIGHT_CLASSES_H
#define ETALON_INTEGRATOR_LIGHT_CLASSES_H

/* The classes of light of which a run keeps pictures of their own beside the whole one:
 * by path length, or by technique (s,t). A class is either light image (t = 1) or none of
 * it, as passes normalise the two apart; of a length there are two classes, then. */

#include "image/image.h"
#include "image/layers.h"
#include "settings/settings.h"

/* Lengths with pictures of their own: the longest one, and of techniques. What is beyond
 * is one picture, the rest. */
#define LIGHT_LENGTHS_MOST    8
#define LIGHT_TECHNIQUES_MOST 6
#define LIGHT_CLASSES_MOST    (2 * LIGHT_LENGTHS_MOST + LIGHT_TECHNIQUES_MOST * 5)

struct light_classes {
    int count;                            /* 0: no class is kept */
    int depth;                            /* edges of the longest path of the run */
    bool lengths, techniques, unweighted; /* the layers asked for */
    int8_t of[LIGHT_LENGTHS_MOST + 2][LIGHT_LENGTHS_MOST + 2]; /* [s][t]; -1: none */
    struct light_class {
        int length, s, t; /* s, t of one technique of the class */
        bool technique;   /* it is the only one */
    } list[LIGHT_CLASSES_MOST];
};

/* depth: longest path, edges. */
void light_classes_init(struct light_classes *classes, const struct settings *settings,
                        int depth);

/* The class of a splat; -1 if it is in none. */
static inline int light_class(const struct light_classes *classes, int s, int t)
{
    return s + t <= LIGHT_LENGTHS_MOST + 1 ? classes->of[s][t] : -1;
}

/* The layers into which a class adds its picture ("length_3.R", "technique_s1_t2.R"), of
 * which there are up to two. Adds rgb, [pixels][3], to them. */
void light_classes_add(const struct light_classes *classes, int class, const double *rgb,
                       size_t pixels, struct layers *layers);
/* The same for the picture of a technique without its MIS weight
 * ("unweighted_s1_t2.R"). */
void light_classes_add_unweighted(const struct light_classes *classes, int class,
                                  const double *rgb, size_t pixels,
                                  struct layers *layers);
/* What the layers of lengths, and those of techniques, leave of the picture
 * ("length_rest.R"), where paths may be longer than theirs. */
void light_classes_add_rest(const struct light_classes *classes,
                            const struct image *picture, struct layers *layers);

#endif

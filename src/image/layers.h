#ifndef ETALON_IMAGE_LAYERS_H
#define ETALON_IMAGE_LAYERS_H

/* Named layers of a run beside its picture, by pixel, in the order in which they were
 * added. A name is that of an EXR channel: "se.Y", "failures.Y". */

#include <stddef.h>

#define LAYERS_MOST 8

struct layer {
    const char *name;    /* not copied */
    const float *values; /* [height][width] */
    float *owned;        /* `values` if the list frees them, else NULL */
};

struct layers {
    struct layer list[LAYERS_MOST];
    int count;
};

/* A layer of `pixels` zeros that the list owns. */
float *layers_add(struct layers *layers, const char *name, size_t pixels);
/* A layer that the caller owns; nothing if values is NULL. */
void layers_refer(struct layers *layers, const char *name, const float *values);
/* NULL if there is none of that name. */
const float *layers_find(const struct layers *layers, const char *name);
void layers_deinit(struct layers *layers);

#endif

#ifndef ETALON_IMAGE_LAYERS_H
#define ETALON_IMAGE_LAYERS_H

/* Named layers of a run beside its picture, by pixel, in the order in which they were
 * added. A name is that of an EXR channel: "se.Y", "failures.Y". */

#include <stddef.h>

#define LAYER_NAME_SIZE 32 /* an EXR channel's name has 31 characters at most */

struct layer {
    char name[LAYER_NAME_SIZE];
    const float *values; /* [height][width] */
    float *owned;        /* `values` if the list frees them, else NULL */
};

/* Zero-initialise. */
struct layers {
    struct layer *list; /* [count] */
    int count;
    size_t capacity;
};

/* A layer of `pixels` values that the list owns: zeros, or the one of that name if there
 * is one already. */
float *layers_add(struct layers *layers, const char *name, size_t pixels);
/* A layer that the caller owns; nothing if values is NULL. */
void layers_refer(struct layers *layers, const char *name, const float *values);
/* NULL if there is none of that name. */
const float *layers_find(const struct layers *layers, const char *name);
void layers_deinit(struct layers *layers);

#endif

#ifndef ETALON_LAB_PRODUCT_H
#define ETALON_LAB_PRODUCT_H

/* All combinations of the choices that an experiment gives one of its scenes and one of
 * its variants. */

#include "lab/experiment.h"

/* The axes of the scene and variant. An axis hides later ones of the same name, so the
 * more specific ones come first. */
struct product {
    const struct axis **axes;
    size_t *at; /* index of the current choice on each axis, initially 0 */
    size_t count, capacity;
};

void product_init(struct product *product, const struct experiment *experiment,
                  const struct experiment_scene *scene,
                  const struct experiment_variant *variant);
void product_deinit(struct product *product);

/* Steps to the next combination, the last axis fastest. False after the last one. */
bool product_next(struct product *product);
/* Number of combinations, counted up to `most`. */
size_t product_size(const struct product *product, size_t most);
const struct choice *product_taken(const struct product *product, size_t axis);

#endif

#ifndef ETALON_LAB_PRODUCT_H
#define ETALON_LAB_PRODUCT_H

/* All combinations of the choices that an experiment gives one of its scenes and one of
 * its variants. */

#include "lab/experiment.h"

/* The axes that hold for them: the nearer ones first, which hide those of the same name
 * that come after. */
struct product {
    const struct axis **axes;
    size_t *at; /* the choice taken of each; the first ones at the beginning */
    size_t count, capacity;
};

void product_init(struct product *product, const struct experiment *experiment,
                  const struct experiment_scene *scene,
                  const struct experiment_variant *variant);
void product_deinit(struct product *product);

/* The next combination: the last axis runs fastest. False when all are through. */
bool product_next(struct product *product);
/* How many there are, counted up to `most`. */
size_t product_size(const struct product *product, size_t most);
const struct choice *product_taken(const struct product *product, size_t axis);

#endif

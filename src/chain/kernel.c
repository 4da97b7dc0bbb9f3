#include "chain/kernel.h"

#include "chain/kernel_math.h"

#include <assert.h>
#include <stddef.h>
#include <string.h>

const struct kernel_type *const kernel_types[] = {
    &kernel_exponential,
    &kernel_gaussian,
    NULL,
};

const struct kernel_type *kernel_find(const char *name)
{
    for (int i = 0; kernel_types[i]; i++) {
        if (strcmp(kernel_types[i]->name, name) == 0)
            return kernel_types[i];
    }
    return NULL;
}

void kernel_init(struct kernel *k, const struct kernel_type *type, double sigma,
                 double s1, double s2)
{
    *k = (struct kernel){
        .type = type,
        .sigma = sigma > 0.0 ? sigma : KERNEL_SIGMA,
        .s1 = s1 > 0.0 ? s1 : KERNEL_S1,
        .s2 = s2 > 0.0 ? s2 : KERNEL_S2,
        .second_stage = type->log_density ? KERNEL_SECOND_STAGE : 1,
    };
    assert(k->s1 <= k->s2);
    k->log_ratio = log(k->s2 / k->s1);
    k->log_norm = log(k->sigma * sqrt(2.0 * KERNEL_PI));
}

#ifndef ETALON_PATH_ESTIMATE_JOIN_H
#define ETALON_PATH_ESTIMATE_JOIN_H

/* For estimate_pt.c and estimate_bdpt.c. */

#include "image/contrib.h"

/* Sets the target to what it is with the splats of t >= 2 summed into one: first the
 * luminances of the light image, then that of the sum, in the order of the splats. */
static inline void estimate_join_techniques(struct contrib *out)
{
    struct rgb sum = {0.0, 0.0, 0.0};
    out->target = 0.0;
    for (int i = 0; i < out->count; i++) {
        if (out->splats[i].t == 1)
            out->target += rgb_luminance(out->splats[i].value);
        else
            sum = rgb_add(sum, out->splats[i].value);
    }
    out->target += rgb_luminance(sum);
}

#endif

#ifndef ETALON_TESTS_SUPPORT_BSDF_MAKE_H
#define ETALON_TESTS_SUPPORT_BSDF_MAKE_H

/* Materials and directions for tests. */

#include "surface/bsdf.h"

#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

/* A prepared material: bsdf_make("dielectric", "eta", 1.3, NULL). Numbers only; a colour
 * becomes grey. Aborts on what cannot be set. */
static inline struct bsdf bsdf_make(const char *kind, ...)
{
    struct bsdf bsdf;
    bsdf_init(&bsdf, bsdf_find(kind));
    va_list list;
    va_start(list, kind);
    for (const char *name; (name = va_arg(list, const char *));) {
        double value = va_arg(list, double);
        if (!bsdf_set(&bsdf, name, &value, 1, NULL, NULL))
            abort();
    }
    va_end(list);
    if (!bsdf_prepare(&bsdf, NULL, NULL))
        abort();
    return bsdf;
}

/* One that holds others (NULL: none), which must live as long: "blend" with the weight of
 * b, or "sides". */
static inline struct bsdf bsdf_make_pair(const char *kind, const struct bsdf *a,
                                         const struct bsdf *b, double weight)
{
    struct bsdf bsdf;
    bsdf_init(&bsdf, bsdf_find(kind));
    bsdf.child[0] = a;
    bsdf.child[1] = b;
    if (bsdf_param_find(bsdf.type, "weight") &&
        !bsdf_set(&bsdf, "weight", &weight, 1, NULL, NULL))
        abort();
    if (!bsdf_prepare(&bsdf, NULL, NULL))
        abort();
    return bsdf;
}

/* The unit vector with this cosine to the normal and this azimuth. */
static inline struct vec3 bsdf_direction(double cosine, double phi)
{
    double sine = sqrt((1.0 - cosine) * (1.0 + cosine));
    return vec3((float)(sine * cos(phi)), (float)(sine * sin(phi)), (float)cosine);
}

#endif

#ifndef ETALON_SURFACE_DIRECTION_H
#define ETALON_SURFACE_DIRECTION_H

/* Directions in double for microfacet code: at alpha = 1e-5 the rounding error of a float
 * half vector would be a percent of the lobe's width. */

#include "math/vec3.h"

struct direction {
    double x, y, z;
};

/* The length of a float unit vector has an error of 1e-7, which would tilt half vectors;
 * one Newton step of 1/sqrt reduces it to 1e-14. */
static inline struct direction direction_from(struct vec3 w)
{
    double x = (double)w.x, y = (double)w.y, z = (double)w.z;
    double s = 1.5 - 0.5 * (x * x + y * y + z * z);
    return (struct direction){x * s, y * s, z * s};
}

static inline struct vec3 direction_to_vec3(struct direction w)
{
    return (struct vec3){(float)w.x, (float)w.y, (float)w.z};
}

static inline double direction_dot(struct direction a, struct direction b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct direction direction_scale(struct direction a, double s)
{
    return (struct direction){a.x * s, a.y * s, a.z * s};
}

/* a + s b */
static inline struct direction direction_mad(struct direction a, double s,
                                             struct direction b)
{
    return (struct direction){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

/* o mirrored in the plane across h: 2 (o.h) h - o [Walter07 Eq. 39]. */
static inline struct direction direction_reflect(struct direction o, struct direction h)
{
    return direction_mad(direction_scale(o, -1.0), 2.0 * direction_dot(o, h), h);
}

/* Mirrored in the surface: microfacets look the same from both sides. */
static inline struct direction direction_flip(struct direction w)
{
    return (struct direction){w.x, w.y, -w.z};
}

#endif

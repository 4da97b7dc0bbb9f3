#ifndef ETALON_SCENE_HIT_FILL_H
#define ETALON_SCENE_HIT_FILL_H

/* Fills in a hit: place, shading frame (aligned with the parameters, or turned by a bump
 * or normal map, if the BSDF asks for that) and, with needs.uv, the parameters. */

#include "scene/instance.h"
#include "scene/shape.h"

/* At (b1, b2), the weights of corners 1 and 2. */
void hit_fill_triangle(const struct shape *shape, uint32_t triangle, float b1, float b2,
                       bool uv, struct hit *hit);
void hit_fill_quadric(const struct shape *shape, const struct quadric_hit *q, bool uv,
                      struct hit *hit);

/* The same for what lies in the object's space. */
void hit_fill_triangle_instance(const struct instance *instance,
                                const struct shape *shape, uint32_t triangle, float b1,
                                float b2, bool uv, struct hit *hit);
void hit_fill_quadric_instance(const struct instance *instance, const struct shape *shape,
                               const struct quadric_hit *q, bool uv, struct hit *hit);

#endif

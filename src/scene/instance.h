#ifndef ETALON_SCENE_INSTANCE_H
#define ETALON_SCENE_INSTANCE_H

/* Instances: objects (groups of shapes) as rays see them where they were put. A ray is
 * taken into the object's space, and what it finds there back into the world's, both in
 * doubles that are rounded to floats once.
 *
 * Rounding, with e = 2^-24, M to_world, W its inverse, and the normals n = W^T m / |W^T
 * m| in the world and m in the object. What is off by d along m is off by d / |W^T m|
 * along n. In the object's space a place is rounded, and so is the origin of a ray from
 * there: m e 2 P along m, P its coordinates; that is what the object's own offset allows
 * for (scene/triangle.h). In the world, place and origin are rounded too, n e 2 p, and so
 * is the normal, by which a ray is told to be on the one side, n e 4 E across a surface
 * of extents E. So the offset is the object's over |W^T m| and, twice the sum again, n e
 * (4 p
 * + 8 E). Inside, the direction is rounded: across a triangle a ray drifts by m e times
 * its extents, which the triangle's own bound leaves room for; a quadric has no such
 * part, so it gets one, from its size. At the far end of a segment d the drift is e |m|
 * |W d|, and the five roundings that ACCEL_FAR_END knows are now along components in the
 * object's space: six in all, three times that, at most 18 e |W| |d| / |W^T m| along n,
 * |W| the largest stretch (or a bound of it, up to sqrt3 more). */

#include "base/err.h"
#include "math/xform.h"
#include "scene/hit.h"

#define INSTANCE_FAR_END 0x1.2p-20f /* 18 e */

struct instance {
    double to_world[3][4], to_object[3][4];
    double stretch; /* no direction grows by more in to_object */
    int object;
    float lower[3], upper[3]; /* world space, with room for rounding */
    const struct place *place;
};

/* Whether floats hold what the transform makes of rays: scales within 2^-16 and 2^16, and
 * no more than 2^16 between that of one direction and that of another. */
bool instance_fits(const struct xform *to_world);
void instance_init(struct instance *instance, int object, const struct xform *to_world,
                   const struct place *place);
/* Sets the box, that of an object's box; lower above upper: of nothing. */
void instance_bound(struct instance *instance, const float lower[3],
                    const float upper[3]);

static inline struct vec3 instance_affine(const double m[3][4], const float p[3],
                                          double w)
{
    double q[3];
    for (int i = 0; i < 3; i++)
        q[i] = m[i][0] * (double)p[0] + m[i][1] * (double)p[1] + m[i][2] * (double)p[2] +
               w * m[i][3];
    return vec3((float)q[0], (float)q[1], (float)q[2]);
}

static inline struct vec3 instance_point_inside(const struct instance *instance,
                                                struct vec3 p)
{
    return instance_affine(instance->to_object, (const float[3]){p.x, p.y, p.z}, 1.0);
}

static inline struct vec3 instance_vector_inside(const struct instance *instance,
                                                 struct vec3 v)
{
    return instance_affine(instance->to_object, (const float[3]){v.x, v.y, v.z}, 0.0);
}

static inline struct vec3 instance_vector(const struct instance *instance, struct vec3 v)
{
    return instance_affine(instance->to_world, (const float[3]){v.x, v.y, v.z}, 0.0);
}

/* By the inverse transpose; unit. *length: of what a unit normal became before that. */
struct vec3 instance_normal(const struct instance *instance, struct vec3 n,
                            double *length);
/* From the object's space into the world's: the place with its offsets, and the shading
 * normal there, on whose side ng stays. extent: at least that of the triangle or quadric
 * along each axis of the world. */
void instance_place(const struct instance *instance, struct vec3 extent,
                    struct ray_endpoint *at, struct vec3 *n);
/* Of what reaches as far along each of the object's axes. */
struct vec3 instance_extent(const struct instance *instance, float reach);

#endif

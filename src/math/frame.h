#ifndef ETALON_MATH_FRAME_H
#define ETALON_MATH_FRAME_H

/* Orthonormal frames; n is the z axis of local coordinates. */

#include "math/vec3.h"

struct frame {
    struct vec3 s, t, n;
};

/* Any frame about the unit vector n, continuous but at n.z = 0 [Duff17]. */
static inline struct frame frame_from_normal(struct vec3 n)
{
    float sign = copysignf(1.0f, n.z);
    float a = -1.0f / (sign + n.z);
    float b = n.x * n.y * a;
    return (struct frame){{1.0f + sign * n.x * n.x * a, sign * b, -sign * n.x},
                          {b, sign + n.y * n.y * a, -n.y},
                          n};
}

static inline struct vec3 frame_to_local(const struct frame *f, struct vec3 w)
{
    return (struct vec3){vec3_dot(w, f->s), vec3_dot(w, f->t), vec3_dot(w, f->n)};
}

static inline struct vec3 frame_to_world(const struct frame *f, struct vec3 w)
{
    return (struct vec3){w.x * f->s.x + w.y * f->t.x + w.z * f->n.x,
                         w.x * f->s.y + w.y * f->t.y + w.z * f->n.y,
                         w.x * f->s.z + w.y * f->t.z + w.z * f->n.z};
}

#endif

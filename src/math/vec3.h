#ifndef ETALON_MATH_VEC3_H
#define ETALON_MATH_VEC3_H

/* Points, directions and normals: three floats. */

#include <math.h>

struct vec3 {
    float x, y, z;
};

static inline struct vec3 vec3(float x, float y, float z)
{
    return (struct vec3){x, y, z};
}

static inline struct vec3 vec3_add(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

static inline struct vec3 vec3_sub(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static inline struct vec3 vec3_scale(struct vec3 a, float s)
{
    return (struct vec3){a.x * s, a.y * s, a.z * s};
}

static inline struct vec3 vec3_neg(struct vec3 a)
{
    return (struct vec3){-a.x, -a.y, -a.z};
}

/* a + s b */
static inline struct vec3 vec3_mad(struct vec3 a, float s, struct vec3 b)
{
    return (struct vec3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static inline float vec3_dot(struct vec3 a, struct vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static inline struct vec3 vec3_cross(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z,
                         a.x * b.y - a.y * b.x};
}

static inline float vec3_length(struct vec3 a)
{
    return sqrtf(vec3_dot(a, a));
}

/* Not for the zero vector. */
static inline struct vec3 vec3_normalize(struct vec3 a)
{
    return vec3_scale(a, 1.0f / vec3_length(a));
}

static inline float vec3_max_abs(struct vec3 a)
{
    return fmaxf(fabsf(a.x), fmaxf(fabsf(a.y), fabsf(a.z)));
}

#endif

#ifndef ETALON_MATH_XFORM_H
#define ETALON_MATH_XFORM_H

/* Affine and projective transforms: 4x4, row-major, column vectors (p' = M p), double,
 * kept with their inverse. */

#include "math/vec3.h"

#include <stdbool.h>

struct xform {
    double m[4][4];
    double inv[4][4];
};

struct xform xform_identity(void);
struct xform xform_translate(double x, double y, double z);
struct xform xform_scale(double x, double y, double z); /* factors must not be 0 */
struct xform xform_rotate(double degrees, double x, double y, double z);
/* Camera to world for a camera at eye that looks along +z with +y up (pbrt's left-handed
 * camera space: +x to the right of the image). False if degenerate. */
bool xform_look_at(const double eye[3], const double target[3], const double up[3],
                   struct xform *camera_to_world);
/* From 16 numbers in row-major order; false if singular or not finite. */
bool xform_from_matrix(const double m[16], struct xform *out);
struct xform xform_mul(const struct xform *a, const struct xform *b); /* a after b */
struct xform xform_inverse(const struct xform *a);

struct vec3 xform_point(const struct xform *a, struct vec3 p);
struct vec3 xform_vector(const struct xform *a, struct vec3 v);
struct vec3 xform_normal(const struct xform *a, struct vec3 n); /* not normalised */
/* Finite, as its inverse is, and without a projective part. */
bool xform_is_affine(const struct xform *a);
bool xform_swaps_handedness(const struct xform *a);
/* True if a is a rotation (or reflection) times one scale factor, within 1e-4; *scale. */
bool xform_is_similarity(const struct xform *a, double *scale);
/* Rotation, mirrors, translation and a scale along each of its own axes. */
bool xform_is_stretch(const struct xform *a, double scale[3]);

#endif

#ifndef ETALON_MATH_WARP_H
#define ETALON_MATH_WARP_H

/* Warps of the unit square, each with its density and its inverse. u in [0,1)^2. */

#include "math/vec3.h"

#define MATH_PI 3.14159265358979323846

struct vec2 {
    double x, y;
};

/* Unit disk, concentric [Shirley and Chiu 1997]; density 1/pi. */
struct vec2 warp_disk(const double u[2]);
void warp_disk_inverse(struct vec2 p, double u[2]);

/* Hemisphere z > 0, density z/pi per solid angle. */
struct vec3 warp_cosine(const double u[2]);
double warp_cosine_pdf(float cos_theta); /* 0 for cos_theta <= 0 */
void warp_cosine_inverse(struct vec3 w, double u[2]);

/* Whole sphere, density 1/(4 pi). */
struct vec3 warp_sphere(const double u[2]);
void warp_sphere_inverse(struct vec3 w, double u[2]);

/* Barycentric weights (b0,b1) of a triangle's first two corners, uniform in area. */
struct vec2 warp_triangle(const double u[2]);
void warp_triangle_inverse(struct vec2 b, double u[2]);

#endif

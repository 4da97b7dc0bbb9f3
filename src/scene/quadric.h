#ifndef ETALON_SCENE_QUADRIC_H
#define ETALON_SCENE_QUADRIC_H

/* Sphere, disk and cylinder: analytic, in double, in their own space; any invertible
 * affine transform for surfaces, a similarity for emitters (uniform in area must stay
 * uniform in area). */

#include "scene/hit.h"
#include "scene/scene_desc.h"

/* What a ray, its direction rounded to 2^-24 of each component, drifts by at most while
 * it crosses a quadric, in units of its reach: 2^-24 |n| (2 reach) sqrt3; twice that. */
#define QUADRIC_DRIFT 0x1p-21f

struct quadric {
    enum shape_kind kind;
    double radius, height, z_min, z_max;
    double to_world[3][4], to_object[3][4];
    double scale; /* of the similarity; 0 if it is none */
    float reach;  /* largest coordinate */
    float floor;  /* smallest offset */
    bool flip;    /* normals to the other side: inward, or -z for the disk */
};

/* Object-space point of a hit and its ray parameter. */
struct quadric_hit {
    double t;
    double p[3];
};

/* Checks sizes and the transform. */
bool quadric_init(struct quadric *quadric, const struct shape_desc *desc,
                  struct err *err);

/* World-space box, a few rounding errors larger than the surface. */
void quadric_bounds(const struct quadric *quadric, float lower[3], float upper[3]);

/* Nearest root with t_near < t <= t_far of the world-space ray o + t d (d of any length).
 */
bool quadric_intersect(const struct quadric *quadric, const float o[3], const float d[3],
                       double t_near, double t_far, struct quadric_hit *hit);

/* World-space place of an object-space surface point. It is rounded once, so that it lies
 * within sqrt3 2^-24 max|p| of the surface; p + offset ng rounds once more. The offset is
 * twice that sum, and at least `floor`, which covers the double precision of everything
 * else where the surface passes through the origin of the world. */
struct ray_endpoint quadric_endpoint(const struct quadric *quadric, const double p[3]);

/* Surface parameters, and dp/du in world space (may be zero at a pole). */
void quadric_parameters(const struct quadric *quadric, const double p[3], float uv[2],
                        struct vec3 *dpdu);

double quadric_area(const struct quadric *quadric); /* similarity only */
/* Uniform in area (similarity only). */
struct ray_endpoint quadric_sample(const struct quadric *quadric, const double u[2]);
/* u with which quadric_sample gives the place. False if none does. */
bool quadric_invert(const struct quadric *quadric, struct vec3 place, double u[2]);

#endif

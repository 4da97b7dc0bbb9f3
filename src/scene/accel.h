#ifndef ETALON_SCENE_ACCEL_H
#define ETALON_SCENE_ACCEL_H

/* Rays (the only user of Embree). */

#include "base/err.h"
#include "scene/hit.h"

#include <stdbool.h>

struct accel;
struct scene;

/* Wants scene->shapes, desc and needs. threads: for building; 0: all. */
struct accel *accel_build(const struct scene *scene, int threads, struct err *err);
void accel_destroy(struct accel *accel);
void accel_bounds(const struct accel *accel, struct vec3 *lower, struct vec3 *upper);

/* Nearest hit of the ray that leaves `from` into the unit direction w; fills all of *hit.
 * False if it leaves the scene. */
bool accel_intersect(const struct scene *scene, const struct anchor *from, struct vec3 w,
                     struct hit *hit);

/* Whether anything lies strictly between two places. Both ends are moved off their
 * surfaces, each towards the other's side. */
bool accel_visible(const struct scene *scene, const struct anchor *a,
                   const struct anchor *b);

/* Embree's version and the instruction set it chose, for provenance. */
const char *accel_description(const struct accel *accel);

#endif

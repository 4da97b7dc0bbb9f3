#ifndef ETALON_SCENE_ACCEL_H
#define ETALON_SCENE_ACCEL_H

/* Rays (the only user of Embree). */

#include "base/err.h"
#include "scene/hit.h"

#include <stdbool.h>
#include <stddef.h>

struct accel;
struct instance;
struct scene;

/* Whether Embree keeps corners beside the hierarchy, or (compact) looks them up: less
 * memory, and hits that may differ in their last bits. Of 3 million triangles, in bytes a
 * triangle: the process grows by 35 for the compact one, and by no more while it is
 * built; by 65 for the full one, and by 103 while it is built. Embree's own count is 46
 * and 64: it asks for blocks that it then makes no use of, and the compact one leaves a
 * quarter of its blocks untouched. */
enum accel_compact { ACCEL_AUTO, ACCEL_COMPACT, ACCEL_FULL };

/* Bytes a triangle, and the share of the available memory that the full hierarchy may
 * take before ACCEL_AUTO takes the compact one: building takes more than the result. */
#define ACCEL_TRIANGLE_BYTES 68.0
#define ACCEL_MEMORY_SHARE   0.25

/* What ACCEL_AUTO decides for so many triangles where so many bytes are available. */
bool accel_wants_compact(double triangles, double available);

/* Wants scene->shapes, objects, instances, desc and needs. threads: for building; 0: all.
 */
struct accel *accel_build(const struct scene *scene, enum accel_compact compact,
                          int threads, struct err *err);
void accel_destroy(struct accel *accel);
void accel_bounds(const struct accel *accel, struct vec3 *lower, struct vec3 *upper);

/* Which surfaces a ray may end on; a hit that the filter refuses is not filled in. */
enum hit_filter { HIT_ANY, HIT_LIGHT, HIT_CONNECTIBLE };
enum accel_result { ACCEL_MISS, ACCEL_FILTERED_OUT, ACCEL_HIT };

/* Nearest hit of the ray that leaves `from` into the unit direction w; fills all of *hit
 * if the filter passes it, else bsdf, light and shape at most. */
enum accel_result accel_trace(const struct scene *scene, const struct ray_endpoint *from,
                              struct vec3 w, enum hit_filter filter, struct hit *hit);

/* The same for any surface; false if the ray leaves the scene. */
static inline bool accel_intersect(const struct scene *scene,
                                   const struct ray_endpoint *from, struct vec3 w,
                                   struct hit *hit)
{
    return accel_trace(scene, from, w, HIT_ANY, hit) == ACCEL_HIT;
}

/* Whether anything lies strictly between two places. Both ends are moved off their
 * surfaces, each towards the other's side. */
bool accel_visible(const struct scene *scene, const struct ray_endpoint *a,
                   const struct ray_endpoint *b);

/* Gives `found` every quadric and triangle whose box comes within `radius` of p, until it
 * returns false. Sees each of several surfaces that coincide, of which a ray meets one.
 * instance: in whose object's space the shape lies; NULL: the world's. */
typedef bool (*accel_near_function)(void *self, const struct instance *instance,
                                    int shape, uint32_t triangle);
void accel_near(const struct scene *scene, struct vec3 p, float radius,
                accel_near_function found, void *self);

/* Memory that Embree has asked for: the hierarchy, not the vertices, which it shares. */
size_t accel_bytes(const struct accel *accel);
/* What of it the process has in memory: by how much it grew, in bytes. */
double accel_resident(const struct accel *accel);

/* Embree's version and whether it is compact, for provenance. */
const char *accel_description(const struct accel *accel);
bool accel_is_compact(const struct accel *accel);
/* Why it is compact or not. */
const char *accel_reason(const struct accel *accel);

#endif

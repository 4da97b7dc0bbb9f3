#ifndef ETALON_SCENE_ACCEL_H
#define ETALON_SCENE_ACCEL_H

/* Rays, and what lies near a point (accel_near.c); no other file uses Embree. */

#include "base/err.h"
#include "scene/hit.h"

#include <stdbool.h>
#include <stddef.h>

struct accel;
struct instance;
struct scene;

/* Whether Embree stores vertices in the BVH (full), or looks them up (compact): the
 * latter takes less memory, and its hits may differ in the last bits. Measured with 3
 * million triangles, in bytes a triangle: the process grows by 35 for the compact BVH,
 * also while it is built, and by 65 for the full one, 103 while it is built. Embree's own
 * count is 46 and 64, as it includes memory that is never touched. */
enum accel_compact { ACCEL_AUTO, ACCEL_COMPACT, ACCEL_FULL };

/* Bytes a triangle while the full BVH is built, and the share of the available memory
 * above which ACCEL_AUTO takes the compact one. */
#define ACCEL_TRIANGLE_BYTES 68.0
#define ACCEL_MEMORY_SHARE   0.25

/* Whether ACCEL_AUTO takes the compact BVH for this number of triangles and this
 * available memory. */
bool accel_wants_compact(double triangles, double available);

/* Reads scene->shapes, objects, instances, desc and needs. threads: for building; 0: all.
 */
struct accel *accel_build(const struct scene *scene, enum accel_compact compact,
                          int threads, struct err *err);
void accel_destroy(struct accel *accel);
void accel_bounds(const struct accel *accel, struct vec3 *lower, struct vec3 *upper);

/* Which surfaces a ray may end on. A hit that the filter refuses is not filled in. */
enum hit_filter { HIT_ANY, HIT_LIGHT, HIT_CONNECTIBLE };
enum accel_result { ACCEL_MISS, ACCEL_FILTERED_OUT, ACCEL_HIT };

/* hit: bsdf and light. */
static inline bool hit_filter_passes(const struct hit *hit, enum hit_filter filter)
{
    if (filter == HIT_LIGHT)
        return hit->light >= 0;
    return filter == HIT_ANY || !(hit->bsdf->flags & (BSDF_DELTA | BSDF_BLACK));
}

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

/* Whether any surface lies strictly between two places. Both ends are offset from their
 * surfaces, each towards the other. */
bool accel_visible(const struct scene *scene, const struct ray_endpoint *a,
                   const struct ray_endpoint *b);

/* What is left to be looked at between two places, where shapes may let light straight
 * through (shape_passes). */
struct accel_segment {
    struct vec3 from, to; /* offset from the surfaces at both ends */
    bool passing;         /* there is such a shape */
};

/* As accel_visible, but what passes does not count: accel_next finds it. */
bool accel_unblocked(const struct scene *scene, const struct ray_endpoint *a,
                     const struct ray_endpoint *b, struct accel_segment *segment);

/* The next shape of the segment that may let light through, all of *hit, after which the
 * segment begins behind it. False: there are no more. */
bool accel_next(const struct scene *scene, struct accel_segment *segment,
                struct hit *hit);

/* Calls `found` for every quadric and triangle whose box is within `radius` of p, until
 * it returns false. Finds each of several coincident surfaces, of which a ray hits only
 * one. instance: in whose object's space the shape lies; NULL: the world's. */
typedef bool (*accel_near_function)(void *self, const struct instance *instance,
                                    int shape, uint32_t triangle);
void accel_near(const struct scene *scene, struct vec3 p, float radius,
                accel_near_function found, void *self);

/* Memory that Embree has allocated: the BVH, not the vertices, which it shares. */
size_t accel_bytes(const struct accel *accel);
/* Resident memory of it: the growth of the process, in bytes. */
double accel_resident(const struct accel *accel);

/* Embree's version and whether it is compact, for provenance. */
const char *accel_description(const struct accel *accel);
bool accel_is_compact(const struct accel *accel);
/* The reason why it is compact or full. */
const char *accel_reason(const struct accel *accel);

#endif

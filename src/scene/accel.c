#include "scene/accel.h"

#include "base/machine.h"
#include "base/mem.h"
#include "base/par.h"
#include "scene/accel_scenes.h"
#include "scene/hit_fill.h"
#include "scene/scene.h"

#include <stdio.h>

/* Offset for the rounding errors at a segment's far end, relative to the sum of
 * |component| |normal component| of the segment: v0 - o and o' - o are rounded relative
 * to the segment's length, and so are the three terms of the dot product that decides on
 * which side of the plane of a far triangle a point lies, (1 + 1 + 3) 2^-24; three times
 * that is used. At the near end, the ray's origin, no such error arises. */
#define ACCEL_FAR_END 0x1p-20f

/* One ray's context. A quadric stores its nearest hit here, in double. */
struct accel_context {
    struct RTCIntersectContext base; /* must be first */
    struct quadric_hit hit;
};

/* The context of rtcOccluded1. */
struct accel_shadow {
    struct RTCIntersectContext base; /* must be first */
    bool passing; /* the ray met a shape that may let light through: it went on */
};

/* Masks of shapes, in scenes some of whose shapes pass: rays of accel_next see these
 * alone. Elsewhere all shapes have all bits. */
#define ACCEL_OPAQUE  1u
#define ACCEL_PASSING 2u

static void accel_quadric_bounds(const struct RTCBoundsFunctionArguments *args)
{
    float lower[3], upper[3];
    quadric_bounds(args->geometryUserPtr, lower, upper);
    *args->bounds_o = (struct RTCBounds){.lower_x = lower[0],
                                         .lower_y = lower[1],
                                         .lower_z = lower[2],
                                         .upper_x = upper[0],
                                         .upper_y = upper[1],
                                         .upper_z = upper[2]};
}

static bool accel_quadric_test(const struct quadric *quadric, const struct RTCRay *ray,
                               struct quadric_hit *hit)
{
    const float o[3] = {ray->org_x, ray->org_y, ray->org_z};
    const float d[3] = {ray->dir_x, ray->dir_y, ray->dir_z};
    return quadric_intersect(quadric, o, d, (double)ray->tnear, (double)ray->tfar, hit);
}

static void accel_quadric_intersect(const struct RTCIntersectFunctionNArguments *args)
{
    struct accel_context *context = (struct accel_context *)args->context;
    struct RTCRayHit *r = (struct RTCRayHit *)args->rayhit; /* N is 1 here */
    struct quadric_hit hit;
    if (!args->valid[0] || !accel_quadric_test(args->geometryUserPtr, &r->ray, &hit))
        return;
    context->hit = hit;
    r->ray.tfar = (float)hit.t;
    r->hit.geomID = args->geomID;
    r->hit.primID = args->primID;
    r->hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
}

static void accel_quadric_occluded(const struct RTCOccludedFunctionNArguments *args)
{
    struct RTCRay *ray = (struct RTCRay *)args->ray;
    struct quadric_hit hit;
    if (args->valid[0] && accel_quadric_test(args->geometryUserPtr, ray, &hit))
        ray->tfar = -INFINITY;
}

static void accel_quadric_passes(const struct RTCOccludedFunctionNArguments *args)
{
    const struct RTCRay *ray = (const struct RTCRay *)args->ray;
    struct quadric_hit hit;
    if (args->valid[0] && accel_quadric_test(args->geometryUserPtr, ray, &hit))
        ((struct accel_shadow *)args->context)->passing = true;
}

/* May be called more than once for the same triangle, as Embree splits triangles. */
static void accel_triangle_passes(const struct RTCFilterFunctionNArguments *args)
{
    ((struct accel_shadow *)args->context)->passing = true;
    args->valid[0] = 0;
}

/* Embree loads a ray in 16-byte pieces. If the floats were written one by one just
 * before, the loads could not be forwarded from the stores and would wait. */
typedef float accel_float4 __attribute__((vector_size(16), may_alias));

static inline void accel_set_ray(struct RTCRay *ray, struct vec3 o, struct vec3 d,
                                 float t_far, unsigned mask)
{
    *(accel_float4 *)&ray->org_x = (accel_float4){o.x, o.y, o.z, 0.0f};
    *(accel_float4 *)&ray->dir_x = (accel_float4){d.x, d.y, d.z, 0.0f};
    ray->tfar = t_far;
    ray->mask = mask;
    ray->id = 0;
    ray->flags = 0;
}

/* --- instances --------------------------------------------------------------------- */

/* Not Embree's own kind of instance: that one takes rays into the object by an inverse in
 * floats, which nobody gets to see and of whose rounding nothing is said; and each takes
 * a geometry of its own, where here all are the primitives of one. */

static void accel_instance_bounds(const struct RTCBoundsFunctionArguments *args)
{
    const struct scene *scene = args->geometryUserPtr;
    const struct instance *instance = &scene->instances[args->primID];
    *args->bounds_o = (struct RTCBounds){.lower_x = instance->lower[0],
                                         .lower_y = instance->lower[1],
                                         .lower_z = instance->lower[2],
                                         .upper_x = instance->upper[0],
                                         .upper_y = instance->upper[1],
                                         .upper_z = instance->upper[2]};
}

/* Distances along the ray stay as they are, and so does the context: what is hit inside
 * is nearer than all before it. */
static void accel_set_ray_inside(struct RTCRay *inside, const struct instance *instance,
                                 const struct RTCRay *ray)
{
    struct vec3 o = instance_point_inside(instance,
                                          vec3(ray->org_x, ray->org_y, ray->org_z));
    struct vec3 d = instance_vector_inside(instance,
                                           vec3(ray->dir_x, ray->dir_y, ray->dir_z));
    accel_set_ray(inside, o, d, ray->tfar, ray->mask);
}

static void accel_instance_intersect(const struct RTCIntersectFunctionNArguments *args)
{
    const struct scene *scene = args->geometryUserPtr;
    const struct instance *instance = &scene->instances[args->primID];
    struct RTCRayHit *outer = (struct RTCRayHit *)args->rayhit; /* N is 1 here */
    struct RTCRayHit r;
    if (!args->valid[0])
        return;
    accel_set_ray_inside(&r.ray, instance, &outer->ray);
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene->accel->objects[instance->object], args->context, &r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return;
    size_t id = scene->objects[instance->object].first_shape + r.hit.geomID;
    outer->ray.tfar = r.ray.tfar;
    outer->hit.u = r.hit.u;
    outer->hit.v = r.hit.v;
    outer->hit.geomID = (unsigned)id;
    outer->hit.primID = r.hit.primID;
    outer->hit.instID[0] = args->primID;
}

static void accel_instance_occluded(const struct RTCOccludedFunctionNArguments *args)
{
    const struct scene *scene = args->geometryUserPtr;
    const struct instance *instance = &scene->instances[args->primID];
    struct RTCRay *outer = (struct RTCRay *)args->ray, ray;
    if (!args->valid[0])
        return;
    accel_set_ray_inside(&ray, instance, outer);
    rtcOccluded1(scene->accel->objects[instance->object], args->context, &ray);
    outer->tfar = ray.tfar;
}

/* All of them as one geometry, whose number follows those of the shapes. */
static void accel_attach_instances(struct accel *accel, const struct scene *scene)
{
    RTCGeometry geometry = rtcNewGeometry(accel->device, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    rtcSetGeometryUserPrimitiveCount(geometry, (unsigned)scene->instance_count);
    rtcSetGeometryUserData(geometry, (void *)scene);
    rtcSetGeometryBoundsFunction(geometry, accel_instance_bounds, NULL);
    rtcSetGeometryIntersectFunction(geometry, accel_instance_intersect);
    rtcSetGeometryOccludedFunction(geometry, accel_instance_occluded);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(accel->scene, geometry,
                          (unsigned)scene->objects[0].shape_count);
    rtcReleaseGeometry(geometry);
}

/* --- building ---------------------------------------------------------------------- */

/* Adds the shape `id` under its number in its object. */
static void accel_attach(struct accel *accel, const struct scene *scene, RTCScene to,
                         size_t id, size_t number)
{
    const struct shape *shape = &scene->shapes[id];
    const struct mesh *mesh = scene->desc->shapes[id].mesh;
    bool quadric = shape->quadric != NULL, passes = shape_passes(shape);
    if (!quadric && shape->triangles.count == 0)
        return;
    RTCGeometry geometry = rtcNewGeometry(
        accel->device, quadric ? RTC_GEOMETRY_TYPE_USER : RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
    if (scene->needs.straight)
        rtcSetGeometryMask(geometry, passes ? ACCEL_PASSING : ACCEL_OPAQUE);
    if (quadric) {
        rtcSetGeometryUserPrimitiveCount(geometry, 1);
        rtcSetGeometryUserData(geometry, shape->quadric);
        rtcSetGeometryBoundsFunction(geometry, accel_quadric_bounds, NULL);
        rtcSetGeometryIntersectFunction(geometry, accel_quadric_intersect);
        rtcSetGeometryOccludedFunction(geometry, accel_quadric_occluded);
        if (passes)
            rtcSetGeometryOccludedFunction(geometry, accel_quadric_passes);
    } else {
        if (passes)
            rtcSetGeometryOccludedFilterFunction(geometry, accel_triangle_passes);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   shape->triangles.p, 0, 3 * sizeof(float),
                                   mesh->vertex_count);
        rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   shape->triangles.index, 0, 3 * sizeof(uint32_t),
                                   mesh->triangle_count);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(to, geometry, (unsigned)number);
    rtcReleaseGeometry(geometry);
}

/* Called by all of Embree's threads. */
static bool accel_count_bytes(void *bytes, ssize_t change, bool post)
{
    (void)post;
    __atomic_fetch_add((int64_t *)bytes, change, __ATOMIC_RELAXED);
    return true;
}

static void accel_describe(struct accel *accel)
{
    ssize_t version = rtcGetDeviceProperty(accel->device, RTC_DEVICE_PROPERTY_VERSION);
    snprintf(accel->description, sizeof accel->description, "Embree %d.%d.%d%s",
             (int)(version / 10000), (int)(version / 100 % 100), (int)(version % 100),
             accel->compact ? ", compact" : "");
}

bool accel_wants_compact(double triangles, double available)
{
    return ACCEL_TRIANGLE_BYTES * triangles > ACCEL_MEMORY_SHARE * available;
}

static void accel_choose(struct accel *accel, const struct scene *scene,
                         enum accel_compact compact)
{
    double triangles = 0.0, available = machine_memory_available();
    accel->compact = compact == ACCEL_COMPACT;
    if (compact != ACCEL_AUTO) {
        snprintf(accel->reason, sizeof accel->reason, "as set");
        return;
    }
    for (size_t i = 0; i < scene->desc->shape_count; i++)
        triangles += scene->shapes[i].triangles.count;
    accel->compact = accel_wants_compact(triangles, available);
    snprintf(accel->reason, sizeof accel->reason,
             "in full it comes to about %.0f MB, %s than %g %% of the %.0f MB available",
             ACCEL_TRIANGLE_BYTES * triangles / 0x1p20,
             accel->compact ? "more" : "not more", 100.0 * ACCEL_MEMORY_SHARE,
             available / 0x1p20);
}

static enum RTCSceneFlags accel_flags(const struct accel *accel,
                                      const struct scene *scene)
{
    unsigned flags = RTC_SCENE_FLAG_NONE;
    if (scene->needs.robust)
        flags |= RTC_SCENE_FLAG_ROBUST;
    if (accel->compact)
        flags |= RTC_SCENE_FLAG_COMPACT;
    return (enum RTCSceneFlags)flags;
}

static RTCScene accel_new_scene(const struct accel *accel, const struct scene *scene)
{
    RTCScene made = rtcNewScene(accel->device);
    rtcSetSceneBuildQuality(made, RTC_BUILD_QUALITY_HIGH);
    rtcSetSceneFlags(made, accel_flags(accel, scene));
    return made;
}

/* One hierarchy an object, and one of instances and what lies in the world's space. */
static void accel_build_scenes(struct accel *accel, const struct scene *scene)
{
    accel->objects = mem_alloc((size_t)scene->object_count, sizeof(RTCScene));
    accel->object_count = scene->object_count;
    for (int o = 0; o < scene->object_count; o++) {
        const struct object *object = &scene->objects[o];
        if (o > 0 && object->shape_count == 0)
            continue;
        RTCScene made = accel_new_scene(accel, scene);
        *(o == 0 ? &accel->scene : &accel->objects[o]) = made;
        for (size_t i = 0; i < object->shape_count; i++)
            accel_attach(accel, scene, made, object->first_shape + i, i);
        if (o > 0)
            rtcCommitScene(made);
    }
    if (scene->instance_count > 0)
        accel_attach_instances(accel, scene);
    rtcCommitScene(accel->scene);
}

struct accel *accel_build(const struct scene *scene, enum accel_compact compact,
                          int threads, struct err *err)
{
    struct accel *accel = mem_alloc(1, sizeof *accel);
    char config[64];
    snprintf(config, sizeof config, "threads=%d", par_threads(threads));
    accel->device = rtcNewDevice(config);
    if (!accel->device) {
        err_set(err, ERR_UNSUPPORTED, NULL, "Embree does not start (error %d)",
                (int)rtcGetDeviceError(NULL));
        accel_destroy(accel);
        return NULL;
    }
    rtcSetDeviceMemoryMonitorFunction(accel->device, accel_count_bytes, &accel->bytes);
    accel_choose(accel, scene, compact);
    accel_describe(accel);
    double before = machine_memory_now();
    accel_build_scenes(accel, scene);
    accel->resident = fmax(machine_memory_now() - before, 0.0);
    enum RTCError status = rtcGetDeviceError(accel->device);
    if (status != RTC_ERROR_NONE) {
        err_set(err, ERR_UNSUPPORTED, NULL, "Embree cannot build the scene (error %d%s)",
                (int)status, status == RTC_ERROR_OUT_OF_MEMORY ? ", out of memory" : "");
        accel_destroy(accel);
        return NULL;
    }
    return accel;
}

void accel_destroy(struct accel *accel)
{
    if (!accel)
        return;
    if (accel->scene)
        rtcReleaseScene(accel->scene);
    for (int o = 0; o < accel->object_count; o++)
        if (accel->objects[o])
            rtcReleaseScene(accel->objects[o]);
    mem_free(accel->objects);
    if (accel->device)
        rtcReleaseDevice(accel->device);
    mem_free(accel);
}

void accel_bounds(const struct accel *accel, struct vec3 *lower, struct vec3 *upper)
{
    struct RTCBounds b;
    rtcGetSceneBounds(accel->scene, &b);
    *lower = vec3(b.lower_x, b.lower_y, b.lower_z);
    *upper = vec3(b.upper_x, b.upper_y, b.upper_z);
}

size_t accel_bytes(const struct accel *accel)
{
    int64_t bytes = __atomic_load_n(&accel->bytes, __ATOMIC_RELAXED);
    return bytes > 0 ? (size_t)bytes : 0;
}

double accel_resident(const struct accel *accel)
{
    return accel->resident;
}

const char *accel_description(const struct accel *accel)
{
    return accel->description;
}

bool accel_is_compact(const struct accel *accel)
{
    return accel->compact;
}

const char *accel_reason(const struct accel *accel)
{
    return accel->reason;
}

static __attribute__((noinline)) void accel_fill_instance(const struct scene *scene,
                                                          const struct RTCHit *found,
                                                          const struct quadric_hit *q,
                                                          struct hit *hit)
{
    const struct instance *instance = &scene->instances[found->instID[0]];
    const struct shape *shape = &scene->shapes[found->geomID];
    if (shape->quadric)
        hit_fill_quadric_instance(instance, shape, q, scene->needs.uv, hit);
    else
        hit_fill_triangle_instance(instance, shape, found->primID, found->u, found->v,
                                   scene->needs.uv, hit);
}

static inline void accel_fill(const struct scene *scene, const struct RTCHit *found,
                              const struct quadric_hit *q, struct hit *hit)
{
    const struct shape *shape = &scene->shapes[found->geomID];
    if (found->instID[0] != RTC_INVALID_GEOMETRY_ID)
        accel_fill_instance(scene, found, q, hit);
    else if (shape->quadric)
        hit_fill_quadric(shape, q, scene->needs.uv, hit);
    else
        hit_fill_triangle(shape, found->primID, found->u, found->v, scene->needs.uv, hit);
}

enum accel_result accel_trace(const struct scene *scene, const struct ray_endpoint *from,
                              struct vec3 w, enum hit_filter filter, struct hit *hit)
{
    struct accel_context context;
    rtcInitIntersectContext(&context.base);
    struct RTCRayHit r;
    accel_set_ray(&r.ray, ray_endpoint_origin(from, w), w, INFINITY, ~0u);
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene->accel->scene, &context.base, &r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return ACCEL_MISS;
    const struct shape *shape = &scene->shapes[r.hit.geomID];
    hit->bsdf = shape->bsdf;
    hit->light = shape->light;
    hit->shape = (int32_t)r.hit.geomID;
    hit->triangle = r.hit.primID;
    if (!hit_filter_passes(hit, filter))
        return ACCEL_FILTERED_OUT;
    accel_fill(scene, &r.hit, &context.hit, hit);
    return ACCEL_HIT;
}

/* Whether the ray should start at a rather than at b: at the end that is known more
 * accurately, so that near surfaces are not missed. A free end, which has no offset, is
 * the far one. */
static bool accel_starts(const struct ray_endpoint *a, const struct ray_endpoint *b)
{
    if (a->offset == b->offset)
        return a->p.x != b->p.x   ? a->p.x < b->p.x
               : a->p.y != b->p.y ? a->p.y < b->p.y
                                  : a->p.z < b->p.z;
    return b->offset == 0.0f || (a->offset > 0.0f && a->offset < b->offset);
}

static inline __attribute__((always_inline)) bool
accel_segment_unblocked(const struct scene *scene, const struct ray_endpoint *a,
                        const struct ray_endpoint *b, struct accel_segment *segment)
{
    const struct ray_endpoint *near = accel_starts(a, b) ? a : b,
                              *far = near == a ? b : a;
    struct vec3 way = vec3_sub(far->p, near->p);
    struct vec3 from = ray_endpoint_origin(near, way);
    float offset = far->offset + ACCEL_FAR_END * abs_components_dot(far->ng, way);
    if (far->far_offset > 0.0f)
        offset += far->far_offset * sqrtf(vec3_dot(way, way));
    float side = vec3_dot(far->ng, way) > 0.0f ? -offset : offset;
    struct vec3 to = vec3_mad(far->p, side, far->ng);
    struct accel_shadow context;
    rtcInitIntersectContext(&context.base);
    context.passing = false;
    struct RTCRay ray;
    accel_set_ray(&ray, from, vec3_sub(to, from), 1.0f, ~0u);
    rtcOccluded1(scene->accel->scene, &context.base, &ray);
    *segment = (struct accel_segment){from, to, context.passing};
    return ray.tfar >= 0.0f;
}

bool accel_unblocked(const struct scene *scene, const struct ray_endpoint *a,
                     const struct ray_endpoint *b, struct accel_segment *segment)
{
    return accel_segment_unblocked(scene, a, b, segment);
}

bool accel_visible(const struct scene *scene, const struct ray_endpoint *a,
                   const struct ray_endpoint *b)
{
    struct accel_segment segment;
    return accel_segment_unblocked(scene, a, b, &segment) && !segment.passing;
}

bool accel_next(const struct scene *scene, struct accel_segment *segment, struct hit *hit)
{
    struct accel_context context;
    rtcInitIntersectContext(&context.base);
    struct RTCRayHit r;
    struct vec3 way = vec3_sub(segment->to, segment->from);
    accel_set_ray(&r.ray, segment->from, way, 1.0f, ACCEL_PASSING);
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    r.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene->accel->scene, &context.base, &r);
    if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return false;
    hit->bsdf = scene->shapes[r.hit.geomID].bsdf;
    hit->light = -1;
    hit->shape = (int32_t)r.hit.geomID;
    hit->triangle = r.hit.primID;
    accel_fill(scene, &r.hit, &context.hit, hit);
    segment->from = ray_endpoint_origin(&hit->at, way);
    return true;
}

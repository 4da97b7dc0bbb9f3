/* What lies near a point: a point query of Embree's, into instances too. */

#include "scene/accel.h"
#include "scene/accel_scenes.h"
#include "scene/scene.h"

struct accel_near_call {
    const struct scene *scene;
    const struct instance *instance;
    struct vec3 p;
    float radius;
    accel_near_function found;
    void *self;
    bool *done;
};

static void accel_near_in(const struct accel_near_call *call, RTCScene scene);

/* What lies nearer than the radius in the world lies within it times the stretch inside.
 */
static void accel_near_instance(const struct accel_near_call *outer, uint32_t number)
{
    struct accel_near_call call = *outer;
    call.instance = &outer->scene->instances[number];
    call.p = instance_point_inside(call.instance, outer->p);
    call.radius = outer->radius * (float)(call.instance->stretch * (1.0 + 1e-6));
    accel_near_in(&call, outer->scene->accel->objects[call.instance->object]);
}

static bool accel_near_one(struct RTCPointQueryFunctionArguments *args)
{
    const struct accel_near_call *call = args->userPtr;
    const struct object *objects = call->scene->objects;
    size_t first = call->instance ? objects[call->instance->object].first_shape : 0;
    if (*call->done)
        return false;
    if (!call->instance && args->geomID == objects[0].shape_count)
        accel_near_instance(call, args->primID);
    else
        *call->done = !call->found(call->self, call->instance,
                                   (int)(first + args->geomID), args->primID);
    return false; /* the search radius does not change */
}

static void accel_near_in(const struct accel_near_call *call, RTCScene scene)
{
    struct RTCPointQuery query = {
        .x = call->p.x, .y = call->p.y, .z = call->p.z, .radius = call->radius};
    struct RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene, &query, &context, accel_near_one, (void *)call);
}

void accel_near(const struct scene *scene, struct vec3 p, float radius,
                accel_near_function found, void *self)
{
    bool done = false;
    accel_near_in(&(struct accel_near_call){.scene = scene,
                                            .p = p,
                                            .radius = radius,
                                            .found = found,
                                            .self = self,
                                            .done = &done},
                  scene->accel->scene);
}

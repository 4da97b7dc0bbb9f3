#ifndef ETALON_SCENE_ACCEL_SCENES_H
#define ETALON_SCENE_ACCEL_SCENES_H

/* What Embree has built: private to scene/accel.c and scene/accel_near.c. */

#include <embree3/rtcore.h>
#include <stdbool.h>
#include <stdint.h>

struct accel {
    RTCDevice device;
    RTCScene scene;
    RTCScene *objects; /* [object_count], of those with shapes; the first one is NULL */
    int object_count;
    char description[128], reason[160];
    bool compact;
    int64_t bytes; /* bytes allocated by Embree; atomic */
    double resident;
};

#endif

#ifndef ETALON_SCENE_NEEDS_H
#define ETALON_SCENE_NEEDS_H

/* What this scene needs; what nothing needs is left out (and `info` says so). With
 * keep_all every flag is set. */

#include <stdbool.h>

struct needs {
    bool area_lights, point_lights;
    bool two_sided_lights;
    bool lens;        /* two more numbers for the lens */
    bool delta_bsdfs; /* specular vertices exist */
    bool rough_bsdfs; /* vertices that can be connected exist */
    bool transmission;
    bool shading_normals;    /* any shading normal differs from the geometric one */
    bool lobes;              /* a BSDF that wants the lobe number exists */
    bool quadrics;           /* Embree user geometry */
    bool robust;             /* Embree's robust flag: very thin triangles exist */
    bool light_hits;         /* an emitter can be hit by chance (s = 0) */
    bool camera_connections; /* t = 1 can contribute: a connectable surface exists */
    bool light_connections;  /* s = 1 can contribute */
    bool keep_all; /* numbers of absent events are drawn all the same */
};

#endif

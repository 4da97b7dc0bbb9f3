#ifndef ETALON_SCENE_NEEDS_H
#define ETALON_SCENE_NEEDS_H

/* The features that this scene needs; those that it does not need are left out, and
 * `info` lists them. With keep_all every flag is set. */

#include <stdbool.h>
#include <stddef.h>

struct needs {
    bool area_lights, point_lights;
    bool two_sided_lights;
    bool distant_lights, environment;
    bool lens;        /* two more numbers for the lens */
    bool delta_bsdfs; /* specular vertices exist */
    bool rough_bsdfs; /* vertices that can be connected exist */
    bool transmission;
    bool straight;           /* what shape_passes exists: path/passage.h */
    bool shading_normals;    /* any shading normal differs from the geometric one */
    bool lobes;              /* a BSDF that wants the lobe number exists */
    bool quadrics;           /* Embree user geometry */
    bool robust;             /* Embree's robust flag: very thin triangles exist */
    bool light_hits;         /* an emitter can be hit by chance (s = 0) */
    bool camera_connections; /* t = 1 can contribute: a connectable surface exists */
    bool light_connections;  /* s = 1 can contribute */
    bool uv;                 /* hit.u and hit.v are read (textures); else they are 0 */
    bool bump;
    bool keep_all; /* numbers of absent events are drawn too */
};

struct scene;
struct scene_desc;

/* Computed from the shapes, lights, camera and materials of the scene. */
struct needs needs_compute(const struct scene *scene, bool keep_all);

/* The same for a scene that is not built: sets the flags of delta lights, of BSDFs with
 * and without delta lobes, and of the lens only. */
struct needs needs_of_desc(const struct scene_desc *desc);

/* What `info` prints of a flag that is not set: one row a flag (keep_all has none); ends
 * with name NULL. */
struct needs_row {
    const char *name;   /* what is left out */
    size_t offset;      /* of the flag in struct needs */
    const char *reason; /* "because ..." */
};
extern const struct needs_row needs_rows[];
bool needs_get(const struct needs *needs, const struct needs_row *row);

/* Names of all that is left out, comma-separated ("nothing" if all is kept): the field
 * left_out of the statistics. Cut to size. */
void needs_left_out(const struct needs *needs, char *text, size_t size);

#endif

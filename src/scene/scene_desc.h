#ifndef ETALON_SCENE_SCENE_DESC_H
#define ETALON_SCENE_SCENE_DESC_H

/* What importers produce and scene_build consumes: materials, shapes, lights, camera,
 * film, settings, in the words of the renderer. Owns everything it points to. */

#include "base/log.h"
#include "scene/camera.h"
#include "scene/mesh.h"
#include "surface/texture.h"

struct light_type;

enum shape_kind { SHAPE_MESH, SHAPE_SPHERE, SHAPE_DISK, SHAPE_CYLINDER };

/* Quadrics in object space: sphere of `radius` about the origin; disk of `radius` at
 * z = `height`, normal +z; cylinder of `radius` about z from z_min to z_max, outward. */
struct shape_desc {
    enum shape_kind kind;
    struct mesh *mesh;     /* SHAPE_MESH, world space */
    struct xform to_world; /* quadrics */
    double radius, height, z_min, z_max;
    /* Flips normals (and emission) to the other side. Without it the side is that of the
     * winding (p1-p0) x (p2-p0), or of the shading normals if the mesh has some. A mesh
     * is stored in world space; if the format keeps the outside of a mirrored mesh, the
     * importer sets the flag for transforms that change handedness, unless there are
     * shading normals. Quadrics keep their side by themselves. */
    bool reverse_orientation;
    int object;   /* the group it is part of, whose space its world is; 0: the scene */
    int material; /* index */
    bool emits;
    bool two_sided;
    struct rgb radiance;            /* W/(m^2 sr) */
    const struct texture *emission; /* over the parameters, times radiance; or NULL */
    double emission_peak;           /* largest component of emission; set by the build */
    struct place place;             /* for messages; file string owned by the desc */
};

/* An object, a group of shapes, put into another or into the scene (0). The same object
 * may be put down many times; its shapes are kept once. Normals go by the inverse
 * transpose: where the transform mirrors, outside stays outside. */
struct instance_desc {
    int object;            /* what is put down, from 1 */
    int parent;            /* where; no object may come to contain itself */
    struct xform to_world; /* or to the parent's space; affine, invertible */
    struct place place;
};

/* A light without a surface; scene/light.h lists the kinds. Points and spots are at the
 * origin of to_world; spots and distant lights shine along its +z. */
struct light_desc {
    const struct light_type *type; /* NULL: a point light */
    struct xform to_world;
    struct rgb intensity; /* W/sr; irradiance across the beam, W/m^2, of a distant light;
                             radiance, W/(m^2 sr), or factor of the map, of an
                             environment */
    double inner, outer;  /* of a spot, degrees from its axis: full up to the one, nothing
                             from the other on; between them */
    bool linear;          /* linear in the angle, else the fourth power of a line in the
                             cosine, */
    bool smooth;          /* or of that line t the cubic 3 t^2 - 2 t^3 */
    /* Environment: NULL, or radiance by direction. In the light's own space u = phi/2pi
     * about z from x, and row 0 is +z; or the square of warp_octahedron, row 0 at its
     * u[1] = 0. */
    const struct texture_image *map;
    bool octahedral;
    struct place place;
};

/* A setting given in a scene file, spelled as in --set; applied by the program. */
struct setting_desc {
    char *key, *value;
    struct place place;
};

struct scene_desc {
    char *path;
    char *definitions; /* what was defined for the file beside it, "a=1 b=2", or NULL */
    struct log log;    /* counted warnings of loading */
    struct bsdf *materials;
    size_t material_count, material_capacity;
    struct bsdf **parts; /* children of blends */
    size_t part_count, part_capacity;
    struct texture_set textures;
    struct shape_desc *shapes;
    size_t shape_count, shape_capacity;
    int object_count; /* those of shape_desc.object are 1 .. object_count */
    struct {
        struct instance_desc *list;
        size_t count, capacity;
    } instances;
    struct light_desc *lights;
    size_t light_count, light_capacity;
    char *lost_light; /* the first emitter that was left out, or NULL */
    struct place lost_light_place;
    struct setting_desc *settings;
    size_t setting_count, setting_capacity;
    struct camera_desc camera;
    int width, height; /* full film, before crop */
    int max_depth;     /* edges; 0 = the file does not say */
    /* Paths of one edge, emitters that the camera sees directly, carry no light, and the
     * picture has an alpha channel (path/coverage.h). */
    bool hide_emitters;
    char **strings; /* owned file names for places */
    size_t string_count, string_capacity;
};

struct scene_desc *scene_desc_create(const char *path);
void scene_desc_destroy(struct scene_desc *desc);

/* Each returns the new element's index. The bsdf must be prepared; mesh ownership moves.
 */
int scene_desc_add_material(struct scene_desc *desc, const struct bsdf *bsdf);
/* A copy for the children of blends, which stays where it is. */
const struct bsdf *scene_desc_add_part(struct scene_desc *desc, const struct bsdf *bsdf);
int scene_desc_add_shape(struct scene_desc *desc, const struct shape_desc *shape);
/* A new object, without shapes; its number. */
int scene_desc_add_object(struct scene_desc *desc);
void scene_desc_add_instance(struct scene_desc *desc,
                             const struct instance_desc *instance);
int scene_desc_add_light(struct scene_desc *desc, const struct light_desc *light);
/* Keeps in mind that an emitter is left out, which a scene without any other tells as its
 * error. `what`: its kind and name, as in a file: emitter "sunsky". */
void scene_desc_lose_light(struct scene_desc *desc, const char *what,
                           const struct place *at);
void scene_desc_add_setting(struct scene_desc *desc, const char *key, const char *value,
                            const struct place *at);
/* Keeps a copy of a file name for as long as the desc lives (same name, same pointer). */
const char *scene_desc_keep(struct scene_desc *desc, const char *file);
/* Clamps negative components (spectra) to 0 and counts it in the log. */
struct rgb scene_desc_clamp(struct scene_desc *desc, struct rgb value,
                            const struct place *at);

#endif

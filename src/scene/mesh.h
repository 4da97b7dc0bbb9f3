#ifndef ETALON_SCENE_MESH_H
#define ETALON_SCENE_MESH_H

/* Triangle meshes and the shapes that become meshes. */

#include "base/err.h"
#include "base/log.h"
#include "math/xform.h"

#include <stdint.h>

struct mesh {
    uint32_t vertex_count, triangle_count;
    /* The arrays p and index are padded: 16 bytes may be read at their last element. */
    float *p;        /* [vertex_count][3], world space once in a scene_desc */
    float *n;        /* [vertex_count][3] shading normals, or NULL */
    float *uv;       /* [vertex_count][2], or NULL */
    uint32_t *index; /* [triangle_count][3] */
    /* What its file lacked; mesh_check notes it. */
    struct mesh_remarks {
        uint32_t short_faces;     /* of fewer than three corners, skipped */
        uint32_t missing_normals; /* corners whose normal has the number 0 */
        uint32_t missing_uvs;     /* and whose texture coordinate has */
        uint32_t crossed_faces;   /* polygons left as fans though they are not convex */
    } remarks;
};

struct mesh *mesh_create(uint32_t vertices, uint32_t triangles, bool normals, bool uvs);
void mesh_destroy(struct mesh *mesh);
struct mesh *mesh_copy(const struct mesh *mesh);
/* Transforms positions, and normals by the inverse transpose. Whether the handedness
 * changes is for the shape to know. */
void mesh_transform(struct mesh *mesh, const struct xform *xform);
/* Indices in range, positions and uv finite; normals that are zero or not finite become
 * the mean of the faces around and are counted; degenerate triangles are removed and
 * counted; remarks are noted. */
bool mesh_check(struct mesh *mesh, const struct place *at, struct log *log,
                struct err *err);

/* Leaves out, and counts, triangles that have the corners of another in the same order:
 * as lamps they would shine twice, and be met once. */
void mesh_drop_repeated(struct mesh *mesh, const struct place *at, struct log *log);
double mesh_area(const struct mesh *mesh);

/* Unit square [-1,1]^2 at z = 0, normal +z. */
struct mesh *mesh_rectangle(void);
/* Cube [-1,1]^3, outward faces. */
struct mesh *mesh_box(void);
/* Profile (radius, height) pairs turned about +y; segments >= 3 around; smooth: shading
 * normals from the profile, creases kept where it turns by more than crease degrees. A
 * profile that is closed (last pair = first) or ends on the axis at both ends bounds a
 * solid, and its normals point outward whichever way it runs; of an open one they point
 * to the right of its way, radius to the right and height up. NULL if there are fewer
 * than two pairs or three segments, or a number is not finite, or a radius is negative.
 */
struct mesh *mesh_lathe(const double *profile, int count, int segments, bool smooth,
                        double crease);

/* A circle about +z, and the normal of the surface there (of any length). */
struct mesh_ring {
    double radius, z, normal_radius, normal_z;
};
/* The surface through rings from the first (v = 0) on, from the azimuth 0 (u = 0, at +x)
 * to phi_max (u = 1), at most 2 pi; so many corners to a whole turn. */
#define MESH_REVOLVE_AROUND 128
struct mesh *mesh_revolve(const struct mesh_ring *rings, int count, double phi_max);

/* The limit of Loop's subdivision of a control mesh, each triangle cut into four `levels`
 * times; its shading normals are the limit's. NULL if more than two triangles meet at an
 * edge, or the result would be too large. */
struct mesh *mesh_loop(const struct mesh *control, int levels);

#endif

#ifndef ETALON_SCENE_SHAPE_H
#define ETALON_SCENE_SHAPE_H

/* Shapes as rays and lights see them: one flat record each, indexed by shape id, which is
 * Embree's geometry id too. */

#include "scene/quadric.h"
#include "scene/scene_desc.h"
#include "scene/triangle.h"

/* Above this number of triangles in the scene, face normals are computed at each hit, to
 * the same bits, and only offsets are stored: full faces take nearly as much memory as
 * the meshes (1.9 times their data in all; with offsets alone 1.2). For mmlt at depth 8
 * in a room of 19200 triangles that costs 2.6 % more instructions; computing the offsets
 * too would cost 24 %. */
#define SHAPE_FACES_MOST 250000u

struct shape {
    struct triangles triangles; /* none for a quadric */
    const struct bsdf *bsdf;
    struct quadric *quadric; /* owned; or NULL */
    int32_t light;           /* index of its area light, or -1 */
    bool aligned;            /* the BSDF wants the frame along dp/du */
    bool thin;               /* much of its area lies in thin triangles: needs.robust */
};

/* Whether light may go straight through it on an edge of a path (path/passage.h). Not
 * where a lamp shines from: that is a vertex always. */
static inline bool shape_passes(const struct shape *shape)
{
    return shape->bsdf->flags & BSDF_STRAIGHT && shape->light < 0;
}

/* Checks the description (finite, sizes positive, indices in range; an emitting quadric
 * must be a similarity) and seals it. The mesh is cleaned in place. keep_faces: in full.
 */
bool shape_build(struct shape *shape, struct shape_desc *desc,
                 const struct bsdf *materials, bool keep_faces, struct log *log,
                 struct err *err);
void shape_deinit(struct shape *shape);

/* The box of its vertices; empty (lower above upper) without any. mesh: NULL for a
 * quadric. */
void shape_bounds(const struct shape *shape, const struct mesh *mesh, float lower[3],
                  float upper[3]);
double shape_area(const struct shape *shape);

#endif

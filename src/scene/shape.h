#ifndef ETALON_SCENE_SHAPE_H
#define ETALON_SCENE_SHAPE_H

/* Shapes as rays and lights see them: one flat record each, indexed by shape id, which is
 * Embree's geometry id too. */

#include "scene/quadric.h"
#include "scene/scene_desc.h"
#include "scene/triangle.h"

/* Above this number of triangles in the scene there are no records (scene/triangle.h),
 * which take 64 or 128 bytes a triangle: a hit reads the mesh and computes the normal, to
 * the same bits. Below, the records of a scene take at most 128 MB. */
#define SHAPE_RECORDS_MOST 1000000u

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
 * must be a similarity) and seals it. The mesh is cleaned in place. */
bool shape_build(struct shape *shape, struct shape_desc *desc,
                 const struct bsdf *materials, struct log *log, struct err *err);
void shape_deinit(struct shape *shape);

/* The box of its vertices; empty (lower above upper) without any. mesh: NULL for a
 * quadric. */
void shape_bounds(const struct shape *shape, const struct mesh *mesh, float lower[3],
                  float upper[3]);
double shape_area(const struct shape *shape);

#endif

#ifndef ETALON_SCENE_SHAPE_H
#define ETALON_SCENE_SHAPE_H

/* Shapes as rays and lights see them: one flat record each, indexed by shape id, which is
 * Embree's geometry id too. */

#include "scene/hit.h"
#include "scene/quadric.h"
#include "scene/scene_desc.h"

/* Larger meshes have their faces worked out at each hit (to the same bits): kept, they
 * would take nearly as much as the mesh itself. */
#define SHAPE_FACES_MOST 4000000u

struct shape {
    const uint32_t *index; /* of the mesh; NULL for a quadric */
    const float *p, *n, *uv;
    float *face; /* [triangle_count][4], owned: see triangle.h; NULL for a quadric, and
                  * for a mesh of more than SHAPE_FACES_MOST triangles */
    const struct bsdf *bsdf;
    struct quadric *quadric; /* owned; or NULL */
    int32_t light;           /* index of its area light, or -1 */
    uint32_t triangle_count;
    bool flip;    /* normals to the other side of what winding or mesh normals say */
    bool aligned; /* the BSDF wants the frame along dp/du */
    bool thin;    /* much of its area lies in thin triangles: needs.robust */
};

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
/* Fills face[4] of a triangle as shape->face has it. */
void shape_face(const struct shape *shape, uint32_t triangle, float face[4]);

/* Fills *areas ([triangle_count]) of a mesh. */
void shape_triangle_areas(const struct shape *shape, double *areas);

/* The place at (b1, b2), the weights of corners 1 and 2; ng as at a hit. */
struct anchor shape_triangle_point(const struct shape *shape, uint32_t triangle, float b1,
                                   float b2);

#endif

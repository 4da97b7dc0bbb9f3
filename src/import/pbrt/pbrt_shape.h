#ifndef ETALON_IMPORT_PBRT_SHAPE_H
#define ETALON_IMPORT_PBRT_SHAPE_H

/* What the readers of shapes have in common, and those that lie in files of their own. */

#include "import/pbrt/pbrt_state.h"

/* The shape with what the graphics state holds, its to_world set. Takes its mesh. */
bool pbrt_shape_add(struct pbrt *p, struct shape_desc *shape, struct err *err);
/* Takes the mesh, in object space. Without normals the winding decides the side, and pbrt
 * turns it round where the transform mirrors; with normals their side counts. */
bool pbrt_shape_add_mesh(struct pbrt *p, struct mesh *mesh, struct err *err);
/* The same, with its side decided by the caller. */
bool pbrt_shape_add_turned_mesh(struct pbrt *p, struct mesh *mesh, bool reverse,
                                struct err *err);

/* Adds the triangles of a grid of cells, whose corners lie row by row from `first` on. */
void pbrt_shape_add_cells(struct mesh *mesh, uint32_t first, uint32_t columns,
                          uint32_t rows);

/* An error unless the parameter is NULL or holds so many numbers. */
bool pbrt_shape_count_is(const struct pbrt_param *param, size_t count, struct err *err);
/* An error unless the parameter is NULL or all its numbers are those of points. */
bool pbrt_shape_check_indices(const struct pbrt *p, const struct pbrt_param *index,
                              size_t points, struct err *err);
const struct pbrt_param *pbrt_shape_uv(struct pbrt *p);

/* pbrt_quadric.c: whole spheres, disks and cylinders as such, all else as meshes. */
bool pbrt_quadric_sphere(struct pbrt *p, struct err *err);
bool pbrt_quadric_disk(struct pbrt *p, struct err *err);
bool pbrt_quadric_cylinder(struct pbrt *p, struct err *err);
bool pbrt_quadric_cone(struct pbrt *p, struct err *err);
bool pbrt_quadric_paraboloid(struct pbrt *p, struct err *err);
bool pbrt_quadric_hyperboloid(struct pbrt *p, struct err *err);

/* pbrt_patch.c. */
bool pbrt_patch_bilinear(struct pbrt *p, struct err *err);
bool pbrt_patch_heightfield(struct pbrt *p, struct err *err);

/* pbrt_curve.c. */
bool pbrt_curve(struct pbrt *p, struct err *err);

#endif

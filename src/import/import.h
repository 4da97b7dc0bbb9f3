#ifndef ETALON_IMPORT_IMPORT_H
#define ETALON_IMPORT_IMPORT_H

/* Scene files to scene descriptions; the kind is told by the ending. Warnings are counted
 * in desc->log; errors carry file:line:col. NULL on failure. */

#include "scene/scene_desc.h"

struct scene_desc *import_scene(const char *path, struct err *err); /* by ending */
struct scene_desc *import_yaml(const char *path, struct err *err);
struct scene_desc *import_pbrt(const char *path, struct err *err);

/* A PLY file, also packed (.ply.gz): ascii and both binary orders, polygons fanned into
 * triangles. Strict: any count that the file's size cannot hold is an error. `at`: who
 * asked for the file. */
struct mesh *import_ply(const char *path, const struct place *at, struct err *err);

#endif

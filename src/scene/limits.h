#ifndef ETALON_SCENE_LIMITS_H
#define ETALON_SCENE_LIMITS_H

/* What floats cannot hold: errors where the whole picture would be wrong, counted notes
 * where two surfaces are too near for rays to tell them apart. */

#include "scene/scene.h"

/* Lengths that a scene's shapes may span, world units: rays multiply three of them. */
#define LIMITS_SMALLEST 0x1p-36
#define LIMITS_LARGEST  0x1p40
/* Largest component of all emission: pictures are floats. */
#define LIMITS_DIMMEST   0x1p-110
#define LIMITS_BRIGHTEST 0x1p124

/* Where rays begin besides the shapes: the camera and lights at points. */
bool limits_check_places(const struct scene *scene, struct err *err);
/* A camera whose rays, off by the rounding of their directions, miss their pixel is
 * refused; one whose rays miss it by a quarter is told. */
bool limits_check_camera(const struct scene *scene, struct err *err);
/* Wants scene->shapes. */
bool limits_check_size(const struct scene *scene, struct err *err);
/* max: the largest component; 0 without any. */
bool limits_check_emission(const struct scene *scene, double max, struct err *err);

/* Where looking at all would take too long, a note tells of what was not looked at: a
 * shape is compared with so many of those that begin at its x, and so many shapes and
 * lamps are looked at, each at 32 points. */
#define LIMITS_NEIGHBOURS 64
#define LIMITS_SHAPES     1024
#define LIMITS_LAMPS      1024

/* Shapes that fill the same box but for less than rays can tell from where they come, and
 * surfaces as near to another. Shapes that meet
 * are not found. Wants all of the scene. */
void limits_note_shapes(const struct scene *scene);
/* Lamps that lie upon something else, or in one plane with it; wants all of the scene.
 * What covers less than a 32nd of a lamp may be missed. */
void limits_note_lamps(const struct scene *scene);

#endif

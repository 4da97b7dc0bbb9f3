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

/* A camera whose rays, off by the rounding of their directions, miss their pixel is
 * refused; one whose rays miss it by a quarter is told. */
bool limits_check_camera(const struct scene *scene, struct err *err);
/* Wants scene->shapes. */
bool limits_check_size(const struct scene *scene, struct err *err);
/* max: the largest component; 0 without any. */
bool limits_check_emission(const struct scene *scene, double max, struct err *err);
/* Shapes that fill the same box but for less than rays can tell from where they come, and
 * surfaces as near to another. Wants all of the scene. */
void limits_note_shapes(const struct scene *scene);
/* Lamps in one plane with something else; wants all of the scene. */
void limits_note_lamps(const struct scene *scene);

#endif

#ifndef ETALON_SCENE_LIMITS_H
#define ETALON_SCENE_LIMITS_H

/* Limits of float precision: errors where the whole picture would be wrong, counted notes
 * where two surfaces are too near for rays to distinguish. */

#include "scene/scene.h"

/* Lengths that a scene's shapes may span, world units: rays multiply three of them. */
#define LIMITS_SMALLEST 0x1p-36
#define LIMITS_LARGEST  0x1p40
/* Largest component of all emission: pictures are floats. */
#define LIMITS_DIMMEST   0x1p-110
#define LIMITS_BRIGHTEST 0x1p124

/* Checks the origins of rays besides shapes: the camera and point lights. */
bool limits_check_places(const struct scene *scene, struct err *err);
/* An error if the rounding of directions moves the camera's rays by more than the width
 * of a pixel, a note if by more than a quarter of it. */
bool limits_check_camera(const struct scene *scene, struct err *err);
/* Reads scene->shapes. */
bool limits_check_size(const struct scene *scene, struct err *err);
/* max: the largest component; 0 without any. */
bool limits_check_emission(const struct scene *scene, double max, struct err *err);

/* Limits of the search, beyond which a note says what was not searched: a shape is
 * compared with this many of those that begin at its x, and this many shapes and lamps
 * are examined, each at 32 points. */
#define LIMITS_NEIGHBOURS 64
#define LIMITS_SHAPES     1024
#define LIMITS_LAMPS      1024

/* Notes shapes with the same box up to the precision of rays, and surfaces that are as
 * near to each other. Shapes that intersect are not found. Called once the scene is
 * complete. */
void limits_note_shapes(const struct scene *scene);
/* Notes lamps that lie on another surface or in one plane with it. Called once the scene
 * is complete. A surface that covers less than 1/32 of a lamp may be missed. */
void limits_note_lamps(const struct scene *scene);

#endif

#ifndef ETALON_SCENE_PLACEMENT_H
#define ETALON_SCENE_PLACEMENT_H

/* From the objects and instances of a description to those of a scene. Embree knows one
 * level of instances (RTC_MAX_INSTANCE_LEVEL_COUNT is 1 in the common packages), so
 * nested ones are multiplied out: each way in which an object lies in the scene is one
 * record. Triangles are kept once all the same.
 *
 * Copied instead are shapes that emit, for each light has its own place and power;
 * objects that lie in the scene once, which are moved; and where floats would not hold
 * the transform (instance_fits). */

#include "base/err.h"

struct scene;
struct scene_options;

/* INSTANCES_AUTO copies where the copies of all objects come to no more triangles than
 * this (13 MB, the hierarchy included), a shape counted as 16 besides. In lux-luxtime
 * (112 instances, 22420 triangles) paths take 4 % more time on shared objects. */
#define PLACEMENT_COPIES 131072.0

/* Sets scene->objects and instances (their boxes not yet), and sorts the shapes of the
 * description by object, those of the scene itself first, in their order. Errors: an
 * object that is not there, one that contains itself, a transform that has no inverse,
 * and more instances than there is memory for, before any is taken. */
bool placement_resolve(struct scene *scene, const struct scene_options *options,
                       struct err *err);
/* Fills in the boxes; wants scene->shapes. */
void placement_bound(struct scene *scene);

#endif

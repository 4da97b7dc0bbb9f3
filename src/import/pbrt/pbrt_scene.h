#ifndef ETALON_IMPORT_PBRT_SCENE_H
#define ETALON_IMPORT_PBRT_SCENE_H

/* pbrt's directives that make things; all work on p->params, already parsed. */

#include "import/pbrt/pbrt_state.h"

/* Material of the kind `type`; *index of the desc, or PBRT_MATERIAL_NONE. */
bool pbrt_material(struct pbrt *p, const char *type, const struct place *at, int *index,
                   struct err *err);
/* The default material, made at its first use. */
bool pbrt_material_default(struct pbrt *p, int *index, struct err *err);

/* v3: keeps p->params as those that made the material; and the material (or
 * PBRT_MATERIAL_DEFAULT) as a shape's own p->params would have it, which is the same
 * where they say nothing of it (pbrt_material_shape.c). */
void pbrt_material_keep(struct pbrt *p, int material, const char *type);
bool pbrt_material_of_shape(struct pbrt *p, int *material, struct err *err);

/* The directives Material, MakeNamedMaterial and NamedMaterial. */
bool pbrt_material_set(struct pbrt *p, struct err *err);
bool pbrt_material_make(struct pbrt *p, struct err *err);
bool pbrt_material_named(struct pbrt *p, struct err *err);

/* v4's directives of settings. Attribute: its parameters serve all directives of a kind
 * that follow; what the directive may take of them goes behind its own. */
bool pbrt_option(struct pbrt *p, struct err *err);
bool pbrt_attribute(struct pbrt *p, struct err *err);
void pbrt_attribute_apply(struct pbrt *p, const char *directive);
bool pbrt_colour_space(struct pbrt *p, struct err *err);

bool pbrt_shape(struct pbrt *p, struct err *err);

bool pbrt_light_area(struct pbrt *p, struct err *err);
/* Of a shape that the state's area light makes a lamp. */
struct rgb pbrt_light_radiance(const struct pbrt *p, const struct shape_desc *shape);
bool pbrt_light_source(struct pbrt *p, struct err *err);

/* Objects and their instances. */
bool pbrt_object_begin(struct pbrt *p, struct err *err);
bool pbrt_object_end(struct pbrt *p, struct err *err);
bool pbrt_object_instance(struct pbrt *p, struct err *err);
/* Adds the shape to the scene, or to the object that is open. Takes its mesh. */
void pbrt_object_add(struct pbrt *p, const struct shape_desc *shape);
/* After the last directive: leaves out shapes that wait for an instance's material. */
void pbrt_object_finish(struct pbrt *p);

/* The transforms read their own numbers from p->lexer. */
bool pbrt_transform_identity(struct pbrt *p, struct err *err);
bool pbrt_transform_translate(struct pbrt *p, struct err *err);
bool pbrt_transform_scale(struct pbrt *p, struct err *err);
bool pbrt_transform_rotate(struct pbrt *p, struct err *err);
bool pbrt_transform_look_at(struct pbrt *p, struct err *err);
bool pbrt_transform_set(struct pbrt *p, struct err *err);
bool pbrt_transform_concat(struct pbrt *p, struct err *err);
/* CoordinateSystem, CoordSysTransform, ActiveTransform and TransformTimes. */
bool pbrt_transform_name(struct pbrt *p, struct err *err);
bool pbrt_transform_to_named(struct pbrt *p, struct err *err);
bool pbrt_transform_active(struct pbrt *p, struct err *err);
bool pbrt_transform_times(struct pbrt *p, struct err *err);

bool pbrt_camera(struct pbrt *p, struct err *err);
bool pbrt_film(struct pbrt *p, struct err *err);
bool pbrt_integrator(struct pbrt *p, struct err *err);
bool pbrt_filter(struct pbrt *p, struct err *err);
/* Sampler and Accelerator: their kinds and parameters change no expected value. */
bool pbrt_ignored(struct pbrt *p, struct err *err);

#endif

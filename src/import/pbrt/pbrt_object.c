#include "import/pbrt/pbrt_scene.h"

#include "base/mem.h"

bool pbrt_object_begin(struct pbrt *p, struct err *err)
{
    if (p->in_object)
        return err_set(err, ERR_SYNTAX, &p->params.place,
                       "ObjectBegin inside of an object");
    pbrt_state_push(p, false, &p->params.place);
    struct pbrt_named *object = pbrt_names_add(&p->objects,
                                               pbrt_params_head(&p->params, 0));
    object->first = p->part_count;
    p->in_object = true;
    return true;
}

bool pbrt_object_end(struct pbrt *p, struct err *err)
{
    if (!p->in_object)
        return err_set(err, ERR_SYNTAX, &p->params.place,
                       "ObjectEnd without ObjectBegin");
    struct pbrt_named *object = &p->objects.list[p->objects.count - 1];
    object->count = p->part_count - object->first;
    p->in_object = false;
    return pbrt_state_pop(p, false, &p->params.place, err);
}

void pbrt_object_add(struct pbrt *p, const struct shape_desc *shape)
{
    if (!p->in_object) {
        scene_desc_add_shape(p->desc, shape);
        return;
    }
    p->parts = mem_grow(p->parts, &p->part_capacity, p->part_count + 1, sizeof *p->parts);
    p->parts[p->part_count++] = *shape;
}

/* Each instance is a copy: lights, ids and rays know shapes only, no instances. */
static bool place_part(struct pbrt *p, const struct shape_desc *part, struct err *err)
{
    struct shape_desc shape = *part;
    if (shape.material == PBRT_MATERIAL_DEFAULT) {
        shape.material = p->state.material;
        if (shape.material < 0 && !pbrt_material_default(p, &shape.material, err))
            return false;
    }
    bool mirrored = xform_swaps_handedness(&p->state.ctm);
    bool keeps = part->mesh ? part->mesh->n != NULL : part->emits;
    bool turn = mirrored && !keeps; /* lamps: as in pbrt_quadric.c */
    shape.reverse_orientation = part->reverse_orientation != turn;
    shape.place = p->params.place;
    if (part->mesh) {
        shape.mesh = mesh_copy(part->mesh);
        mesh_transform(shape.mesh, &p->state.ctm);
    } else {
        shape.to_world = xform_mul(&p->state.ctm, &part->to_world);
    }
    scene_desc_add_shape(p->desc, &shape);
    return true;
}

bool pbrt_object_instance(struct pbrt *p, struct err *err)
{
    if (p->in_object)
        return err_set(err, ERR_SYNTAX, &p->params.place,
                       "ObjectInstance inside of an object");
    const struct pbrt_named *object = pbrt_names_find(&p->objects, "object",
                                                      pbrt_params_head(&p->params, 0),
                                                      &p->params.head_places[0], err);
    if (!object || !pbrt_state_check(p, err))
        return false;
    p->desc->instance_count++;
    for (size_t i = 0; i < object->count; i++)
        if (!place_part(p, &p->parts[object->first + i], err))
            return false;
    return true;
}

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
    object->first = p->desc->shape_count;
    object->object = p->in_object = scene_desc_add_object(p->desc);
    return true;
}

bool pbrt_object_end(struct pbrt *p, struct err *err)
{
    if (!p->in_object)
        return err_set(err, ERR_SYNTAX, &p->params.place,
                       "ObjectEnd without ObjectBegin");
    struct pbrt_named *object = &p->objects.list[p->objects.count - 1];
    object->count = p->desc->shape_count - object->first;
    p->in_object = 0;
    return pbrt_state_pop(p, false, &p->params.place, err);
}

void pbrt_object_add(struct pbrt *p, const struct shape_desc *shape)
{
    int id = scene_desc_add_shape(p->desc, shape);
    p->desc->shapes[id].object = p->in_object;
}

static bool takes_material(const struct pbrt *p, const struct pbrt_named *object)
{
    for (size_t i = 0; i < object->count; i++)
        if (p->desc->shapes[object->first + i].material == PBRT_MATERIAL_DEFAULT)
            return true;
    return false;
}

/* A second object of the same shapes; those without a material take the state's. */
static bool add_variant(struct pbrt *p, const struct pbrt_named *object, int *placed,
                        struct err *err)
{
    int material = p->state.material;
    if (material < 0 && !pbrt_material_default(p, &material, err))
        return false;
    *placed = scene_desc_add_object(p->desc);
    for (size_t i = 0; i < object->count; i++) {
        struct shape_desc shape = p->desc->shapes[object->first + i];
        shape.object = *placed;
        if (shape.material == PBRT_MATERIAL_DEFAULT)
            shape.material = material;
        if (shape.mesh)
            shape.mesh = mesh_copy(shape.mesh);
        scene_desc_add_shape(p->desc, &shape);
    }
    p->variants = mem_grow(p->variants, &p->variant_capacity, p->variant_count + 1,
                           sizeof *p->variants);
    p->variants[p->variant_count++] = (struct pbrt_variant){object->object,
                                                            p->state.material, *placed};
    return true;
}

/* The object to put down for this one. */
static bool choose_variant(struct pbrt *p, const struct pbrt_named *object, int *placed,
                           struct err *err)
{
    *placed = object->object;
    if (!takes_material(p, object))
        return true;
    for (size_t i = 0; i < p->variant_count; i++) {
        const struct pbrt_variant *v = &p->variants[i];
        if (v->object == object->object && v->material == p->state.material) {
            *placed = v->placed;
            return true;
        }
    }
    return add_variant(p, object, placed, err);
}

bool pbrt_object_instance(struct pbrt *p, struct err *err)
{
    if (p->in_object)
        return err_set(err, ERR_SYNTAX, &p->params.place,
                       "ObjectInstance inside of an object");
    const struct pbrt_named *object = pbrt_names_find(&p->objects, "object",
                                                      pbrt_params_head(&p->params, 0),
                                                      &p->params.head_places[0], err);
    struct instance_desc instance = {.to_world = p->state.ctm, .place = p->params.place};
    if (!object || !pbrt_state_check(p, err) ||
        !choose_variant(p, object, &instance.object, err))
        return false;
    scene_desc_add_instance(p->desc, &instance);
    return true;
}

void pbrt_object_finish(struct pbrt *p)
{
    struct scene_desc *desc = p->desc;
    size_t kept = 0;
    for (size_t i = 0; i < desc->shape_count; i++) {
        if (desc->shapes[i].material == PBRT_MATERIAL_DEFAULT)
            mesh_destroy(desc->shapes[i].mesh);
        else
            desc->shapes[kept++] = desc->shapes[i];
    }
    desc->shape_count = kept;
}

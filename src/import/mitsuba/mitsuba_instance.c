#include "import/mitsuba/mitsuba_instance.h"

#include "base/text.h"
#include "import/mitsuba/mitsuba_property.h"
#include "import/mitsuba/mitsuba_scene.h"
#include "import/mitsuba/mitsuba_transform.h"

void mitsuba_instance_add(struct mitsuba *m, const struct shape_desc *shape)
{
    int id = scene_desc_add_shape(m->desc, shape);
    m->desc->shapes[id].object = m->in_group;
}

/* All shapes of the group, once. */
static bool read_group(struct mitsuba *m, struct mitsuba_node *group, struct err *err)
{
    if (group->object)
        return true;
    bool read = mitsuba_enter(m, group, err);
    if (!read)
        return false;
    group->object = m->in_group = scene_desc_add_object(m->desc);
    for (size_t i = 0; read && i < group->child_count; i++) {
        struct mitsuba_node *child = mitsuba_resolve(m, group->children[i], err);
        read = child != NULL;
        if (!read || !text_equal(child->name, "shape"))
            continue;
        group->children[i]->used = true;
        read = mitsuba_shape(m, child, err);
    }
    m->in_group = 0;
    mitsuba_leave(m, group);
    if (read)
        mitsuba_report(m, group);
    return read;
}

/* Mitsuba knows one level: an instance of a group of shapes that are none. */
static struct mitsuba_node *find_group(struct mitsuba *m, struct mitsuba_node *object,
                                       struct err *err)
{
    struct mitsuba_node *group = NULL;
    if (m->in_group)
        err_set(err, ERR_VALUE, &object->place,
                "an instance within a shapegroup: Mitsuba nests none");
    else if (!mitsuba_child(m, object, "shape", &group, err))
        return NULL;
    if (group && text_equal(mitsuba_type(group), "shapegroup"))
        return group;
    err_set(err, ERR_VALUE, &object->place, /* unless one was set before */
            "shape \"instance\" wants a shape \"shapegroup\"");
    return NULL;
}

bool mitsuba_instance(struct mitsuba *m, struct mitsuba_node *object, struct err *err)
{
    struct mitsuba_node *group = find_group(m, object, err);
    struct instance_desc instance = {.to_world = xform_identity(),
                                     .place = object->place};
    if (!group || !mitsuba_transform(object, "to_world", &instance.to_world, err) ||
        !read_group(m, group, err))
        return false;
    mitsuba_report(m, object);
    instance.object = group->object;
    scene_desc_add_instance(m->desc, &instance);
    return true;
}

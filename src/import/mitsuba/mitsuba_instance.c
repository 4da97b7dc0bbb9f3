#include "import/mitsuba/mitsuba_instance.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/instance.h"
#include "import/mitsuba/mitsuba_property.h"
#include "import/mitsuba/mitsuba_scene.h"
#include "import/mitsuba/mitsuba_transform.h"

void mitsuba_instance_add(struct mitsuba *m, const struct shape_desc *shape)
{
    if (!m->in_group) {
        scene_desc_add_shape(m->desc, shape);
        return;
    }
    m->parts = mem_grow(m->parts, &m->part_capacity, m->part_count + 1, sizeof *m->parts);
    m->parts[m->part_count++] = *shape;
}

void mitsuba_instance_deinit(struct mitsuba *m)
{
    for (size_t i = 0; i < m->part_count; i++)
        mesh_destroy(m->parts[i].mesh);
    mem_free(m->parts);
}

/* All shapes of the group, once. */
static bool read_group(struct mitsuba *m, struct mitsuba_node *group, struct err *err)
{
    if (group->parts_read)
        return true;
    bool read = mitsuba_enter(m, group, err);
    if (!read)
        return false;
    group->part_first = m->part_count;
    m->in_group = true;
    for (size_t i = 0; read && i < group->child_count; i++) {
        struct mitsuba_node *child = mitsuba_resolve(m, group->children[i], err);
        read = child != NULL;
        if (!read || !text_equal(child->name, "shape"))
            continue;
        group->children[i]->used = true;
        read = mitsuba_shape(m, child, err);
    }
    m->in_group = false;
    mitsuba_leave(m, group);
    group->part_count = m->part_count - group->part_first;
    group->parts_read = true;
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
    struct xform to_world = xform_identity();
    if (!group || !mitsuba_transform(object, "to_world", &to_world, err) ||
        !read_group(m, group, err))
        return false;
    mitsuba_report(m, object);
    m->desc->instance_count++;
    for (size_t i = 0; i < group->part_count; i++)
        instance_place(m->desc, &m->parts[group->part_first + i], &to_world,
                       &object->place);
    return true;
}

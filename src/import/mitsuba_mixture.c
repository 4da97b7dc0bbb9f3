/* Materials made of others. */
#include "import/mitsuba_scene.h"

#include "base/text.h"

/* The first two BSDFs that it holds; inner[1] is NULL where there is only one. */
static bool find_two(struct mitsuba *m, const struct mitsuba_node *object,
                     struct mitsuba_node *inner[2], struct err *err)
{
    inner[0] = inner[1] = NULL;
    for (size_t i = 0; i < object->child_count; i++) {
        struct mitsuba_node *target = mitsuba_resolve(m, object->children[i], err);
        if (!target)
            return false;
        if (!text_equal(target->name, "bsdf") || inner[1])
            continue;
        object->children[i]->used = true;
        inner[inner[0] != NULL] = target;
    }
    return inner[0] || err_set(err, ERR_VALUE, &object->place,
                               "bsdf \"%s\" wants a <bsdf> in it", mitsuba_type(object));
}

/* As a child of another material; NULL: light passes through. */
static bool read_part(struct mitsuba *m, struct mitsuba_node *inner,
                      const struct bsdf **part, struct err *err)
{
    int index;
    if (!mitsuba_material(m, inner, &index, err))
        return false;
    *part = index == MITSUBA_MATERIAL_NONE
                ? NULL
                : scene_desc_add_part(m->desc, &m->desc->materials[index]);
    return true;
}

/* What lets all light through, as a child. */
static bool clear_part(struct mitsuba *m, const struct mitsuba_node *object,
                       const struct bsdf **part, struct err *err)
{
    struct bsdf bsdf;
    bsdf_init(&bsdf, bsdf_find("null"));
    if (!bsdf_prepare(&bsdf, &object->place, err))
        return false;
    *part = scene_desc_add_part(m->desc, &bsdf);
    return true;
}

/* Of those that change other materials: the first that it holds. */
bool mitsuba_mixture_first(struct mitsuba *m, struct mitsuba_node *object, int *index,
                           struct err *err)
{
    struct mitsuba_node *inner[2];
    return find_two(m, object, inner, err) && mitsuba_material(m, inner[0], index, err);
}

/* One material for both sides, or one for each. */
bool mitsuba_mixture_sides(struct mitsuba *m, struct mitsuba_node *object, int *index,
                           struct err *err)
{
    struct mitsuba_node *inner[2];
    struct bsdf bsdf;
    if (!find_two(m, object, inner, err))
        return false;
    bsdf_init(&bsdf, bsdf_find("sides"));
    m->two_sided++;
    bool read = inner[1] ? read_part(m, inner[0], &bsdf.child[0], err) &&
                               read_part(m, inner[1], &bsdf.child[1], err)
                         : mitsuba_material(m, inner[0], index, err);
    m->two_sided--;
    bsdf.bump = inner[1] && bsdf.child[0] ? bsdf.child[0]->bump : NULL;
    return read && (!inner[1] || mitsuba_material_add(m, &bsdf, object, index, err));
}

bool mitsuba_mixture_blend(struct mitsuba *m, struct mitsuba_node *object, int *index,
                           struct err *err)
{
    struct mitsuba_node *inner[2];
    struct bsdf bsdf;
    if (!find_two(m, object, inner, err))
        return false;
    bsdf_init(&bsdf, bsdf_find("blend"));
    if (!inner[1])
        return err_set(err, ERR_VALUE, &object->place,
                       "bsdf \"%s\" wants two <bsdf> in it", mitsuba_type(object));
    for (int i = 0; i < 2; i++)
        if (!read_part(m, inner[i], &bsdf.child[i], err) ||
            (!bsdf.child[i] && !clear_part(m, object, &bsdf.child[i], err)))
            return false;
    bsdf.bump = bsdf.child[0]->bump;
    return mitsuba_material_pass(m, object, "weight", 0.5, &bsdf, "weight", err) &&
           mitsuba_material_add(m, &bsdf, object, index, err);
}

bool mitsuba_mixture_mask(struct mitsuba *m, struct mitsuba_node *object, int *index,
                          struct err *err)
{
    struct mitsuba_node *inner[2];
    struct bsdf bsdf;
    bsdf_init(&bsdf, bsdf_find("blend"));
    if (!find_two(m, object, inner, err) || !clear_part(m, object, &bsdf.child[0], err) ||
        !read_part(m, inner[0], &bsdf.child[1], err))
        return false;
    bsdf.bump = bsdf.child[1] ? bsdf.child[1]->bump : NULL;
    return mitsuba_material_pass(m, object, "opacity", 0.5, &bsdf, "weight", err) &&
           mitsuba_material_add(m, &bsdf, object, index, err);
}

/* The texture displaces the surface of the one material that it holds. */
bool mitsuba_mixture_bump(struct mitsuba *m, struct mitsuba_node *object, int *index,
                          struct err *err)
{
    struct mitsuba_node *inner[2], *node;
    const struct texture *texture;
    double scale = 1.0;
    if (!find_two(m, object, inner, err) ||
        !mitsuba_float(object, "scale", &scale, err) ||
        !mitsuba_child(m, object, "texture", &node, err))
        return false;
    if (!node)
        return err_set(err, ERR_VALUE, &object->place,
                       "bsdf \"bumpmap\" wants a <texture> in it");
    if (!mitsuba_texture(m, node, &texture, err) ||
        !mitsuba_material(m, inner[0], index, err))
        return false;
    if (*index == MITSUBA_MATERIAL_NONE)
        return true;
    struct bsdf bsdf = m->desc->materials[*index];
    struct texture_set *set = &m->desc->textures;
    bsdf.bump = scale == 1.0 ? texture
                             : texture_product(set, texture,
                                               texture_constant(set, rgb_grey(scale)));
    *index = scene_desc_add_material(m->desc, &bsdf);
    return true;
}

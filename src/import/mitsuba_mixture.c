/* Materials made of others. */
#include "import/mitsuba_scene.h"

#include "base/text.h"

#define MIXTURE_PARTS 32

/* The first BSDFs that it holds, at least one. */
static bool find_some(struct mitsuba *m, const struct mitsuba_node *object,
                      struct mitsuba_node **inner, size_t room, size_t *count,
                      struct err *err)
{
    *count = 0;
    for (size_t i = 0; i < object->child_count; i++) {
        struct mitsuba_node *target = mitsuba_resolve(m, object->children[i], err);
        if (!target)
            return false;
        if (!text_equal(target->name, "bsdf") || *count == room)
            continue;
        object->children[i]->used = true;
        inner[(*count)++] = target;
    }
    if (*count > 0)
        return true;
    err_set(err, ERR_VALUE, &object->place, "bsdf \"%s\" wants a <bsdf> in it",
            mitsuba_type(object));
    return false;
}

/* inner[1] is NULL where there is only one. */
static bool find_two(struct mitsuba *m, const struct mitsuba_node *object,
                     struct mitsuba_node *inner[2], struct err *err)
{
    size_t count;
    inner[0] = inner[1] = NULL;
    return find_some(m, object, inner, 2, &count, err);
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

/* A weight for each part; together at most 1. */
static bool read_weights(struct mitsuba *m, struct mitsuba_node *object, double *weights,
                         size_t parts, struct err *err)
{
    struct mitsuba_node *node = mitsuba_property(object, "weights");
    size_t count;
    double sum = 0.0;
    if (!node)
        return err_set(err, ERR_VALUE, &object->place,
                       "bsdf \"%s\" wants a string \"weights\"", mitsuba_type(object));
    if (!mitsuba_numbers(node, "value", MIXTURE_PARTS, weights, &count, err))
        return false;
    if (count != parts)
        return err_set(err, ERR_VALUE, &node->place,
                       "%zu weights for %zu materials (at most %d)", count, parts,
                       MIXTURE_PARTS);
    for (size_t i = 0; i < count; i++) {
        if (weights[i] < 0.0)
            return err_set(err, ERR_VALUE, &node->place, "a weight is negative");
        sum += weights[i];
    }
    if (sum > 1.0 + 1e-6)
        log_note(&m->desc->log, &node->place,
                 "weights that exceed 1 together are scaled down");
    for (size_t i = 0; sum > 1.0 && i < count; i++)
        weights[i] /= sum;
    return true;
}

/* Blends within blends, the last part innermost; what the weights leave is black. */
bool mitsuba_mixture_weighted(struct mitsuba *m, struct mitsuba_node *object, int *index,
                              struct err *err)
{
    struct mitsuba_node *inner[MIXTURE_PARTS];
    struct bsdf blend = {0};
    const struct bsdf *below = NULL, *part = NULL;
    double weights[MIXTURE_PARTS] = {0.0}, below_share = 1.0;
    size_t count;
    if (!find_some(m, object, inner, MIXTURE_PARTS, &count, err) ||
        !read_weights(m, object, weights, count, err))
        return false;
    for (size_t i = 0; i < count; i++)
        below_share -= weights[i];
    below_share = below_share > 1e-9 ? below_share : 0.0; /* of rounding */
    for (size_t i = count; i-- > 0;) {
        double share = below_share + weights[i];
        double weight = share > 0.0 ? weights[i] / share : 0.0;
        below_share = share;
        bsdf_init(&blend, bsdf_find("blend"));
        if (!read_part(m, inner[i], &part, err) ||
            (!part && !clear_part(m, object, &part, err)) ||
            !bsdf_set(&blend, "weight", (double[]){weight, weight, weight}, 3,
                      &object->place, err))
            return false;
        blend.child[0] = below;
        blend.child[1] = part;
        if (!bsdf_prepare(&blend, &object->place, err))
            return false;
        below = scene_desc_add_part(m->desc, &blend);
    }
    blend.bump = part ? part->bump : NULL;
    return mitsuba_material_add(m, &blend, object, index, err);
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

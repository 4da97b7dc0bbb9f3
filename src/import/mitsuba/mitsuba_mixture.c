#include "import/mitsuba/mitsuba_mixture.h"

#include "import/mitsuba/mitsuba_bsdf.h"
#include "import/mitsuba/mitsuba_property.h"
#include "import/mitsuba/mitsuba_texture.h"

/* Adds a material as a child of another; NULL: light passes through. */
static const struct bsdf *add_part(struct mitsuba *m, int index)
{
    return index == MITSUBA_MATERIAL_NONE
               ? NULL
               : scene_desc_add_part(m->desc, &m->desc->materials[index]);
}

/* A child that lets all light through. */
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

/* Adds a part of a blend as a child. */
static bool blend_part(struct mitsuba *m, const struct mitsuba_node *object, int index,
                       const struct bsdf **part, struct err *err)
{
    *part = add_part(m, index);
    return *part || clear_part(m, object, part, err);
}

/* Maps of normals belong to the outermost node. */
static void keep_relief(struct bsdf *outer, const struct bsdf *part)
{
    if (part)
        outer->relief = part->relief;
}

bool mitsuba_mixture_first(struct mitsuba *m, struct mitsuba_node *object,
                           const struct mitsuba_parts *parts, int *index, struct err *err)
{
    (void)m, (void)object, (void)err;
    *index = parts->index[0];
    return true;
}

bool mitsuba_mixture_sides(struct mitsuba *m, struct mitsuba_node *object,
                           const struct mitsuba_parts *parts, int *index, struct err *err)
{
    struct bsdf bsdf;
    if (parts->count == 1)
        return mitsuba_mixture_first(m, object, parts, index, err);
    mitsuba_bsdf_start(&bsdf, "sides");
    for (int i = 0; i < 2; i++)
        bsdf.child[i] = add_part(m, parts->index[i]);
    keep_relief(&bsdf, bsdf.child[0]);
    return mitsuba_bsdf_add(m, &bsdf, object, index, err);
}

bool mitsuba_mixture_blend(struct mitsuba *m, struct mitsuba_node *object,
                           const struct mitsuba_parts *parts, int *index, struct err *err)
{
    struct bsdf bsdf;
    if (parts->count < 2)
        return err_set(err, ERR_VALUE, &object->place,
                       "bsdf \"%s\" wants two <bsdf> in it", mitsuba_type(object));
    mitsuba_bsdf_start(&bsdf, "blend");
    for (int i = 0; i < 2; i++)
        if (!blend_part(m, object, parts->index[i], &bsdf.child[i], err))
            return false;
    keep_relief(&bsdf, bsdf.child[0]);
    return mitsuba_bsdf_pass(m, object, "weight", 0.5, &bsdf, "weight", err) &&
           mitsuba_bsdf_add(m, &bsdf, object, index, err);
}

bool mitsuba_mixture_mask(struct mitsuba *m, struct mitsuba_node *object,
                          const struct mitsuba_parts *parts, int *index, struct err *err)
{
    struct bsdf bsdf;
    mitsuba_bsdf_start(&bsdf, "blend");
    if (!clear_part(m, object, &bsdf.child[0], err))
        return false;
    bsdf.child[1] = add_part(m, parts->index[0]);
    keep_relief(&bsdf, bsdf.child[1]);
    return mitsuba_bsdf_pass(m, object, "opacity", 0.5, &bsdf, "weight", err) &&
           mitsuba_bsdf_add(m, &bsdf, object, index, err);
}

/* A weight for each part; together at most 1. */
static bool read_weights(struct mitsuba *m, struct mitsuba_node *object, size_t parts,
                         double *weights, struct err *err)
{
    struct mitsuba_node *node = mitsuba_property(object, "weights");
    size_t count;
    double sum = 0.0;
    if (!node)
        return err_set(err, ERR_VALUE, &object->place,
                       "bsdf \"%s\" wants a string \"weights\"", mitsuba_type(object));
    if (!mitsuba_numbers(node, "value", MITSUBA_PARTS_MAX, weights, &count, err))
        return false;
    if (count != parts)
        return err_set(err, ERR_VALUE, &node->place,
                       "%zu weights for %zu materials (at most %d)", count, parts,
                       MITSUBA_PARTS_MAX);
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
bool mitsuba_mixture_weighted(struct mitsuba *m, struct mitsuba_node *object,
                              const struct mitsuba_parts *parts, int *index,
                              struct err *err)
{
    struct bsdf blend = {0};
    const struct bsdf *below = NULL, *part = NULL;
    double weights[MITSUBA_PARTS_MAX] = {0.0}, below_share = 1.0;
    if (!read_weights(m, object, parts->count, weights, err))
        return false;
    for (size_t i = 0; i < parts->count; i++)
        below_share -= weights[i];
    below_share = below_share > 1e-9 ? below_share : 0.0; /* of rounding */
    for (size_t i = parts->count; i-- > 0;) {
        double share = below_share + weights[i];
        double weight = share > 0.0 ? weights[i] / share : 0.0;
        below_share = share;
        mitsuba_bsdf_start(&blend, "blend");
        if (!blend_part(m, object, parts->index[i], &part, err) ||
            !mitsuba_bsdf_set_rgb(&blend, "weight", rgb_grey(weight), object, err))
            return false;
        blend.child[0] = below;
        blend.child[1] = part;
        if (!bsdf_prepare(&blend, &object->place, err))
            return false;
        below = scene_desc_add_part(m->desc, &blend);
    }
    keep_relief(&blend, part);
    return mitsuba_bsdf_add(m, &blend, object, index, err);
}

/* The texture that stands in a bumpmap or normalmap. */
static bool read_relief(struct mitsuba *m, struct mitsuba_node *object,
                        const struct texture **texture, struct err *err)
{
    struct mitsuba_node *node;
    if (!mitsuba_child(m, object, "texture", &node, err))
        return false;
    if (!node) {
        err_set(err, ERR_VALUE, &object->place, "bsdf \"%s\" wants a <texture> in it",
                mitsuba_type(object));
        return false;
    }
    return mitsuba_texture(m, node, texture, err);
}

/* A copy of the part with another relief. */
static void add_turned(struct mitsuba *m, const struct mitsuba_parts *parts,
                       struct bsdf_relief relief, int *index)
{
    *index = parts->index[0];
    if (*index == MITSUBA_MATERIAL_NONE)
        return;
    struct bsdf bsdf = m->desc->materials[*index];
    bsdf.relief = relief;
    *index = scene_desc_add_material(m->desc, &bsdf);
}

/* The texture displaces the surface. */
bool mitsuba_mixture_bump(struct mitsuba *m, struct mitsuba_node *object,
                          const struct mitsuba_parts *parts, int *index, struct err *err)
{
    const struct texture *texture;
    struct texture_set *set = &m->desc->textures;
    double scale = 1.0;
    if (!mitsuba_float(object, "scale", &scale, err) ||
        !read_relief(m, object, &texture, err))
        return false;
    if (scale != 1.0)
        texture = texture_product(set, texture, texture_constant(set, rgb_grey(scale)));
    add_turned(m, parts, (struct bsdf_relief){.texture = texture}, index);
    return true;
}

/* The texture holds the normals. */
bool mitsuba_mixture_normals(struct mitsuba *m, struct mitsuba_node *object,
                             const struct mitsuba_parts *parts, int *index,
                             struct err *err)
{
    const struct texture *texture;
    if (!read_relief(m, object, &texture, err))
        return false;
    add_turned(m, parts, (struct bsdf_relief){.texture = texture, .normals = true},
               index);
    return true;
}

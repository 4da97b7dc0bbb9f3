#include "import/mitsuba/mitsuba_bsdf.h"

#include "base/text.h"
#include "import/mitsuba/mitsuba_property.h"

#include <math.h>

#define ALPHA_MIN 1e-4 /* Mitsuba's smallest roughness */

void mitsuba_bsdf_start(struct bsdf *bsdf, const char *kind)
{
    bsdf_init(bsdf, bsdf_find(kind));
}

bool mitsuba_bsdf_set_rgb(struct bsdf *bsdf, const char *name, struct rgb value,
                          const struct mitsuba_node *object, struct err *err)
{
    return bsdf_set(bsdf, name, &value.r, 3, &object->place, err);
}

bool mitsuba_bsdf_add(struct mitsuba *m, struct bsdf *bsdf,
                      const struct mitsuba_node *object, int *index, struct err *err)
{
    if (!bsdf_prepare(bsdf, &object->place, err))
        return false;
    *index = scene_desc_add_material(m->desc, bsdf);
    return true;
}

bool mitsuba_bsdf_add_opaque(struct mitsuba *m, struct bsdf *bsdf,
                             const struct mitsuba_node *object, int *index,
                             struct err *err)
{
    struct bsdf sides;
    if (!bsdf_prepare(bsdf, &object->place, err))
        return false;
    if (m->two_sided > 0 || bsdf->flags & BSDF_BLACK)
        return mitsuba_bsdf_add(m, bsdf, object, index, err);
    mitsuba_bsdf_start(&sides, "sides");
    sides.child[0] = scene_desc_add_part(m->desc, bsdf);
    return mitsuba_bsdf_add(m, &sides, object, index, err);
}

bool mitsuba_bsdf_set_value(struct bsdf *bsdf, const char *name,
                            const struct mitsuba_value *value,
                            const struct mitsuba_node *object, struct err *err)
{
    return value->texture ? bsdf_bind(bsdf, name, value->texture, &object->place, err)
                          : mitsuba_bsdf_set_rgb(bsdf, name, value->value, object, err);
}

bool mitsuba_bsdf_pass(struct mitsuba *m, struct mitsuba_node *object, const char *name,
                       double fallback, struct bsdf *bsdf, const char *to,
                       struct err *err)
{
    struct mitsuba_value value = {.value = rgb_grey(fallback)};
    return mitsuba_value(m, object, name, &value, err) &&
           mitsuba_bsdf_set_value(bsdf, to, &value, object, err);
}

bool mitsuba_bsdf_set_number(struct bsdf *bsdf, const char *name, double value,
                             const struct mitsuba_node *object, struct err *err)
{
    return bsdf_set(bsdf, name, &value, 1, &object->place, err);
}

static double at_least(double alpha)
{
    return fmax(alpha, ALPHA_MIN);
}

/* A number or its texture, nowhere less than what Mitsuba allows. */
static bool pass_alpha(struct mitsuba *m, const struct mitsuba_node *object,
                       const char *name, const struct mitsuba_value *value,
                       struct bsdf *bsdf, struct err *err)
{
    if (value->texture) {
        const struct texture *rough = texture_curve(&m->desc->textures, value->texture,
                                                    at_least);
        return bsdf_bind(bsdf, name, rough, &object->place, err);
    }
    return mitsuba_bsdf_set_number(bsdf, name, at_least(value->value.r), object, err);
}

/* Other microfacets than ours are noted. */
static bool set_distribution(struct mitsuba *m, struct mitsuba_node *object,
                             struct bsdf *bsdf, struct err *err)
{
    const char *name = "beckmann";
    if (!mitsuba_string(object, "distribution", &name, err))
        return false;
    bool ggx = text_equal(name, "ggx");
    if (!ggx && !text_equal(name, "beckmann"))
        log_note(&m->desc->log, &object->place,
                 "distribution \"%s\" is taken as \"beckmann\"", name);
    return mitsuba_bsdf_set_number(bsdf, "distribution", ggx ? 0.0 : 1.0, object, err);
}

bool mitsuba_bsdf_roughness(struct mitsuba *m, struct mitsuba_node *object,
                            struct bsdf *bsdf, struct err *err)
{
    static const char *const ignored[] = {"sample_visible", NULL}; /* always */
    struct mitsuba_value alpha = {.value = rgb_grey(0.1)}, u, v;
    mitsuba_ignore(object, ignored);
    if (!mitsuba_value(m, object, "alpha", &alpha, err))
        return false;
    u = v = alpha;
    if (!mitsuba_value(m, object, "alpha_u", &u, err) ||
        !mitsuba_value(m, object, "alpha_v", &v, err))
        return false;
    bool both = u.texture && u.texture == v.texture;
    return (both ? pass_alpha(m, object, "alpha", &u, bsdf, err)
                 : pass_alpha(m, object, "alpha_u", &u, bsdf, err) &&
                       pass_alpha(m, object, "alpha_v", &v, bsdf, err)) &&
           set_distribution(m, object, bsdf, err);
}

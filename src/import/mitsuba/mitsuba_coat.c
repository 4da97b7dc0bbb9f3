#include "import/mitsuba/mitsuba_coat.h"

#include "base/text.h"
#include "import/mitsuba/mitsuba_bsdf.h"
#include "import/mitsuba/mitsuba_ior.h"
#include "import/mitsuba/mitsuba_texture.h"
#include "surface/fresnel.h"

/* The diffuse front of a material; NULL if there is none. */
static const struct bsdf *diffuse_front(const struct bsdf *bsdf)
{
    if (text_equal(bsdf->type->name, "sides") && bsdf->child[0] && !bsdf->child[1])
        bsdf = bsdf->child[0];
    return text_equal(bsdf->type->name, "diffuse") ? bsdf : NULL;
}

/* Unlike plastic, Mitsuba's coat has no multiple internal reflection of light from the
 * base: rho / pi in place of rho' / (1 - F_in rho'), so rho' is rho / (1 + F_in rho). */
static bool coat_diffuse(struct mitsuba *m, const struct mitsuba_node *object,
                         const struct bsdf *base, struct bsdf *coat, double eta,
                         struct err *err)
{
    const struct bsdf_param *at = bsdf_param_find(base->type, "reflectance");
    const double *rho = base->param + at->offset;
    double back = 1.0 - (1.0 - fresnel_dielectric_mean(eta)) / (eta * eta);
    if (!mitsuba_bsdf_set_number(coat, "nonlinear", 1.0, object, err))
        return false;
    if (base->bound[0].texture) {
        log_note(&m->desc->log, &object->place,
                 "the coat over a texture reflects light back to it, which Mitsuba's "
                 "does not");
        return bsdf_bind(coat, "reflectance", base->bound[0].texture, &object->place,
                         err);
    }
    return mitsuba_bsdf_set_rgb(coat, "reflectance",
                                rgb(rho[0] / (1.0 + back * rho[0]),
                                    rho[1] / (1.0 + back * rho[1]),
                                    rho[2] / (1.0 + back * rho[2])),
                                object, err);
}

static bool add_coat(struct mitsuba *m, struct mitsuba_node *object, const char *kind,
                     int under_index, int *index, struct err *err)
{
    struct bsdf bsdf;
    struct rgb absorbed = rgb_grey(0.0);
    double eta;
    mitsuba_bsdf_start(&bsdf, kind);
    if (!mitsuba_ior_ratio(object, MITSUBA_IOR_BK7, &eta, err) ||
        !mitsuba_colour(m, object, "sigma_a", &absorbed, err) ||
        !mitsuba_bsdf_set_number(&bsdf, "eta", eta, object, err) ||
        !mitsuba_bsdf_pass(m, object, "specular_reflectance", 1.0, &bsdf, "specular",
                           err) ||
        (bsdf_param_find(bsdf.type, "alpha") &&
         !mitsuba_bsdf_roughness(m, object, &bsdf, err)))
        return false;
    if (!rgb_is_black(absorbed))
        log_note(&m->desc->log, &object->place, "coats do not absorb here");
    const struct bsdf *under = under_index == MITSUBA_MATERIAL_NONE
                                   ? NULL
                                   : &m->desc->materials[under_index];
    const struct bsdf *base = under ? diffuse_front(under) : NULL;
    if (!base) {
        log_note(&m->desc->log, &object->place,
                 "a coat over what is not diffuse is left out");
        *index = under_index;
        return true;
    }
    const struct bsdf_relief relief = under->relief;
    if (!coat_diffuse(m, object, base, &bsdf, eta, err) ||
        !mitsuba_bsdf_add_opaque(m, &bsdf, object, index, err))
        return false;
    m->desc->materials[*index].relief = relief; /* of the outermost node */
    return true;
}

bool mitsuba_coat_smooth(struct mitsuba *m, struct mitsuba_node *object,
                         const struct mitsuba_parts *parts, int *index, struct err *err)
{
    return add_coat(m, object, "plastic", parts->index[0], index, err);
}

bool mitsuba_coat_rough(struct mitsuba *m, struct mitsuba_node *object,
                        const struct mitsuba_parts *parts, int *index, struct err *err)
{
    return add_coat(m, object, "roughplastic", parts->index[0], index, err);
}

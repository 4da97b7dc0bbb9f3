#include "import/mitsuba/mitsuba_principled.h"

#include "import/mitsuba/mitsuba_bsdf.h"
#include "import/mitsuba/mitsuba_property.h"

#include <math.h>

#define ETA_LEAST 1.001 /* of Etalon's principled */

/* The index that reflects this much straight on. */
static double eta_of(double reflectance)
{
    double root = sqrt(fmin(fmax(reflectance, 0.0), 0.98));
    return (1.0 + root) / (1.0 - root);
}

/* A number, where a texture has its mean. */
static bool number(struct mitsuba *m, struct mitsuba_node *object, const char *name,
                   double *value, struct err *err)
{
    struct rgb read = rgb_grey(*value);
    if (!mitsuba_colour(m, object, name, &read, err))
        return false;
    *value = read.r;
    return true;
}

/* A share between 0 and 1, or its texture, into the parameter of the same name. */
static bool pass_share(struct mitsuba *m, struct mitsuba_node *object, const char *name,
                       struct bsdf *bsdf, struct err *err)
{
    const struct bsdf_param *param = bsdf_param_find(bsdf->type, name);
    struct mitsuba_value value = {.value = rgb_grey(param->fallback[0])};
    if (!mitsuba_value(m, object, name, &value, err))
        return false;
    return value.texture ? bsdf_bind(bsdf, name, value.texture, &object->place, err)
                         : mitsuba_bsdf_set_number(bsdf, name, fmin(value.value.r, 1.0),
                                                   object, err);
}

/* eta itself, or by what is reflected straight on: .08 specular. */
static bool pass_eta(struct mitsuba *m, struct mitsuba_node *object, struct bsdf *bsdf,
                     struct err *err)
{
    double specular = 0.5, eta;
    if (!number(m, object, "specular", &specular, err))
        return false;
    eta = eta_of(0.08 * specular);
    return mitsuba_float(object, "eta", &eta, err) &&
           mitsuba_bsdf_set_number(bsdf, "eta", fmin(fmax(eta, ETA_LEAST), 20.0), object,
                                   err);
}

bool mitsuba_principled(struct mitsuba *m, struct mitsuba_node *object, int *index,
                        struct err *err)
{
    static const char *const shares[] = {
        "roughness", "anisotropic", "metallic", "spec_trans", "spec_tint",
        "sheen",     "sheen_tint",  "flatness", "clearcoat",  "clearcoat_gloss"};
    static const char *const ignored[] = {"diffuse_reflectance_sampling_rate",
                                          "main_specular_sampling_rate",
                                          "clearcoat_sampling_rate", NULL};
    struct bsdf bsdf;
    mitsuba_ignore(object, ignored);
    mitsuba_bsdf_start(&bsdf, "principled");
    for (size_t i = 0; i < sizeof shares / sizeof shares[0]; i++)
        if (!pass_share(m, object, shares[i], &bsdf, err))
            return false;
    if (!mitsuba_bsdf_pass(m, object, "base_color", 0.5, &bsdf, "base_color", err) ||
        !pass_eta(m, object, &bsdf, err) || !bsdf_prepare(&bsdf, &object->place, err))
        return false;
    return bsdf.flags & BSDF_TRANSMITS
               ? mitsuba_bsdf_add(m, &bsdf, object, index, err)
               : mitsuba_bsdf_add_opaque(m, &bsdf, object, index, err);
}

static struct mitsuba_value times(struct mitsuba *m, struct mitsuba_value value,
                                  double factor)
{
    struct texture_set *set = &m->desc->textures;
    value.value = rgb_scale(value.value, factor);
    if (value.texture)
        value.texture = texture_product(set, value.texture,
                                        texture_constant(set, rgb_grey(factor)));
    return value;
}

/* Of diff_trans, from 0 to 2, half goes through. */
bool mitsuba_principled_thin(struct mitsuba *m, struct mitsuba_node *object, int *index,
                             struct err *err)
{
    struct mitsuba_value base = {.value = rgb_grey(0.5)};
    double through = 0.0;
    struct bsdf bsdf;
    if (!mitsuba_value(m, object, "base_color", &base, err) ||
        !number(m, object, "diff_trans", &through, err))
        return false;
    through = 0.5 * fmin(fmax(through, 0.0), 2.0);
    struct mitsuba_value reflects = times(m, base, 1.0 - through);
    struct mitsuba_value transmits = times(m, base, through);
    mitsuba_bsdf_start(&bsdf, "translucent");
    return mitsuba_bsdf_set_value(&bsdf, "reflectance", &reflects, object, err) &&
           mitsuba_bsdf_set_value(&bsdf, "transmittance", &transmits, object, err) &&
           mitsuba_bsdf_add(m, &bsdf, object, index, err);
}

bool mitsuba_ward(struct mitsuba *m, struct mitsuba_node *object, int *index,
                  struct err *err)
{
    static const char *const ignored[] = {"variant", NULL};
    struct bsdf bsdf;
    double alpha[2] = {0.1, 0.1};
    mitsuba_bsdf_start(&bsdf, "substrate");
    mitsuba_ignore(object, ignored);
    if (!number(m, object, "alpha", &alpha[0], err))
        return false;
    alpha[1] = alpha[0];
    return number(m, object, "alpha_u", &alpha[0], err) &&
           number(m, object, "alpha_v", &alpha[1], err) &&
           mitsuba_bsdf_set_number(&bsdf, "alpha_u", alpha[0], object, err) &&
           mitsuba_bsdf_set_number(&bsdf, "alpha_v", alpha[1], object, err) &&
           mitsuba_bsdf_pass(m, object, "diffuse_reflectance", 0.5, &bsdf, "kd", err) &&
           mitsuba_bsdf_pass(m, object, "specular_reflectance", 0.2, &bsdf, "ks", err) &&
           mitsuba_bsdf_add_opaque(m, &bsdf, object, index, err);
}

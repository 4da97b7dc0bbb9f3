/* Polished glass; z > 0 is outside. One lobe of two, chosen by Fresnel's law (pbrt's
 * glass). */

#include "surface/bsdf_kind.h"
#include "surface/fresnel.h"

enum { ETA = 0, REFLECTANCE = 1, TRANSMITTANCE = 4 };

static const struct bsdf_param params[] = {
    {"eta", ETA, 1, {1.5}, 0.05, 20.0},
    {"reflectance", REFLECTANCE, 3, {1.0, 1.0, 1.0}, 0.0, 1.0},
    {"transmittance", TRANSMITTANCE, 3, {1.0, 1.0, 1.0}, 0.0, 1.0},
    {.name = NULL},
};

static bool prepare(struct bsdf *bsdf, const struct place *at, struct err *err)
{
    (void)at, (void)err;
    bsdf->flags = bsdf_kind_sides(bsdf, REFLECTANCE, TRANSMITTANCE);
    bsdf->flags |= bsdf->flags ? BSDF_DELTA | BSDF_U_LOBE : BSDF_BLACK;
    return true;
}

static bool sample(const struct bsdf *bsdf, struct vec3 wo, const double u[3],
                   enum transport mode, struct bsdf_sample *out)
{
    if (wo.z == 0.0f)
        return bsdf_kind_no_sample(out);
    double eta = wo.z > 0.0f ? bsdf->param[ETA] : 1.0 / bsdf->param[ETA];
    double cos_t;
    double fresnel = fresnel_dielectric(fabs((double)wo.z), eta, &cos_t);
    /* Reflection with probability F: f cos / pdf has no F [Pharr16, section 14.1.3]. */
    if (u[0] < fresnel)
        return bsdf_kind_mirror_sample(wo, bsdf_kind_rgb(bsdf, REFLECTANCE), fresnel,
                                       out);
    /* Refraction [Pharr16, section 8.2.3]. */
    return bsdf_kind_refract_sample(wo, eta, cos_t, bsdf_kind_rgb(bsdf, TRANSMITTANCE),
                                    1.0 - fresnel, mode, out);
}

static bool invert(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi, bool delta,
                   double choice, double u[3])
{
    (void)choice;
    double eta = wo.z > 0.0f ? bsdf->param[ETA] : 1.0 / bsdf->param[ETA];
    double cos_t, fresnel = fresnel_dielectric(fabs((double)wo.z), eta, &cos_t);
    if (!delta)
        return false;
    if (bsdf_kind_is_mirror(wo, wi))
        return bsdf_kind_invert_lobe(0.0, fresnel, u);
    return bsdf_kind_is_refraction(wo, wi, eta, cos_t) &&
           bsdf_kind_invert_lobe(fresnel, 1.0, u);
}

const struct bsdf_type bsdf_type_dielectric = {
    .name = "dielectric",
    .params = params,
    .places = 7,
    .prepare = prepare,
    .eval = bsdf_kind_eval_nothing,
    .sample = sample,
    .invert = invert,
};

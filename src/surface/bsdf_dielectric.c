/* Polished glass; z > 0 is outside. One lobe of two, chosen by Fresnel's law (pbrt's
 * glass). */

#include "surface/bsdf_kind.h"
#include "surface/direction.h"
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
    bool reflects = !rgb_is_black(bsdf_kind_rgb(bsdf, REFLECTANCE));
    bool transmits = !rgb_is_black(bsdf_kind_rgb(bsdf, TRANSMITTANCE));
    bsdf->flags = (reflects ? BSDF_REFLECTS : 0u) | (transmits ? BSDF_TRANSMITS : 0u);
    bsdf->flags |= bsdf->flags ? BSDF_DELTA | BSDF_U_LOBE : BSDF_BLACK;
    return true;
}

/* eta: index beyond over index on wo's side. */
static bool refract(const struct bsdf *bsdf, struct vec3 wo, double eta, double cos_t,
                    double probability, enum transport mode, struct bsdf_sample *out)
{
    struct rgb weight = bsdf_kind_rgb(bsdf, TRANSMITTANCE);
    struct direction o = direction_from(wo);
    struct direction i = {-o.x / eta, -o.y / eta, copysign(cos_t, -o.z)};
    struct vec3 wi = direction_to_vec3(i);
    if (wi.z == 0.0f || rgb_is_black(weight))
        return bsdf_kind_no_sample(out);
    /* Radiance is squeezed into a smaller or larger cone [Veach97, section 5.2]. */
    if (mode == TRANSPORT_RADIANCE)
        weight = rgb_scale(weight, 1.0 / (eta * eta));
    double jacobian = fabs(o.z) / (cos_t * eta * eta);
    *out = (struct bsdf_sample){.wi = wi,
                                .weight = weight,
                                .pdf = probability,
                                .pdf_rev = probability * jacobian,
                                .delta = true,
                                .transmission = true};
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
    if (u[0] < fresnel)
        return bsdf_kind_mirror_sample(wo, bsdf_kind_rgb(bsdf, REFLECTANCE), fresnel,
                                       out);
    return refract(bsdf, wo, eta, cos_t, 1.0 - fresnel, mode, out);
}

const struct bsdf_type bsdf_type_dielectric = {
    .name = "dielectric",
    .params = params,
    .prepare = prepare,
    .eval = bsdf_kind_eval_nothing,
    .sample = sample,
};

/* A pane of glass without thickness: all that its two faces reflect into each other is
 * summed, R' = R + T^2 R / (1 - R^2) = 2R / (1 + R), and light goes straight on. */

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
    double cosine = fabs((double)wo.z), cos_t;
    if (wo.z == 0.0f)
        return bsdf_kind_no_sample(out);
    double face = fresnel_dielectric(cosine, bsdf->param[ETA], &cos_t);
    /* R' [Jakob10, section 8.2, thindielectric]. */
    double reflected = 2.0 * face / (1.0 + face);
    if (u[0] < reflected)
        return bsdf_kind_mirror_sample(wo, bsdf_kind_rgb(bsdf, REFLECTANCE), reflected,
                                       out);
    return bsdf_kind_refract_sample(wo, 1.0, cosine, bsdf_kind_rgb(bsdf, TRANSMITTANCE),
                                    1.0 - reflected, mode, out);
}

const struct bsdf_type bsdf_type_thindielectric = {
    .name = "thindielectric",
    .params = params,
    .prepare = prepare,
    .eval = bsdf_kind_eval_nothing,
    .sample = sample,
};

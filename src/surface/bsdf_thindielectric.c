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
    if (bsdf->flags & BSDF_TRANSMITS)
        bsdf->flags |= BSDF_STRAIGHT;
    if (bsdf->flags == (BSDF_TRANSMITS | BSDF_STRAIGHT))
        bsdf->flags |= BSDF_ONLY_STRAIGHT;
    bsdf->flags |= bsdf->flags ? BSDF_DELTA | BSDF_U_LOBE : BSDF_BLACK;
    return true;
}

/* R' [Jakob10, section 8.2, thindielectric]. */
static double reflected(const struct bsdf *bsdf, struct vec3 wo)
{
    double cos_t;
    double face = fresnel_dielectric(fabs((double)wo.z), bsdf->param[ETA], &cos_t);
    return 2.0 * face / (1.0 + face);
}

static bool straight(const struct bsdf *bsdf, struct vec3 wo, struct bsdf_straight *out)
{
    double passes = 1.0 - reflected(bsdf, wo);
    *out = (struct bsdf_straight){rgb_scale(bsdf_kind_rgb(bsdf, TRANSMITTANCE), passes),
                                  passes};
    return passes > 0.0;
}

static bool sample(const struct bsdf *bsdf, struct vec3 wo, const double u[3],
                   enum transport mode, struct bsdf_sample *out)
{
    (void)mode;
    if (wo.z == 0.0f)
        return bsdf_kind_no_sample(out);
    struct bsdf_straight s;
    bool passes = bsdf_straight(bsdf, wo, &s);
    double mirror = reflected(bsdf, wo);
    if (u[0] >= 1.0 - mirror)
        return bsdf_kind_mirror_sample(wo, bsdf_kind_rgb(bsdf, REFLECTANCE), mirror, out);
    return passes ? bsdf_kind_straight_sample(wo, &s, out) : bsdf_kind_no_sample(out);
}

static bool invert(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi, bool delta,
                   double choice, double u[3])
{
    (void)choice;
    double mirror = reflected(bsdf, wo);
    if (!delta)
        return false;
    if (bsdf_kind_is_mirror(wo, wi))
        return bsdf_kind_invert_lobe(1.0 - mirror, 1.0, u);
    return bsdf_kind_same(wi, vec3_neg(wo)) &&
           bsdf_kind_invert_lobe(0.0, 1.0 - mirror, u);
}

const struct bsdf_type bsdf_type_thindielectric = {
    .name = "thindielectric",
    .params = params,
    .places = 7,
    .prepare = prepare,
    .eval = bsdf_kind_eval_nothing,
    .sample = sample,
    .invert = invert,
    .straight = straight,
};

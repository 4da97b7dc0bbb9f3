/* Diffuse reflection and diffuse transmission, f = rho / pi on the side of wo and tau /
 * pi on the other; the same from both sides (pbrt v4's diffusetransmission, Mitsuba's
 * difftrans) [Pharr23, section 9.3]. */

#include "math/warp.h"
#include "surface/bsdf_kind.h"

enum { REFLECTANCE = 0, TRANSMITTANCE = 3, CHANCE = 6 /* of transmission */ };

#define INV_PI (1.0 / MATH_PI)

static const struct bsdf_param params[] = {
    {"reflectance", REFLECTANCE, 3, {0.25, 0.25, 0.25}, 0.0, 1.0},
    {"transmittance", TRANSMITTANCE, 3, {0.25, 0.25, 0.25}, 0.0, 1.0},
    {.name = NULL},
};

static bool prepare(struct bsdf *bsdf, const struct place *at, struct err *err)
{
    (void)at, (void)err;
    double reflects = rgb_luminance(bsdf_kind_rgb(bsdf, REFLECTANCE));
    double transmits = rgb_luminance(bsdf_kind_rgb(bsdf, TRANSMITTANCE));
    bsdf->flags = BSDF_BLACK;
    if (reflects + transmits == 0.0)
        return true;
    bsdf->param[CHANCE] = transmits / (reflects + transmits);
    bsdf->flags = bsdf_kind_sides(bsdf, REFLECTANCE, TRANSMITTANCE) | BSDF_U_DIRECTION;
    if (reflects > 0.0 && transmits > 0.0)
        bsdf->flags |= BSDF_U_LOBE;
    return true;
}

static bool eval(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                 enum transport mode, struct bsdf_value *out)
{
    (void)mode;
    /* In double: the product of two floats cannot underflow. */
    double cos_o = (double)wo.z, cos_i = (double)wi.z;
    bool through = cos_o * cos_i < 0.0;
    if (cos_o * cos_i == 0.0 || bsdf->flags & BSDF_BLACK)
        return bsdf_kind_no_value(out);
    double chance = through ? bsdf->param[CHANCE] : 1.0 - bsdf->param[CHANCE];
    struct rgb colour = bsdf_kind_rgb(bsdf, through ? TRANSMITTANCE : REFLECTANCE);
    if (chance == 0.0)
        return bsdf_kind_no_value(out);
    /* Lambert's law on each side; the density is that of the cosine on the chosen side
     * [Pharr16, sections 8.3 and 13.6.3]. */
    *out = (struct bsdf_value){rgb_scale(colour, INV_PI), chance * fabs(cos_i) * INV_PI,
                               chance * fabs(cos_o) * INV_PI};
    return true;
}

static bool sample(const struct bsdf *bsdf, struct vec3 wo, const double u[3],
                   enum transport mode, struct bsdf_sample *out)
{
    (void)mode;
    struct vec3 wi = warp_cosine(u + 1);
    if (wo.z == 0.0f || wi.z <= 0.0f || bsdf->flags & BSDF_BLACK)
        return bsdf_kind_no_sample(out);
    double transmits = bsdf->param[CHANCE];
    bool through = bsdf->flags & BSDF_U_LOBE ? u[0] >= 1.0 - transmits : transmits == 1.0;
    double chance = through ? transmits : 1.0 - transmits, cos_i = (double)wi.z;
    struct rgb colour = bsdf_kind_rgb(bsdf, through ? TRANSMITTANCE : REFLECTANCE);
    wi.z = copysignf(wi.z, through ? -wo.z : wo.z);
    /* f cos / pdf [Pharr16, section 8.3] */
    *out = (struct bsdf_sample){.wi = wi,
                                .weight = rgb_scale(colour, 1.0 / chance),
                                .pdf = chance * cos_i * INV_PI,
                                .pdf_rev = chance * fabs((double)wo.z) * INV_PI,
                                .transmission = through};
    return true;
}

static bool invert(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi, bool delta,
                   double choice, double u[3])
{
    (void)choice;
    double reflects = 1.0 - bsdf->param[CHANCE];
    bool through = wo.z * wi.z < 0.0f;
    if (delta || wo.z * wi.z == 0.0f)
        return false;
    return bsdf_kind_invert_lobe(through ? reflects : 0.0, through ? 1.0 : reflects, u) &&
           bsdf_kind_invert_cosine(wi, u);
}

const struct bsdf_type bsdf_type_translucent = {
    .name = "translucent",
    .params = params,
    .places = 7,
    .prepare = prepare,
    .eval = eval,
    .sample = sample,
    .invert = invert,
};

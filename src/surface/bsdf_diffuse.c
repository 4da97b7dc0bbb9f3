/* Lambert's law, f = rho / pi, on both sides (pbrt's matte without roughness)
 * [Pharr16, section 8.3]. */

#include "math/warp.h"
#include "surface/bsdf_kind.h"

enum { REFLECTANCE = 0, REFLECTANCE_OVER_PI = 3 };

#define INV_PI (1.0 / MATH_PI)

static const struct bsdf_param params[] = {
    {"reflectance", REFLECTANCE, 3, {0.5, 0.5, 0.5}, 0.0, 1.0},
    {.name = NULL},
};

static bool prepare(struct bsdf *bsdf, const struct place *at, struct err *err)
{
    (void)at, (void)err;
    for (int i = 0; i < 3; i++)
        bsdf->param[REFLECTANCE_OVER_PI + i] = bsdf->param[REFLECTANCE + i] * INV_PI;
    bool black = rgb_is_black(bsdf_kind_rgb(bsdf, REFLECTANCE));
    bsdf->flags = black ? BSDF_BLACK : BSDF_REFLECTS | BSDF_U_DIRECTION;
    return true;
}

static bool eval(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                 enum transport mode, struct bsdf_value *out)
{
    (void)mode;
    /* In double: the product of two floats cannot underflow. */
    double cos_o = (double)wo.z, cos_i = (double)wi.z;
    if (!(cos_o * cos_i > 0.0) || bsdf->flags & BSDF_BLACK)
        return bsdf_kind_no_value(out);
    /* f = rho / pi [Pharr16, section 8.3], density cos / pi [Pharr16, section 13.6.3]. */
    *out = (struct bsdf_value){bsdf_kind_rgb(bsdf, REFLECTANCE_OVER_PI),
                               fabs(cos_i) * INV_PI, fabs(cos_o) * INV_PI};
    return true;
}

static bool sample(const struct bsdf *bsdf, struct vec3 wo, const double u[3],
                   enum transport mode, struct bsdf_sample *out)
{
    (void)mode;
    struct vec3 wi = warp_cosine(u + 1);
    if (wo.z == 0.0f || wi.z <= 0.0f || bsdf->flags & BSDF_BLACK)
        return bsdf_kind_no_sample(out);
    double cos_i = (double)wi.z;
    wi.z = copysignf(wi.z, wo.z);
    /* f cos / pdf = rho [Pharr16, section 8.3]. */
    *out = (struct bsdf_sample){.wi = wi,
                                .weight = bsdf_kind_rgb(bsdf, REFLECTANCE),
                                .pdf = cos_i * INV_PI,
                                .pdf_rev = fabs((double)wo.z) * INV_PI};
    return true;
}

static bool invert(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi, bool delta,
                   double choice, double u[3])
{
    (void)bsdf, (void)choice;
    return !delta && wo.z * wi.z > 0.0f && bsdf_kind_invert_cosine(wi, u);
}

const struct bsdf_type bsdf_type_diffuse = {
    .name = "diffuse",
    .params = params,
    .places = 6,
    .prepare = prepare,
    .eval = eval,
    .sample = sample,
    .invert = invert,
};

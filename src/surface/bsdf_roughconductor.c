/* Rough metal [Walter07 Eq. 20] with a complex index; both sides. Default: copper. */

#include "surface/bsdf_kind.h"
#include "surface/fresnel.h"

enum { ETA = 0, K = 3, REFLECTANCE = 6, ALPHA = 9, DISTRIBUTION = 12, DERIVED = 13 };

static const struct bsdf_param params[] = {
    {"eta", ETA, 3, {0.200438, 0.924033, 1.102212}, 0.0, 100.0},
    {"k", K, 3, {3.912949, 2.452848, 2.142188}, 0.0, 100.0},
    {"reflectance", REFLECTANCE, 3, {1.0, 1.0, 1.0}, 0.0, 1.0},
    BSDF_KIND_ALPHA_ROWS(ALPHA, MICROFACET_ALPHA_MIN),
    BSDF_KIND_DISTRIBUTION_ROW(DISTRIBUTION),
    {.name = NULL},
};

static bool prepare(struct bsdf *bsdf, const struct place *at, struct err *err)
{
    bool black = rgb_is_black(bsdf_kind_rgb(bsdf, REFLECTANCE));
    bsdf->flags = black ? BSDF_BLACK : BSDF_REFLECTS | BSDF_U_DIRECTION;
    return bsdf_kind_prepare_microfacet(bsdf, ALPHA, DISTRIBUTION, DERIVED, at, err);
}

/* Fresnel's factor for light that meets facets at cos_h, and the file's own. */
static struct rgb tint(const struct bsdf *bsdf, double cos_h)
{
    return rgb_mul(
        fresnel_conductor(cos_h, bsdf_kind_rgb(bsdf, ETA), bsdf_kind_rgb(bsdf, K)),
        bsdf_kind_rgb(bsdf, REFLECTANCE));
}

static bool eval(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                 enum transport mode, struct bsdf_value *out)
{
    (void)mode;
    if (!((double)wo.z * (double)wi.z > 0.0) || bsdf->flags & BSDF_BLACK)
        return bsdf_kind_no_value(out);
    struct microfacet mf = bsdf_kind_microfacet(bsdf, DERIVED);
    struct direction o = direction_from(wo), i = direction_from(wi);
    if (o.z < 0.0) {
        o = direction_flip(o);
        i = direction_flip(i);
    }
    struct direction h = direction_mad(o, 1.0, i);
    double length = sqrt(direction_dot(h, h));
    double d = microfacet_d(&mf, direction_scale(h, 1.0 / length));
    double area_o = microfacet_area(&mf, o), area_i = microfacet_area(&mf, i);
    /* D G2 / (4 cos cos) [Walter07 Eq. 20], G2 by [Heitz14 Eq. 99]. */
    double f = 0.25 * d / microfacet_cosines_over_g2(o.z, area_o, i.z, area_i);
    /* |o + i| = 2 cos_h */
    *out = (struct bsdf_value){rgb_scale(tint(bsdf, fmin(1.0, 0.5 * length)), f),
                               0.25 * d / area_o, 0.25 * d / area_i};
    return rgb_is_black(out->f) ? bsdf_kind_no_value(out) : true;
}

static bool sample(const struct bsdf *bsdf, struct vec3 wo, const double u[3],
                   enum transport mode, struct bsdf_sample *out)
{
    (void)mode;
    if (wo.z == 0.0f || bsdf->flags & BSDF_BLACK)
        return bsdf_kind_no_sample(out);
    struct microfacet mf = bsdf_kind_microfacet(bsdf, DERIVED);
    struct direction o = direction_from(wo);
    o.z = fabs(o.z);
    struct direction h = microfacet_sample(&mf, o, u + 1);
    double cos_h = direction_dot(o, h);
    struct direction i = direction_mad(direction_scale(o, -1.0), 2.0 * cos_h,
                                       h); /* [Walter07 Eq. 39] */
    struct vec3 wi = direction_to_vec3(i);
    if (cos_h <= 0.0 || wi.z <= 0.0f)
        return bsdf_kind_no_sample(out);
    wi.z = copysignf(wi.z, wo.z);
    double d = microfacet_d(&mf, h);
    double area_o = microfacet_area(&mf, o), area_i = microfacet_area(&mf, i);
    /* f cos / p with p = D_visible / (4 cos_h) [Walter07 Eqs. 14, 38 and 41]: G2 / G1. */
    double weight = i.z * area_o / microfacet_cosines_over_g2(o.z, area_o, i.z, area_i);
    *out = (struct bsdf_sample){.wi = wi,
                                .weight = rgb_scale(tint(bsdf, fmin(1.0, cos_h)), weight),
                                .pdf = 0.25 * d / area_o,
                                .pdf_rev = 0.25 * d / area_i};
    return rgb_is_black(out->weight) || !(out->pdf > 0.0) ? bsdf_kind_no_sample(out)
                                                          : true;
}

static bool invert(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi, bool delta,
                   double choice, double u[3])
{
    (void)choice;
    struct microfacet mf = bsdf_kind_microfacet(bsdf, DERIVED);
    return !delta && wo.z * wi.z > 0.0f && bsdf_kind_invert_facet(&mf, wo, wi, u);
}

const struct bsdf_type bsdf_type_roughconductor = {
    .name = "roughconductor",
    .params = params,
    .places = 16,
    .prepare = prepare,
    .eval = eval,
    .sample = sample,
    .invert = invert,
};

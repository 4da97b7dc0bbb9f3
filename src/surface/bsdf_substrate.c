/* A glossy coat over a diffuse base [Ashikhmin00] as pbrt v3's substrate means it
 * (FresnelBlend); both sides. Half of the samples follow the cosine, half the visible
 * normals of the coat (GGX). */

#include "math/warp.h"
#include "surface/bsdf_kind.h"
#include "surface/fresnel.h"

enum { KD = 0, KS = 3, ALPHA = 6, DERIVED = 9, DIFFUSE = 11 };

#define INV_PI (1.0 / MATH_PI)
/* Least roughness of the coat, as in pbrt v3. */
#define ALPHA_LEAST 1e-3

static const struct bsdf_param params[] = {
    {"kd", KD, 3, {0.5, 0.5, 0.5}, 0.0, 1.0},
    {"ks", KS, 3, {0.5, 0.5, 0.5}, 0.0, 1.0},
    BSDF_KIND_ALPHA_ROWS(ALPHA, 0.0),
    {.name = NULL},
};

static bool prepare(struct bsdf *bsdf, const struct place *at, struct err *err)
{
    (void)at, (void)err;
    struct microfacet mf = bsdf_kind_roughness(bsdf->param + ALPHA);
    bsdf->param[DERIVED] = fmax(mf.alpha_u, ALPHA_LEAST);
    bsdf->param[DERIVED + 1] = fmax(mf.alpha_v, ALPHA_LEAST);
    for (int i = 0; i < 3; i++)
        /* [Ashikhmin00 Eq. 5] */
        bsdf->param[DIFFUSE + i] = 28.0 / (23.0 * MATH_PI) * bsdf->param[KD + i] *
                                   (1.0 - bsdf->param[KS + i]);
    bsdf->flags = BSDF_REFLECTS | BSDF_U_LOBE | BSDF_U_DIRECTION;
    if (bsdf->param[DERIVED] != bsdf->param[DERIVED + 1])
        bsdf->flags |= BSDF_ANISOTROPIC;
    return true;
}

static struct microfacet coat(const struct bsdf *bsdf)
{
    return (struct microfacet){bsdf->param[DERIVED], bsdf->param[DERIVED + 1],
                               MICROFACET_GGX};
}

/* 1 - (1 - cos/2)^5 of the diffuse term [Ashikhmin00 Eq. 5]. */
static double let_in(double cosine)
{
    double m = 1.0 - 0.5 * cosine, m2 = m * m;
    return 1.0 - m2 * m2 * m;
}

/* Both directions above. */
static void eval_above(const struct bsdf *bsdf, const struct microfacet *mf,
                       struct direction o, struct direction i, struct bsdf_value *out)
{
    struct direction h = direction_mad(o, 1.0, i);
    double length = sqrt(direction_dot(h, h)), cos_h = fmin(1.0, 0.5 * length);
    double d = microfacet_d(mf, direction_scale(h, 1.0 / length));
    struct rgb diffuse = rgb_scale(bsdf_kind_rgb(bsdf, DIFFUSE),
                                   let_in(o.z) * let_in(i.z));
    /* [Pharr16, section 8.5]: D F / (4 cos_h max(cos, cos)). */
    struct rgb glossy = rgb_scale(fresnel_schlick(cos_h, bsdf_kind_rgb(bsdf, KS)),
                                  d / (4.0 * cos_h * fmax(o.z, i.z)));
    out->f = rgb_add(diffuse, glossy);
    /* Half cosine, half visible normals [Pharr16, section 14.1.2]. */
    out->pdf = 0.5 * (i.z * INV_PI + 0.25 * d / microfacet_area(mf, o));
    out->pdf_rev = 0.5 * (o.z * INV_PI + 0.25 * d / microfacet_area(mf, i));
}

static bool eval(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                 enum transport mode, struct bsdf_value *out)
{
    (void)mode;
    if (!((double)wo.z * (double)wi.z > 0.0))
        return bsdf_kind_no_value(out);
    struct microfacet mf = coat(bsdf);
    struct direction o = direction_from(wo), i = direction_from(wi);
    o.z = fabs(o.z);
    i.z = fabs(i.z);
    eval_above(bsdf, &mf, o, i, out);
    return true;
}

static bool sample(const struct bsdf *bsdf, struct vec3 wo, const double u[3],
                   enum transport mode, struct bsdf_sample *out)
{
    (void)mode;
    if (wo.z == 0.0f)
        return bsdf_kind_no_sample(out);
    struct microfacet mf = coat(bsdf);
    struct direction o = direction_from(wo);
    o.z = fabs(o.z);
    struct vec3 wi;
    if (u[0] < 0.5) {
        wi = warp_cosine(u + 1);
    } else {
        struct direction h = microfacet_sample(&mf, o, u + 1);
        wi = direction_to_vec3(direction_reflect(o, h));
    }
    if (wi.z <= 0.0f)
        return bsdf_kind_no_sample(out);
    struct direction i = direction_from(wi);
    struct bsdf_value value;
    eval_above(bsdf, &mf, o, i, &value);
    wi.z = copysignf(wi.z, wo.z);
    *out = (struct bsdf_sample){.wi = wi,
                                .weight = rgb_scale(value.f, i.z / value.pdf),
                                .pdf = value.pdf,
                                .pdf_rev = value.pdf_rev};
    return true;
}

/* One of the two lobes by its share of the density at wi. */
static bool invert(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi, bool delta,
                   double choice, double u[3])
{
    struct microfacet mf = coat(bsdf);
    struct bsdf_value v;
    int glossy;
    if (delta || !eval(bsdf, wo, wi, TRANSPORT_RADIANCE, &v))
        return false;
    double diffuse = 0.5 * INV_PI * fabs((double)wi.z);
    const double share[2] = {diffuse, fmax(0.0, v.pdf - diffuse)};
    if (!bsdf_kind_choose(share, &choice, &glossy))
        return false;
    return glossy ? bsdf_kind_invert_lobe(0.5, 1.0, u) &&
                        bsdf_kind_invert_facet(&mf, wo, wi, u)
                  : bsdf_kind_invert_lobe(0.0, 0.5, u) && bsdf_kind_invert_cosine(wi, u);
}

const struct bsdf_type bsdf_type_substrate = {
    .name = "substrate",
    .params = params,
    .places = 14,
    .prepare = prepare,
    .eval = eval,
    .sample = sample,
    .invert = invert,
};

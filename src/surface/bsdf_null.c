/* Nothing there: light goes straight on. The other half of masks. */

#include "surface/bsdf_kind.h"

enum { TRANSMITTANCE = 0 };

static const struct bsdf_param params[] = {
    {"transmittance", TRANSMITTANCE, 3, {1.0, 1.0, 1.0}, 0.0, 1.0},
    {.name = NULL},
};

static bool prepare(struct bsdf *bsdf, const struct place *at, struct err *err)
{
    (void)at, (void)err;
    bool black = rgb_is_black(bsdf_kind_rgb(bsdf, TRANSMITTANCE));
    bsdf->flags = black
                      ? BSDF_BLACK
                      : BSDF_DELTA | BSDF_TRANSMITS | BSDF_STRAIGHT | BSDF_ONLY_STRAIGHT;
    return true;
}

static bool straight(const struct bsdf *bsdf, struct vec3 wo, struct bsdf_straight *out)
{
    (void)wo;
    *out = (struct bsdf_straight){bsdf_kind_rgb(bsdf, TRANSMITTANCE), 1.0};
    return true;
}

static bool sample(const struct bsdf *bsdf, struct vec3 wo, const double u[3],
                   enum transport mode, struct bsdf_sample *out)
{
    (void)u, (void)mode;
    struct bsdf_straight s;
    if (!bsdf_straight(bsdf, wo, &s) || wo.z == 0.0f)
        return bsdf_kind_no_sample(out);
    return bsdf_kind_straight_sample(wo, &s, out);
}

static bool invert(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi, bool delta,
                   double choice, double u[3])
{
    (void)bsdf, (void)choice, (void)u;
    return delta && bsdf_kind_same(wi, vec3_neg(wo));
}

const struct bsdf_type bsdf_type_null = {
    .name = "null",
    .params = params,
    .places = 3,
    .prepare = prepare,
    .eval = bsdf_kind_eval_nothing,
    .sample = sample,
    .invert = invert,
    .straight = straight,
};

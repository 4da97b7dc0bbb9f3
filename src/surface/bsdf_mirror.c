/* A perfect mirror of both sides, without Fresnel's law (pbrt's mirror). */

#include "surface/bsdf_kind.h"

enum { REFLECTANCE = 0 };

static const struct bsdf_param params[] = {
    {"reflectance", REFLECTANCE, 3, {0.9, 0.9, 0.9}, 0.0, 1.0},
    {.name = NULL},
};

static bool prepare(struct bsdf *bsdf, const struct place *at, struct err *err)
{
    (void)at, (void)err;
    bool black = rgb_is_black(bsdf_kind_rgb(bsdf, REFLECTANCE));
    bsdf->flags = black ? BSDF_BLACK : BSDF_DELTA | BSDF_REFLECTS;
    return true;
}

static bool sample(const struct bsdf *bsdf, struct vec3 wo, const double u[3],
                   enum transport mode, struct bsdf_sample *out)
{
    (void)u, (void)mode;
    /* [Pharr16, section 8.2.2], without Fresnel's factor. */
    return bsdf_kind_mirror_sample(wo, bsdf_kind_rgb(bsdf, REFLECTANCE), 1.0, out);
}

const struct bsdf_type bsdf_type_mirror = {
    .name = "mirror",
    .params = params,
    .places = 3,
    .prepare = prepare,
    .eval = bsdf_kind_eval_nothing,
    .sample = sample,
    .invert = bsdf_kind_invert_mirror,
};

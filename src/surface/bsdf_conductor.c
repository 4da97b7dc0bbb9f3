/* Polished metal; both sides. The default is copper. */

#include "surface/bsdf_kind.h"
#include "surface/fresnel.h"

enum { ETA = 0, K = 3, REFLECTANCE = 6 };

static const struct bsdf_param params[] = {
    {"eta", ETA, 3, {0.200438, 0.924033, 1.102212}, 0.0, 100.0},
    {"k", K, 3, {3.912949, 2.452848, 2.142188}, 0.0, 100.0},
    {"reflectance", REFLECTANCE, 3, {1.0, 1.0, 1.0}, 0.0, 1.0},
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
    struct rgb fresnel = fresnel_conductor(fabs((double)wo.z), bsdf_kind_rgb(bsdf, ETA),
                                           bsdf_kind_rgb(bsdf, K));
    /* f cos / pdf = F [Pharr16, section 8.2.2]. */
    struct rgb weight = rgb_mul(fresnel, bsdf_kind_rgb(bsdf, REFLECTANCE));
    return bsdf_kind_mirror_sample(wo, weight, 1.0, out);
}

const struct bsdf_type bsdf_type_conductor = {
    .name = "conductor",
    .params = params,
    .places = 9,
    .prepare = prepare,
    .eval = bsdf_kind_eval_nothing,
    .sample = sample,
    .invert = bsdf_kind_invert_mirror,
};

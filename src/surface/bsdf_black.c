/* Scatters nothing: the surface of lamps and of light traps. */

#include "surface/bsdf_kind.h"

static const struct bsdf_param params[] = {{.name = NULL}};

static bool prepare(struct bsdf *bsdf, const struct place *at, struct err *err)
{
    (void)at, (void)err;
    bsdf->flags = BSDF_BLACK;
    return true;
}

static bool sample(const struct bsdf *bsdf, struct vec3 wo, const double u[3],
                   enum transport mode, struct bsdf_sample *out)
{
    (void)bsdf, (void)wo, (void)u, (void)mode;
    return bsdf_kind_no_sample(out);
}

const struct bsdf bsdf_nothing = {.type = &bsdf_type_black, .flags = BSDF_BLACK};

const struct bsdf_type bsdf_type_black = {
    .name = "black",
    .params = params,
    .prepare = prepare,
    .eval = bsdf_kind_eval_nothing,
    .sample = sample,
    .invert = bsdf_kind_invert_nothing,
};

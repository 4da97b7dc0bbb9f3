#include "import/pbrt/pbrt_bsdf.h"

#include <math.h>

/* pbrt v3's smallest alpha of its microfacet distributions. */
#define ALPHA_MIN 1e-3

const struct rgb pbrt_bsdf_copper_eta = {0.2004376970, 0.9240334304, 1.1022119527};
const struct rgb pbrt_bsdf_copper_k = {3.9129485033, 2.4528477015, 2.1421879552};

bool pbrt_bsdf_start(struct bsdf *bsdf, const char *kind, const struct place *at,
                     struct err *err)
{
    const struct bsdf_type *type = bsdf_find(kind);
    if (!type)
        return err_set(err, ERR_UNSUPPORTED, at, "no BSDF of the kind %s", kind);
    bsdf_init(bsdf, type);
    return true;
}

bool pbrt_bsdf_set_rgb(struct bsdf *bsdf, const char *name, struct rgb value,
                       const struct place *at, struct err *err)
{
    return bsdf_set(bsdf, name, &value.r, 3, at, err);
}

bool pbrt_bsdf_set_value(struct bsdf *bsdf, const char *name,
                         const struct pbrt_value *value, const struct place *at,
                         struct err *err)
{
    return value->texture ? bsdf_bind(bsdf, name, value->texture, at, err)
                          : pbrt_bsdf_set_rgb(bsdf, name, value->value, at, err);
}

bool pbrt_bsdf_pass(struct pbrt *p, const char *name, double fallback, struct bsdf *bsdf,
                    const char *to, const struct place *at, struct err *err)
{
    struct pbrt_value value = {.value = rgb_grey(fallback)};
    return pbrt_colour_value(p, name, &value, err) &&
           pbrt_bsdf_set_value(bsdf, to, &value, at, err);
}

bool pbrt_bsdf_set_roughness(struct bsdf *bsdf, const struct pbrt_roughness *r,
                             const struct place *at, struct err *err)
{
    return bsdf_set(bsdf, "alpha_u", &r->alpha_u, 1, at, err) &&
           bsdf_set(bsdf, "alpha_v", &r->alpha_v, 1, at, err);
}

bool pbrt_bsdf_eta(struct pbrt *p, double *eta, struct err *err)
{
    bool has_eta;
    return pbrt_colour_float(p, "eta", eta, &has_eta, err) &&
           (has_eta || pbrt_colour_float(p, "index", eta, NULL, err));
}

bool pbrt_bsdf_roughness(struct pbrt *p, const char *both, double fallback,
                         double (*to_alpha)(double roughness), struct pbrt_roughness *out,
                         struct err *err)
{
    bool remap = !p->lux;
    double value = fallback;
    if (both && !pbrt_colour_float(p, both, &value, NULL, err))
        return false;
    out->u = out->v = value;
    if (!pbrt_colour_float(p, "uroughness", &out->u, NULL, err) ||
        !pbrt_colour_float(p, "vroughness", &out->v, NULL, err) ||
        !pbrt_params_bool(&p->params, "remaproughness", &remap, err))
        return false;
    out->alpha_u = fmax(remap ? to_alpha(out->u) : out->u, ALPHA_MIN);
    out->alpha_v = fmax(remap ? to_alpha(out->v) : out->v, ALPHA_MIN);
    return true;
}

#include "import/pbrt/pbrt_bsdf.h"

#include "import/spectrum.h"
#include "import/spectrum_named.h"

#include <math.h>
#include <stdio.h>

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

bool pbrt_bsdf_set_number(struct bsdf *bsdf, const char *name,
                          const struct pbrt_value *value, const struct place *at,
                          struct err *err)
{
    return value->texture ? bsdf_bind(bsdf, name, value->texture, at, err)
                          : bsdf_set(bsdf, name, &value->value.g, 1, at, err);
}

struct pbrt_value pbrt_bsdf_scaled(struct pbrt *p, const struct pbrt_value *value,
                                   double factor)
{
    const struct pbrt_value by = {.value = rgb_grey(factor)};
    return factor == 1.0 ? *value : pbrt_bsdf_product(p, value, &by);
}

struct pbrt_value pbrt_bsdf_product(struct pbrt *p, const struct pbrt_value *a,
                                    const struct pbrt_value *b)
{
    struct pbrt_value out = {.value = rgb_mul(a->value, b->value)};
    if (a->texture || b->texture)
        out.texture = texture_product(&p->desc->textures, pbrt_colour_node(p, a),
                                      pbrt_colour_node(p, b));
    return out;
}

struct pbrt_value pbrt_bsdf_complement(struct pbrt *p, const struct pbrt_value *value)
{
    struct texture_set *set = &p->desc->textures;
    struct rgb v = value->value;
    struct pbrt_value out = {.value = rgb(1.0 - v.r, 1.0 - v.g, 1.0 - v.b)};
    if (value->texture)
        out.texture = texture_mix(set, texture_constant(set, rgb_grey(1.0)),
                                  texture_constant(set, rgb_grey(0.0)), value->texture);
    return out;
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
    if (r->texture_u && r->texture_u == r->texture_v)
        return bsdf_bind(bsdf, "alpha", r->texture_u, at, err);
    return (r->texture_u ? bsdf_bind(bsdf, "alpha_u", r->texture_u, at, err)
                         : bsdf_set(bsdf, "alpha_u", &r->alpha_u, 1, at, err)) &&
           (r->texture_v ? bsdf_bind(bsdf, "alpha_v", r->texture_v, at, err)
                         : bsdf_set(bsdf, "alpha_v", &r->alpha_v, 1, at, err));
}

/* Of an index that varies with the wavelength the value where the eye sees best. */
static bool spectral_eta(struct pbrt *p, const struct pbrt_param *param, const char *name,
                         double *eta, struct err *err)
{
    struct rgb value = rgb_grey(*eta);
    if (!pbrt_colour(p, name, &value, err))
        return false;
    *eta = rgb_luminance(value);
    if (fabs(value.r - value.b) > 1e-6)
        log_note(&p->desc->log, &param->place,
                 "dispersion is left out: the index of a spectrum is its mean by "
                 "luminance");
    return true;
}

bool pbrt_bsdf_named_eta(struct pbrt *p, const char *name, double *eta, struct err *err)
{
    const struct pbrt_param *spectrum = pbrt_params_find(&p->params, name, PBRT_COLOUR);
    return spectrum ? spectral_eta(p, spectrum, name, eta, err)
                    : pbrt_colour_float(p, name, eta, NULL, err);
}

bool pbrt_bsdf_eta(struct pbrt *p, double *eta, struct err *err)
{
    bool has_eta = pbrt_params_find(&p->params, "eta",
                                    PBRT_COLOUR | PBRT_FLOAT | PBRT_TEXTURE);
    return pbrt_bsdf_named_eta(p, has_eta ? "eta" : "index", eta, err);
}

bool pbrt_bsdf_named_metal(const char *metal, struct rgb *eta, struct rgb *k)
{
    const char *const quantities[] = {"eta", "k"};
    struct rgb *const values[] = {eta, k};
    for (int i = 0; i < 2; i++) {
        char name[32];
        const double *pairs;
        size_t count;
        snprintf(name, sizeof name, "%s-%s", metal, quantities[i]);
        if (!spectrum_named(name, &pairs, &count) ||
            !spectrum_reflectance_from_pairs(pairs, count, values[i]))
            return false;
    }
    return true;
}

static double at_least(double alpha)
{
    return fmax(alpha, ALPHA_MIN);
}

/* What is asked for of one axis: its number, and its texture. */
static const struct texture *axis(struct pbrt *p, const struct pbrt_value *roughness,
                                  double (*to_alpha)(double roughness), double *alpha)
{
    struct texture_set *set = &p->desc->textures;
    const struct texture *texture = roughness->texture;
    double written = texture ? rgb_luminance(texture_eval_uv(texture, 0.5, 0.5))
                             : roughness->value.g;
    *alpha = at_least(to_alpha ? to_alpha(written) : written);
    if (!texture)
        return NULL;
    return texture_curve(set, to_alpha ? texture_curve(set, texture, to_alpha) : texture,
                         at_least);
}

bool pbrt_bsdf_roughness(struct pbrt *p, const char *prefix, const char *both,
                         double fallback, double (*to_alpha)(double roughness),
                         struct pbrt_roughness *out, struct err *err)
{
    const char *const names[] = {both ? both : "", "uroughness", "vroughness"};
    struct pbrt_value common = {.value = rgb_grey(fallback)}, u, v;
    struct pbrt_value *const values[] = {&common, &u, &v};
    bool remap = !p->lux;
    for (int i = both ? 0 : 1; i < 3; i++) {
        char name[40];
        snprintf(name, sizeof name, "%s%s", prefix, names[i]);
        if (i == 1)
            u = v = common;
        if (!pbrt_colour_float_value(p, name, values[i], err))
            return false;
    }
    if (!pbrt_params_bool(&p->params, "remaproughness", &remap, err))
        return false;
    out->texture_u = axis(p, &u, remap ? to_alpha : NULL, &out->alpha_u);
    bool same = u.texture && u.texture == v.texture;
    out->texture_v = same ? out->texture_u
                          : axis(p, &v, remap ? to_alpha : NULL, &out->alpha_v);
    if (same)
        out->alpha_v = out->alpha_u;
    out->smooth = !u.texture && !v.texture && u.value.g == 0.0 && v.value.g == 0.0;
    return true;
}

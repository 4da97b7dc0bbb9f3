/* Materials by the names of pbrt v3, most of which LuxRender has too. */
#include "import/pbrt/pbrt_material_tables.h"

#include "import/pbrt/pbrt_bsdf.h"
#include "import/pbrt/pbrt_lux.h"
#include "math/warp.h"
#include "surface/microfacet.h"

#include <math.h>

static bool read_roughness(struct pbrt *p, const char *both, double fallback,
                           struct pbrt_roughness *out, struct err *err)
{
    return pbrt_bsdf_roughness(p, "", both, fallback, microfacet_roughness_to_alpha, out,
                               err);
}

static bool matte(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                  struct err *err)
{
    struct pbrt_value kd = {.value = rgb_grey(0.5)};
    struct pbrt_value sigma = {.value = rgb_grey(0.0)};
    if (!pbrt_colour_value(p, "Kd", &kd, err) ||
        !pbrt_colour_float_value(p, "sigma", &sigma, err))
        return false;
    if (!kd.texture && rgb_is_black(kd.value))
        return pbrt_bsdf_start(bsdf, "black", at, err);
    /* Degrees, from 0 to 90. */
    double degrees = fmin(fmax(sigma.value.g, 0.0), 90.0);
    sigma.value = rgb_grey(sigma.texture ? 1.0 : degrees);
    bool rough = sigma.texture || degrees > 0.0;
    sigma = pbrt_bsdf_scaled(p, &sigma, MATH_PI / 180.0);
    return pbrt_bsdf_start(bsdf, rough ? "orennayar" : "diffuse", at, err) &&
           pbrt_bsdf_set_value(bsdf, "reflectance", &kd, at, err) &&
           (!rough || pbrt_bsdf_set_number(bsdf, "sigma", &sigma, at, err));
}

static bool mirror(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                   struct err *err)
{
    return pbrt_bsdf_start(bsdf, "mirror", at, err) &&
           pbrt_bsdf_pass(p, "Kr", 0.9, bsdf, "reflectance", at, err);
}

static bool glass(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                  struct err *err)
{
    double eta = 1.5;
    struct pbrt_roughness r;
    if (!pbrt_bsdf_eta(p, &eta, err) || !read_roughness(p, NULL, 0.0, &r, err))
        return false;
    return pbrt_bsdf_start(bsdf, r.smooth ? "dielectric" : "roughdielectric", at, err) &&
           bsdf_set(bsdf, "eta", &eta, 1, at, err) &&
           pbrt_bsdf_pass(p, "Kr", 1.0, bsdf, "reflectance", at, err) &&
           pbrt_bsdf_pass(p, "Kt", 1.0, bsdf, "transmittance", at, err) &&
           (r.smooth || pbrt_bsdf_set_roughness(bsdf, &r, at, err));
}

/* pbrt v3 passes the indices of plastic's coat in the wrong order (1.5 outside, 1
 * inside): beyond 42 degrees from a facet it reflects everything. We do the same, as
 * existing pictures were rendered with it. */
static bool plastic(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                    struct err *err)
{
    const double eta = 1.0 / 1.5;
    struct pbrt_roughness r;
    return read_roughness(p, "roughness", 0.1, &r, err) &&
           pbrt_bsdf_start(bsdf, "uber", at, err) &&
           bsdf_set(bsdf, "eta", &eta, 1, at, err) &&
           pbrt_bsdf_pass(p, "Kd", 0.25, bsdf, "kd", at, err) &&
           pbrt_bsdf_pass(p, "Ks", 0.25, bsdf, "ks", at, err) &&
           pbrt_bsdf_set_roughness(bsdf, &r, at, err);
}

static bool uber(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                 struct err *err)
{
    double eta = 1.5;
    struct pbrt_roughness r;
    return pbrt_bsdf_eta(p, &eta, err) && read_roughness(p, "roughness", 0.1, &r, err) &&
           pbrt_bsdf_start(bsdf, "uber", at, err) &&
           bsdf_set(bsdf, "eta", &eta, 1, at, err) &&
           pbrt_bsdf_pass(p, "Kd", 0.25, bsdf, "kd", at, err) &&
           pbrt_bsdf_pass(p, "Ks", 0.25, bsdf, "ks", at, err) &&
           pbrt_bsdf_pass(p, "Kr", 0.0, bsdf, "kr", at, err) &&
           pbrt_bsdf_pass(p, "Kt", 0.0, bsdf, "kt", at, err) &&
           pbrt_bsdf_pass(p, "opacity", 1.0, bsdf, "opacity", at, err) &&
           pbrt_bsdf_set_roughness(bsdf, &r, at, err);
}

/* Stands for all measured data: white glazed ceramic, the most common one. */
static bool fourier(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                    struct err *err)
{
    static const char *const ignored[] = {"bsdffile", NULL};
    static const double eta = 1.5, alpha = 0.025, beckmann = 1.0, nonlinear = 1.0;
    pbrt_params_ignore(&p->params, ignored);
    log_note(&p->desc->log, at,
             "material \"fourier\" is taken as a white base (0.6) under a coat (eta 1.5, "
             "Beckmann alpha 0.025)");
    return pbrt_bsdf_start(bsdf, "roughplastic", at, err) &&
           pbrt_bsdf_set_rgb(bsdf, "reflectance", rgb_grey(0.6), at, err) &&
           bsdf_set(bsdf, "eta", &eta, 1, at, err) &&
           bsdf_set(bsdf, "alpha", &alpha, 1, at, err) &&
           bsdf_set(bsdf, "distribution", &beckmann, 1, at, err) &&
           bsdf_set(bsdf, "nonlinear", &nonlinear, 1, at, err);
}

/* The default is copper. */
static bool metal(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                  struct err *err)
{
    struct rgb eta = pbrt_bsdf_copper_eta, k = pbrt_bsdf_copper_k;
    struct pbrt_roughness r;
    pbrt_lux_metal(p, &eta, &k);
    return pbrt_colour(p, "eta", &eta, err) && pbrt_colour(p, "k", &k, err) &&
           read_roughness(p, "roughness", 0.01, &r, err) &&
           pbrt_bsdf_start(bsdf, "roughconductor", at, err) &&
           pbrt_bsdf_set_rgb(bsdf, "eta", eta, at, err) &&
           pbrt_bsdf_set_rgb(bsdf, "k", k, at, err) &&
           pbrt_bsdf_set_roughness(bsdf, &r, at, err);
}

bool pbrt_material_v3_substrate(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                                struct err *err)
{
    struct pbrt_roughness r;
    return read_roughness(p, NULL, 0.1, &r, err) &&
           pbrt_bsdf_start(bsdf, "substrate", at, err) &&
           pbrt_bsdf_pass(p, "Kd", 0.5, bsdf, "kd", at, err) &&
           pbrt_bsdf_pass(p, "Ks", 0.5, bsdf, "ks", at, err) &&
           pbrt_bsdf_set_roughness(bsdf, &r, at, err);
}

const struct pbrt_material_row pbrt_material_v3[] = {
    {"matte", matte},
    {"mirror", mirror},
    {"glass", glass},
    {"metal", metal},
    {"substrate", pbrt_material_v3_substrate},
    {"plastic", plastic},
    {"uber", uber},
    {"fourier", fourier},
    {"translucent", pbrt_material_translucent},
    {NULL, NULL},
};

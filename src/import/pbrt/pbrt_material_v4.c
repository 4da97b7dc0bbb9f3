/* Materials by the names of pbrt v4. */
#include "import/pbrt/pbrt_material_tables.h"

#include "import/pbrt/pbrt_bsdf.h"

#include <math.h>
#include <stdio.h>

static bool diffuse(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                    struct err *err)
{
    return pbrt_bsdf_start(bsdf, "diffuse", at, err) &&
           pbrt_bsdf_pass(p, "reflectance", 0.5, bsdf, "reflectance", at, err);
}

static double roughness_to_alpha(double roughness)
{
    return sqrt(fmax(roughness, 0.0));
}

/* Of names that begin with a prefix: "interface.", "conductor." or "". */
static bool read_roughness(struct pbrt *p, const char *prefix, struct pbrt_roughness *out,
                           struct err *err)
{
    return pbrt_bsdf_roughness(p, prefix, "roughness", 0.0, roughness_to_alpha, out, err);
}

static bool dielectric(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                       struct err *err)
{
    double eta = 1.5;
    struct pbrt_roughness r;
    if (!pbrt_bsdf_eta(p, &eta, err) || !read_roughness(p, "", &r, err))
        return false;
    return pbrt_bsdf_start(bsdf, r.smooth ? "dielectric" : "roughdielectric", at, err) &&
           bsdf_set(bsdf, "eta", &eta, 1, at, err) &&
           (r.smooth || pbrt_bsdf_set_roughness(bsdf, &r, at, err));
}

static bool thin_dielectric(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                            struct err *err)
{
    double eta = 1.5;
    return pbrt_bsdf_eta(p, &eta, err) &&
           pbrt_bsdf_start(bsdf, "thindielectric", at, err) &&
           bsdf_set(bsdf, "eta", &eta, 1, at, err);
}

/* The metal whose index is 1 and which reflects so much straight on, as pbrt v4 makes it.
 */
static double extinction(double reflectance)
{
    double r = fmin(fmax(reflectance, 0.0), 0.9999);
    return 2.0 * sqrt(r) / sqrt(1.0 - r);
}

/* eta and k, copper's by default, or the reflectance. */
static bool read_metal(struct pbrt *p, const char *prefix, struct rgb *eta, struct rgb *k,
                       struct err *err)
{
    struct rgb reflects = rgb_grey(-1.0);
    char eta_name[32], k_name[32];
    snprintf(eta_name, sizeof eta_name, "%seta", prefix);
    snprintf(k_name, sizeof k_name, "%sk", prefix);
    if (!pbrt_colour(p, "reflectance", &reflects, err))
        return false;
    if (reflects.r >= 0.0) {
        *eta = rgb_grey(1.0);
        *k = rgb(extinction(reflects.r), extinction(reflects.g), extinction(reflects.b));
        return true;
    }
    return pbrt_bsdf_named_metal("metal-Cu", eta, k) &&
           pbrt_colour(p, eta_name, eta, err) && pbrt_colour(p, k_name, k, err);
}

static bool set_metal(struct bsdf *bsdf, struct rgb eta, struct rgb k,
                      const struct pbrt_roughness *r, const struct place *at,
                      struct err *err)
{
    return pbrt_bsdf_start(bsdf, r->smooth ? "conductor" : "roughconductor", at, err) &&
           pbrt_bsdf_set_rgb(bsdf, "eta", eta, at, err) &&
           pbrt_bsdf_set_rgb(bsdf, "k", k, at, err) &&
           (r->smooth || pbrt_bsdf_set_roughness(bsdf, r, at, err));
}

static bool conductor(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                      struct err *err)
{
    struct rgb eta, k;
    struct pbrt_roughness r;
    return read_metal(p, "", &eta, &k, err) && read_roughness(p, "", &r, err) &&
           set_metal(bsdf, eta, k, &r, at, err);
}

/* Seen through a coat, a tilt of the metal's facets deflects light eta times as far as in
 * air, and a tilt of the coat's (eta - 1)/2 as far on each of two passages. */
static double alpha_through(double eta, double metal, double coat)
{
    double bend = eta - 1.0;
    return sqrt(eta * eta * metal * metal + 0.5 * bend * bend * coat * coat);
}

/* The metal within the coat, without what the coat itself reflects: all but the glints of
 * a coat much rougher or smoother than the metal. */
static bool coated_conductor(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                             struct err *err)
{
    static const char *const ignored[] = {"thickness", "maxdepth", "nsamples", NULL};
    struct rgb eta, k;
    struct pbrt_roughness metal, coat;
    double index = 1.5;
    pbrt_params_ignore(&p->params, ignored);
    log_note(
        &p->desc->log, at,
        "material \"coatedconductor\" is taken as its metal, as it looks through the "
        "coat");
    if (!read_metal(p, "conductor.", &eta, &k, err) ||
        !read_roughness(p, "conductor.", &metal, err) ||
        !read_roughness(p, "interface.", &coat, err) ||
        !pbrt_bsdf_named_eta(p, "interface.eta", &index, err))
        return false;
    if (metal.texture_u || metal.texture_v || coat.texture_u || coat.texture_v)
        log_note(
            &p->desc->log, at,
            "the roughness of a \"coatedconductor\" takes no texture here; the value "
            "of its middle is used");
    double through = fmax(index, 1.0);
    struct pbrt_roughness r = {
        .smooth = metal.smooth && coat.smooth,
        .alpha_u = alpha_through(through, metal.alpha_u, coat.alpha_u),
        .alpha_v = alpha_through(through, metal.alpha_v, coat.alpha_v),
    };
    return set_metal(bsdf, rgb_scale(eta, 1.0 / through), rgb_scale(k, 1.0 / through), &r,
                     at, err);
}

static bool coated_diffuse(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                           struct err *err)
{
    static const char *const ignored[] = {"thickness", "maxdepth", "nsamples", NULL};
    static const double nonlinear = 1.0;
    double eta = 1.5;
    struct pbrt_roughness r;
    pbrt_params_ignore(&p->params, ignored);
    log_note(&p->desc->log, at,
             "the coat of a \"coateddiffuse\" absorbs nothing, whatever its thickness");
    if (!pbrt_bsdf_eta(p, &eta, err) || !read_roughness(p, "", &r, err))
        return false;
    return pbrt_bsdf_start(bsdf, r.smooth ? "plastic" : "roughplastic", at, err) &&
           bsdf_set(bsdf, "eta", &eta, 1, at, err) &&
           bsdf_set(bsdf, "nonlinear", &nonlinear, 1, at, err) &&
           pbrt_bsdf_pass(p, "reflectance", 0.5, bsdf, "reflectance", at, err) &&
           (r.smooth || pbrt_bsdf_set_roughness(bsdf, &r, at, err));
}

const struct pbrt_material_row pbrt_material_v4[] = {
    {"diffuse", diffuse},
    {"dielectric", dielectric},
    {"thindielectric", thin_dielectric},
    {"conductor", conductor},
    {"coateddiffuse", coated_diffuse},
    {"coatedconductor", coated_conductor},
    {"diffusetransmission", pbrt_material_diffuse_transmission},
    {NULL, NULL},
};

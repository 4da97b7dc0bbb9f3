/* Materials by the names of pbrt v4. */
#include "import/pbrt/pbrt_material_tables.h"

#include "import/pbrt/pbrt_bsdf.h"

#include <math.h>

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

static bool read_roughness(struct pbrt *p, struct pbrt_roughness *out, struct err *err)
{
    return pbrt_bsdf_roughness(p, "roughness", 0.0, roughness_to_alpha, out, err);
}

static bool dielectric(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                       struct err *err)
{
    double eta = 1.5;
    struct pbrt_roughness r;
    if (!pbrt_bsdf_eta(p, &eta, err) || !read_roughness(p, &r, err))
        return false;
    bool smooth = r.u == 0.0 && r.v == 0.0;
    return pbrt_bsdf_start(bsdf, smooth ? "dielectric" : "roughdielectric", at, err) &&
           bsdf_set(bsdf, "eta", &eta, 1, at, err) &&
           (smooth || pbrt_bsdf_set_roughness(bsdf, &r, at, err));
}

static bool thin_dielectric(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                            struct err *err)
{
    double eta = 1.5;
    return pbrt_bsdf_eta(p, &eta, err) &&
           pbrt_bsdf_start(bsdf, "thindielectric", at, err) &&
           bsdf_set(bsdf, "eta", &eta, 1, at, err);
}

static bool conductor(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                      struct err *err)
{
    struct rgb eta = pbrt_bsdf_copper_eta, k = pbrt_bsdf_copper_k;
    struct pbrt_roughness r;
    if (!pbrt_colour(p, "eta", &eta, err) || !pbrt_colour(p, "k", &k, err) ||
        !read_roughness(p, &r, err))
        return false;
    bool smooth = r.u == 0.0 && r.v == 0.0;
    return pbrt_bsdf_start(bsdf, smooth ? "conductor" : "roughconductor", at, err) &&
           pbrt_bsdf_set_rgb(bsdf, "eta", eta, at, err) &&
           pbrt_bsdf_set_rgb(bsdf, "k", k, at, err) &&
           (smooth || pbrt_bsdf_set_roughness(bsdf, &r, at, err));
}

static bool coated_diffuse(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                           struct err *err)
{
    static const char *const ignored[] = {"thickness", "maxdepth", "nsamples", NULL};
    static const double nonlinear = 1.0;
    double eta = 1.5;
    struct pbrt_roughness r;
    pbrt_params_ignore(&p->params, ignored);
    if (!pbrt_bsdf_eta(p, &eta, err) || !read_roughness(p, &r, err))
        return false;
    bool smooth = r.u == 0.0 && r.v == 0.0;
    return pbrt_bsdf_start(bsdf, smooth ? "plastic" : "roughplastic", at, err) &&
           bsdf_set(bsdf, "eta", &eta, 1, at, err) &&
           bsdf_set(bsdf, "nonlinear", &nonlinear, 1, at, err) &&
           pbrt_bsdf_pass(p, "reflectance", 0.5, bsdf, "reflectance", at, err) &&
           (smooth || pbrt_bsdf_set_roughness(bsdf, &r, at, err));
}

const struct pbrt_material_row pbrt_material_v4[] = {
    {"diffuse", diffuse},
    {"dielectric", dielectric},
    {"thindielectric", thin_dielectric},
    {"conductor", conductor},
    {"coateddiffuse", coated_diffuse},
    {NULL, NULL},
};

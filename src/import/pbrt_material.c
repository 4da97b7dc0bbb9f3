#include "import/pbrt_scene.h"

#include "base/text.h"
#include "import/pbrt_colour.h"
#include "import/suggest.h"

#include <math.h>

/* pbrt v3's smallest alpha of its microfacet distributions. */
#define ALPHA_MIN 1e-3

static bool start(struct bsdf *bsdf, const char *kind, const struct place *at,
                  struct err *err)
{
    const struct bsdf_type *type = bsdf_find(kind);
    if (!type)
        return err_set(err, ERR_UNSUPPORTED, at, "no BSDF of the kind %s", kind);
    bsdf_init(bsdf, type);
    return true;
}

static bool set_rgb(struct bsdf *bsdf, const char *name, struct rgb value,
                    const struct place *at, struct err *err)
{
    return bsdf_set(bsdf, name, &value.r, 3, at, err);
}

/* pbrt v3's TrowbridgeReitzDistribution::RoughnessToAlpha. */
static double roughness_to_alpha(double roughness)
{
    double x = log(fmax(roughness, 1e-3));
    return 1.62142 + x * (0.819955 + x * (0.1734 + x * (0.0171201 + x * 0.000640711)));
}

struct roughness {
    double u, v; /* as written */
    double alpha_u, alpha_v;
};

/* uroughness and vroughness; `both` is a name that stands for the two, or NULL. */
static bool read_roughness(struct pbrt *p, const char *both, double fallback,
                           struct roughness *out, struct err *err)
{
    bool remap = true;
    double value = fallback;
    if (both && !pbrt_colour_float(p, both, &value, NULL, err))
        return false;
    out->u = out->v = value;
    if (!pbrt_colour_float(p, "uroughness", &out->u, NULL, err) ||
        !pbrt_colour_float(p, "vroughness", &out->v, NULL, err) ||
        !pbrt_params_bool(&p->params, "remaproughness", &remap, err))
        return false;
    out->alpha_u = fmax(remap ? roughness_to_alpha(out->u) : out->u, ALPHA_MIN);
    out->alpha_v = fmax(remap ? roughness_to_alpha(out->v) : out->v, ALPHA_MIN);
    return true;
}

static bool set_roughness(struct bsdf *bsdf, const struct roughness *r,
                          const struct place *at, struct err *err)
{
    return bsdf_set(bsdf, "alpha_u", &r->alpha_u, 1, at, err) &&
           bsdf_set(bsdf, "alpha_v", &r->alpha_v, 1, at, err);
}

static bool matte(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                  struct err *err)
{
    struct rgb kd = rgb_grey(0.5);
    double sigma = 0.0;
    if (!pbrt_colour(p, "Kd", &kd, err) ||
        !pbrt_colour_float(p, "sigma", &sigma, NULL, err))
        return false;
    if (sigma != 0.0)
        log_note(&p->desc->log, at, "matte with a sigma is taken as Lambertian");
    if (rgb_is_black(kd))
        return start(bsdf, "black", at, err);
    return start(bsdf, "diffuse", at, err) && set_rgb(bsdf, "reflectance", kd, at, err);
}

static bool mirror(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                   struct err *err)
{
    struct rgb kr = rgb_grey(0.9);
    return pbrt_colour(p, "Kr", &kr, err) && start(bsdf, "mirror", at, err) &&
           set_rgb(bsdf, "reflectance", kr, at, err);
}

static bool glass(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                  struct err *err)
{
    struct rgb kr = rgb_grey(1.0), kt = rgb_grey(1.0);
    double eta = 1.5;
    bool has_eta;
    struct roughness r;
    if (!pbrt_colour(p, "Kr", &kr, err) || !pbrt_colour(p, "Kt", &kt, err) ||
        !pbrt_colour_float(p, "eta", &eta, &has_eta, err) ||
        (!has_eta && !pbrt_colour_float(p, "index", &eta, NULL, err)) ||
        !read_roughness(p, NULL, 0.0, &r, err))
        return false;
    bool smooth = r.u == 0.0 && r.v == 0.0;
    return start(bsdf, smooth ? "dielectric" : "roughdielectric", at, err) &&
           bsdf_set(bsdf, "eta", &eta, 1, at, err) &&
           set_rgb(bsdf, "reflectance", kr, at, err) &&
           set_rgb(bsdf, "transmittance", kt, at, err) &&
           (smooth || set_roughness(bsdf, &r, at, err));
}

/* The default is copper, its measured spectra in linear Rec. 709. */
static bool metal(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                  struct err *err)
{
    struct rgb eta = rgb(0.2004376970, 0.9240334304, 1.1022119527);
    struct rgb k = rgb(3.9129485033, 2.4528477015, 2.1421879552);
    struct roughness r;
    return pbrt_colour(p, "eta", &eta, err) && pbrt_colour(p, "k", &k, err) &&
           read_roughness(p, "roughness", 0.01, &r, err) &&
           start(bsdf, "roughconductor", at, err) && set_rgb(bsdf, "eta", eta, at, err) &&
           set_rgb(bsdf, "k", k, at, err) && set_roughness(bsdf, &r, at, err);
}

static bool substrate(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                      struct err *err)
{
    struct rgb kd = rgb_grey(0.5), ks = rgb_grey(0.5);
    struct roughness r;
    return pbrt_colour(p, "Kd", &kd, err) && pbrt_colour(p, "Ks", &ks, err) &&
           read_roughness(p, NULL, 0.1, &r, err) && start(bsdf, "substrate", at, err) &&
           set_rgb(bsdf, "kd", kd, at, err) && set_rgb(bsdf, "ks", ks, at, err) &&
           set_roughness(bsdf, &r, at, err);
}

static const struct material_row {
    const char *name;
    bool (*read)(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                 struct err *err); /* NULL: known, not to be had */
} rows[] = {
    {"matte", matte},      {"mirror", mirror},       {"glass", glass},
    {"metal", metal},      {"substrate", substrate}, {"plastic", NULL},
    {"translucent", NULL}, {"uber", NULL},           {"mix", NULL},
    {"fourier", NULL},     {"hair", NULL},           {"disney", NULL},
    {"subsurface", NULL},  {"kdsubsurface", NULL},
};

#define ROWS (sizeof rows / sizeof rows[0])

static bool add(struct pbrt *p, const struct material_row *row, const struct place *at,
                int *index, struct err *err)
{
    struct bsdf bsdf;
    if (!row->read)
        return err_set(err, ERR_UNSUPPORTED, at,
                       "material \"%s\" is not read yet (read: matte, mirror, glass, "
                       "metal, substrate, none)",
                       row->name);
    if (!row->read(p, at, &bsdf, err) || !bsdf_prepare(&bsdf, at, err))
        return false;
    *index = scene_desc_add_material(p->desc, &bsdf);
    return true;
}

bool pbrt_material(struct pbrt *p, const char *type, const struct place *at, int *index,
                   struct err *err)
{
    if (text_equal(type, "") || text_equal(type, "none")) {
        *index = PBRT_MATERIAL_NONE;
        return true;
    }
    const char *known[ROWS + 2] = {"none"};
    for (size_t i = 0; i < ROWS; i++) {
        if (text_equal(type, rows[i].name))
            return add(p, &rows[i], at, index, err);
        known[i + 1] = rows[i].name;
    }
    return suggest_fail(err, at, "material", type, known);
}

bool pbrt_material_default(struct pbrt *p, int *index, struct err *err)
{
    if (p->default_material < 0) {
        struct bsdf bsdf;
        if (!start(&bsdf, "diffuse", NULL, err) ||
            !set_rgb(&bsdf, "reflectance", rgb_grey(0.5), NULL, err) ||
            !bsdf_prepare(&bsdf, NULL, err))
            return false;
        p->default_material = scene_desc_add_material(p->desc, &bsdf);
    }
    *index = p->default_material;
    return true;
}

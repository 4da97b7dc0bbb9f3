#include "import/pbrt_scene.h"

#include "base/text.h"
#include "import/pbrt_lux.h"
#include "import/suggest.h"

#include <math.h>

/* pbrt v3's smallest alpha of its microfacet distributions. */
#define ALPHA_MIN 1e-3

/* Copper's measured spectra in linear Rec. 709. */
static const struct rgb copper_eta = {0.2004376970, 0.9240334304, 1.1022119527};
static const struct rgb copper_k = {3.9129485033, 2.4528477015, 2.1421879552};

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

static bool set_value(struct bsdf *bsdf, const char *name, const struct pbrt_value *value,
                      const struct place *at, struct err *err)
{
    return value->texture ? bsdf_bind(bsdf, name, value->texture, at, err)
                          : set_rgb(bsdf, name, value->value, at, err);
}

/* Reads a colour or its texture into a parameter of the BSDF. */
static bool pass(struct pbrt *p, const char *name, double fallback, struct bsdf *bsdf,
                 const char *to, const struct place *at, struct err *err)
{
    struct pbrt_value value = {.value = rgb_grey(fallback)};
    return pbrt_colour_value(p, name, &value, err) &&
           set_value(bsdf, to, &value, at, err);
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
    bool remap = !p->lux;
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
    struct pbrt_value kd = {.value = rgb_grey(0.5)};
    double sigma = 0.0;
    if (!pbrt_colour_value(p, "Kd", &kd, err) ||
        !pbrt_colour_float(p, "sigma", &sigma, NULL, err))
        return false;
    if (sigma != 0.0)
        log_note(&p->desc->log, at, "matte with a sigma is taken as Lambertian");
    if (!kd.texture && rgb_is_black(kd.value))
        return start(bsdf, "black", at, err);
    return start(bsdf, "diffuse", at, err) &&
           set_value(bsdf, "reflectance", &kd, at, err);
}

static bool mirror(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                   struct err *err)
{
    return start(bsdf, "mirror", at, err) &&
           pass(p, "Kr", 0.9, bsdf, "reflectance", at, err);
}

/* eta, or index as older files have it. */
static bool read_eta(struct pbrt *p, double *eta, struct err *err)
{
    bool has_eta;
    return pbrt_colour_float(p, "eta", eta, &has_eta, err) &&
           (has_eta || pbrt_colour_float(p, "index", eta, NULL, err));
}

static bool glass(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                  struct err *err)
{
    double eta = 1.5;
    struct roughness r;
    if (!read_eta(p, &eta, err) || !read_roughness(p, NULL, 0.0, &r, err))
        return false;
    bool smooth = r.u == 0.0 && r.v == 0.0;
    return start(bsdf, smooth ? "dielectric" : "roughdielectric", at, err) &&
           bsdf_set(bsdf, "eta", &eta, 1, at, err) &&
           pass(p, "Kr", 1.0, bsdf, "reflectance", at, err) &&
           pass(p, "Kt", 1.0, bsdf, "transmittance", at, err) &&
           (smooth || set_roughness(bsdf, &r, at, err));
}

/* pbrt v3 gives the coat of plastic its indices the wrong way round (1.5 outside, 1
 * inside): beyond 42 degrees from a facet it reflects all. The pictures that people have
 * were made with it. */
static bool plastic(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                    struct err *err)
{
    const double eta = 1.0 / 1.5;
    struct roughness r;
    return read_roughness(p, "roughness", 0.1, &r, err) && start(bsdf, "uber", at, err) &&
           bsdf_set(bsdf, "eta", &eta, 1, at, err) &&
           pass(p, "Kd", 0.25, bsdf, "kd", at, err) &&
           pass(p, "Ks", 0.25, bsdf, "ks", at, err) && set_roughness(bsdf, &r, at, err);
}

static bool uber(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                 struct err *err)
{
    double eta = 1.5;
    struct roughness r;
    return read_eta(p, &eta, err) && read_roughness(p, "roughness", 0.1, &r, err) &&
           start(bsdf, "uber", at, err) && bsdf_set(bsdf, "eta", &eta, 1, at, err) &&
           pass(p, "Kd", 0.25, bsdf, "kd", at, err) &&
           pass(p, "Ks", 0.25, bsdf, "ks", at, err) &&
           pass(p, "Kr", 0.0, bsdf, "kr", at, err) &&
           pass(p, "Kt", 0.0, bsdf, "kt", at, err) &&
           pass(p, "opacity", 1.0, bsdf, "opacity", at, err) &&
           set_roughness(bsdf, &r, at, err);
}

static bool find_part(struct pbrt *p, const char *name, const struct place *at,
                      const struct bsdf **part, struct err *err)
{
    const struct pbrt_named *found = pbrt_names_find(&p->materials, "named material",
                                                     name, at, err);
    if (!found)
        return false;
    *part = found->material == PBRT_MATERIAL_NONE
                ? NULL
                : scene_desc_add_part(p->desc, &p->desc->materials[found->material]);
    return true;
}

static bool mixed_part(struct pbrt *p, const char *name, const struct bsdf **part,
                       struct err *err)
{
    const struct pbrt_param *param = pbrt_params_find(&p->params, name, PBRT_STRING);
    if (!param)
        return err_set(err, ERR_VALUE, &p->params.place, "a mix wants \"string %s\"",
                       name);
    return find_part(p, pbrt_params_text(&p->params, param), &param->place, part, err);
}

/* v4: both in one list. */
static bool mixed_list(struct pbrt *p, const struct pbrt_param *names, struct bsdf *bsdf,
                       struct err *err)
{
    if (names->count != 2)
        return err_set(err, ERR_VALUE, &names->place,
                       "\"string materials\" of a mix holds %zu names, two are wanted",
                       names->count);
    for (size_t i = 0; i < 2; i++)
        if (!find_part(p, pbrt_params_text_at(&p->params, names, i), &names->place,
                       &bsdf->child[i], err))
            return false;
    return true;
}

/* amount is the share of the first; in LuxRender and in v4 a number, that of the second.
 */
static bool mix(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                struct err *err)
{
    const struct pbrt_param *names = pbrt_params_find(&p->params, "materials",
                                                      PBRT_STRING);
    struct pbrt_value amount = {.value = rgb_grey(0.5)};
    bool first = !p->lux;
    return start(bsdf, "blend", at, err) &&
           (names ? mixed_list(p, names, bsdf, err)
                  : mixed_part(p, "namedmaterial1", &bsdf->child[first], err) &&
                        mixed_part(p, "namedmaterial2", &bsdf->child[!first], err)) &&
           (p->lux || names ? pbrt_colour_float_value(p, "amount", &amount, err)
                            : pbrt_colour_value(p, "amount", &amount, err)) &&
           set_value(bsdf, "weight", &amount, at, err);
}

/* Measured data of any kind: the most usual one, white ceramic under its glaze. */
static bool fourier(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                    struct err *err)
{
    static const char *const ignored[] = {"bsdffile", NULL};
    static const double eta = 1.5, alpha = 0.025, beckmann = 1.0, nonlinear = 1.0;
    pbrt_params_ignore(&p->params, ignored);
    log_note(&p->desc->log, at,
             "material \"fourier\" is taken as a white base (0.6) under a coat (eta 1.5, "
             "Beckmann alpha 0.025)");
    return start(bsdf, "roughplastic", at, err) &&
           set_rgb(bsdf, "reflectance", rgb_grey(0.6), at, err) &&
           bsdf_set(bsdf, "eta", &eta, 1, at, err) &&
           bsdf_set(bsdf, "alpha", &alpha, 1, at, err) &&
           bsdf_set(bsdf, "distribution", &beckmann, 1, at, err) &&
           bsdf_set(bsdf, "nonlinear", &nonlinear, 1, at, err);
}

/* The default is copper. */
static bool metal(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                  struct err *err)
{
    struct rgb eta = copper_eta, k = copper_k;
    struct roughness r;
    pbrt_lux_metal(p, &eta, &k);
    return pbrt_colour(p, "eta", &eta, err) && pbrt_colour(p, "k", &k, err) &&
           read_roughness(p, "roughness", 0.01, &r, err) &&
           start(bsdf, "roughconductor", at, err) && set_rgb(bsdf, "eta", eta, at, err) &&
           set_rgb(bsdf, "k", k, at, err) && set_roughness(bsdf, &r, at, err);
}

static bool substrate(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                      struct err *err)
{
    struct roughness r;
    return read_roughness(p, NULL, 0.1, &r, err) && start(bsdf, "substrate", at, err) &&
           pass(p, "Kd", 0.5, bsdf, "kd", at, err) &&
           pass(p, "Ks", 0.5, bsdf, "ks", at, err) && set_roughness(bsdf, &r, at, err);
}

/* --- the names of v4 -------------------------------------------------------------- */

static bool diffuse(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                    struct err *err)
{
    return start(bsdf, "diffuse", at, err) &&
           pass(p, "reflectance", 0.5, bsdf, "reflectance", at, err);
}

/* v4 turns roughness into alpha by a square root. */
static bool roughness_v4(struct pbrt *p, double fallback, struct roughness *r,
                         struct err *err)
{
    bool remap = true;
    r->u = r->v = fallback;
    if (!pbrt_colour_float(p, "roughness", &r->u, NULL, err))
        return false;
    r->v = r->u;
    if (!pbrt_colour_float(p, "uroughness", &r->u, NULL, err) ||
        !pbrt_colour_float(p, "vroughness", &r->v, NULL, err) ||
        !pbrt_params_bool(&p->params, "remaproughness", &remap, err))
        return false;
    r->alpha_u = fmax(remap ? sqrt(fmax(r->u, 0.0)) : r->u, ALPHA_MIN);
    r->alpha_v = fmax(remap ? sqrt(fmax(r->v, 0.0)) : r->v, ALPHA_MIN);
    return true;
}

static bool dielectric(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                       struct err *err)
{
    double eta = 1.5;
    struct roughness r;
    if (!read_eta(p, &eta, err) || !roughness_v4(p, 0.0, &r, err))
        return false;
    bool smooth = r.u == 0.0 && r.v == 0.0;
    return start(bsdf, smooth ? "dielectric" : "roughdielectric", at, err) &&
           bsdf_set(bsdf, "eta", &eta, 1, at, err) &&
           (smooth || set_roughness(bsdf, &r, at, err));
}

static bool thin_dielectric(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                            struct err *err)
{
    double eta = 1.5;
    return read_eta(p, &eta, err) && start(bsdf, "thindielectric", at, err) &&
           bsdf_set(bsdf, "eta", &eta, 1, at, err);
}

static bool conductor(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                      struct err *err)
{
    struct rgb eta = copper_eta, k = copper_k;
    struct roughness r;
    if (!pbrt_colour(p, "eta", &eta, err) || !pbrt_colour(p, "k", &k, err) ||
        !roughness_v4(p, 0.0, &r, err))
        return false;
    bool smooth = r.u == 0.0 && r.v == 0.0;
    return start(bsdf, smooth ? "conductor" : "roughconductor", at, err) &&
           set_rgb(bsdf, "eta", eta, at, err) && set_rgb(bsdf, "k", k, at, err) &&
           (smooth || set_roughness(bsdf, &r, at, err));
}

static bool coated_diffuse(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                           struct err *err)
{
    static const char *const ignored[] = {"thickness", "maxdepth", "nsamples", NULL};
    static const double nonlinear = 1.0;
    double eta = 1.5;
    struct roughness r;
    pbrt_params_ignore(&p->params, ignored);
    if (!read_eta(p, &eta, err) || !roughness_v4(p, 0.0, &r, err))
        return false;
    bool smooth = r.u == 0.0 && r.v == 0.0;
    return start(bsdf, smooth ? "plastic" : "roughplastic", at, err) &&
           bsdf_set(bsdf, "eta", &eta, 1, at, err) &&
           bsdf_set(bsdf, "nonlinear", &nonlinear, 1, at, err) &&
           pass(p, "reflectance", 0.5, bsdf, "reflectance", at, err) &&
           (smooth || set_roughness(bsdf, &r, at, err));
}

/* --- LuxRender's names ------------------------------------------------------------ */

static bool glossy(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                   struct err *err)
{
    static const char *const ignored[] = {"multibounce", "index", NULL};
    pbrt_params_ignore(&p->params, ignored);
    return substrate(p, at, bsdf, err);
}

/* Of the volume named last; architectural glass does not bend what passes it. */
static bool glass2(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                   struct err *err)
{
    static const char *const ignored[] = {"dispersion", NULL};
    bool thin = false;
    pbrt_params_ignore(&p->params, ignored);
    return pbrt_params_bool(&p->params, "architectural", &thin, err) &&
           start(bsdf, thin ? "thindielectric" : "dielectric", at, err) &&
           bsdf_set(bsdf, "eta", &p->lux_index, 1, at, err);
}

static bool carpaint(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                     struct err *err)
{
    static const char *const ignored[] = {"name", NULL};
    static const double alpha = 0.1;
    pbrt_params_ignore(&p->params, ignored);
    log_note(&p->desc->log, at, "carpaint is taken as a glossy coat over dark blue");
    return start(bsdf, "substrate", at, err) &&
           set_rgb(bsdf, "kd", rgb(0.005, 0.02, 0.1), at, err) &&
           set_rgb(bsdf, "ks", rgb_grey(0.1), at, err) &&
           bsdf_set(bsdf, "alpha", &alpha, 1, at, err);
}

static const struct material_row {
    const char *name;
    bool (*read)(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                 struct err *err); /* NULL: known, taken as diffuse */
} rows[] = {
    {"matte", matte},
    {"mirror", mirror},
    {"glass", glass},
    {"metal", metal},
    {"substrate", substrate},
    {"plastic", plastic},
    {"uber", uber},
    {"mix", mix},
    {"fourier", fourier},
    {"diffuse", diffuse},
    {"dielectric", dielectric},
    {"thindielectric", thin_dielectric},
    {"conductor", conductor},
    {"coateddiffuse", coated_diffuse},
    {"glossy", glossy},
    {"glass2", glass2},
    {"carpaint", carpaint},
    {"translucent", NULL},
    {"hair", NULL},
    {"disney", NULL},
    {"subsurface", NULL},
    {"kdsubsurface", NULL},
    {"coatedconductor", NULL},
    {"diffusetransmission", NULL},
    {"measured", NULL},
};

#define ROWS (sizeof rows / sizeof rows[0])

/* What has a colour keeps it. */
static bool substitute(struct pbrt *p, const char *name, const struct place *at,
                       struct bsdf *bsdf, struct err *err)
{
    static const char *const colours[] = {"Kd", "color", "reflectance", NULL};
    struct pbrt_value value = {.value = rgb_grey(0.5)};
    log_note(&p->desc->log, at, "material \"%s\" is taken as diffuse", name);
    for (int i = 0; colours[i]; i++)
        if (!pbrt_colour_value(p, colours[i], &value, err))
            return false;
    pbrt_ignored(p, err);
    return start(bsdf, "diffuse", at, err) &&
           set_value(bsdf, "reflectance", &value, at, err);
}

static bool add(struct pbrt *p, const struct material_row *row, const struct place *at,
                int *index, struct err *err)
{
    struct bsdf bsdf;
    struct pbrt_value bump = {0};
    if (row->read ? !row->read(p, at, &bsdf, err)
                  : !substitute(p, row->name, at, &bsdf, err))
        return false;
    if (!pbrt_colour_float_value(p, "bumpmap", &bump, err) ||
        !pbrt_colour_float_value(p, "displacement", &bump, err))
        return false;
    bsdf.bump = bump.texture; /* a constant one moves no normal */
    if (!bsdf_prepare(&bsdf, at, err))
        return false;
    *index = scene_desc_add_material(p->desc, &bsdf);
    return true;
}

bool pbrt_material(struct pbrt *p, const char *type, const struct place *at, int *index,
                   struct err *err)
{
    if (text_equal(type, "") || text_equal(type, "none") ||
        text_equal(type, "interface")) {
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

bool pbrt_material_masked(struct pbrt *p, int material, const struct texture *alpha,
                          int *index, struct err *err)
{
    struct bsdf through, mask;
    if (!start(&through, "null", NULL, err) || !bsdf_prepare(&through, NULL, err) ||
        !start(&mask, "blend", NULL, err))
        return false;
    mask.child[0] = scene_desc_add_part(p->desc, &through);
    mask.child[1] = scene_desc_add_part(p->desc, &p->desc->materials[material]);
    mask.bump = mask.child[1]->bump;
    if (!bsdf_bind(&mask, "weight", alpha, &p->params.place, err) ||
        !bsdf_prepare(&mask, &p->params.place, err))
        return false;
    *index = scene_desc_add_material(p->desc, &mask);
    return true;
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

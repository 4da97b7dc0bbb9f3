#include "import/mitsuba_scene.h"

#include "base/mem.h"
#include "base/text.h"
#include "surface/fresnel.h"

#include <math.h>

#define ALPHA_MIN 1e-4 /* Mitsuba's smallest roughness */

static void start(struct bsdf *bsdf, const char *kind)
{
    bsdf_init(bsdf, bsdf_find(kind));
}

static bool set_rgb(struct bsdf *bsdf, const char *name, struct rgb value,
                    const struct mitsuba_node *object, struct err *err)
{
    return bsdf_set(bsdf, name, &value.r, 3, &object->place, err);
}

bool mitsuba_material_add(struct mitsuba *m, struct bsdf *bsdf,
                          const struct mitsuba_node *object, int *index, struct err *err)
{
    if (!bsdf_prepare(bsdf, &object->place, err))
        return false;
    *index = scene_desc_add_material(m->desc, bsdf);
    return true;
}

/* An opaque material, which Mitsuba lights from its front alone unless "twosided" is
 * around it. */
static bool add_opaque(struct mitsuba *m, struct bsdf *bsdf,
                       const struct mitsuba_node *object, int *index, struct err *err)
{
    struct bsdf sides;
    if (!bsdf_prepare(bsdf, &object->place, err))
        return false;
    if (m->two_sided > 0 || bsdf->flags & BSDF_BLACK)
        return mitsuba_material_add(m, bsdf, object, index, err);
    start(&sides, "sides");
    sides.child[0] = scene_desc_add_part(m->desc, bsdf);
    return mitsuba_material_add(m, &sides, object, index, err);
}

static bool set_value(struct bsdf *bsdf, const char *name,
                      const struct mitsuba_value *value,
                      const struct mitsuba_node *object, struct err *err)
{
    return value->texture ? bsdf_bind(bsdf, name, value->texture, &object->place, err)
                          : set_rgb(bsdf, name, value->value, object, err);
}

bool mitsuba_material_pass(struct mitsuba *m, struct mitsuba_node *object,
                           const char *name, double fallback, struct bsdf *bsdf,
                           const char *to, struct err *err)
{
    struct mitsuba_value value = {.value = rgb_grey(fallback)};
    return mitsuba_value(m, object, name, &value, err) &&
           set_value(bsdf, to, &value, object, err);
}

static bool set_number(struct bsdf *bsdf, const char *name, double value,
                       const struct mitsuba_node *object, struct err *err)
{
    return bsdf_set(bsdf, name, &value, 1, &object->place, err);
}

static bool add_diffuse(struct mitsuba *m, struct mitsuba_node *object,
                        const char *property, int *index, struct err *err)
{
    struct bsdf bsdf;
    struct mitsuba_value reflectance = {.value = rgb_grey(0.5)};
    if (!mitsuba_value(m, object, property, &reflectance, err))
        return false;
    if (!reflectance.texture && rgb_is_black(reflectance.value)) {
        start(&bsdf, "black");
        return mitsuba_material_add(m, &bsdf, object, index, err);
    }
    start(&bsdf, "diffuse");
    return set_value(&bsdf, "reflectance", &reflectance, object, err) &&
           add_opaque(m, &bsdf, object, index, err);
}

static bool diffuse(struct mitsuba *m, struct mitsuba_node *object, int *index,
                    struct err *err)
{
    return add_diffuse(m, object, "reflectance", index, err);
}

static bool base_colour(struct mitsuba *m, struct mitsuba_node *object, int *index,
                        struct err *err)
{
    return add_diffuse(m, object, "base_color", index, err);
}

static bool diffuse_part(struct mitsuba *m, struct mitsuba_node *object, int *index,
                         struct err *err)
{
    return add_diffuse(m, object, "diffuse_reflectance", index, err);
}

static bool phong(struct mitsuba *m, struct mitsuba_node *object, int *index,
                  struct err *err)
{
    struct bsdf bsdf;
    struct rgb exponent = rgb_grey(30.0);
    start(&bsdf, "phong");
    return mitsuba_colour(m, object, "exponent", &exponent, err) &&
           set_number(&bsdf, "exponent", exponent.r, object, err) &&
           mitsuba_material_pass(m, object, "diffuse_reflectance", 0.5, &bsdf, "kd",
                                 err) &&
           mitsuba_material_pass(m, object, "specular_reflectance", 0.2, &bsdf, "ks",
                                 err) &&
           add_opaque(m, &bsdf, object, index, err);
}

/* A number or its texture; the mean of one where the kind takes none. */
static bool pass_alpha(struct mitsuba *m, struct mitsuba_node *object, const char *name,
                       struct mitsuba_value value, struct bsdf *bsdf, struct err *err)
{
    if (value.texture && !bsdf->type->fixed_alpha)
        return bsdf_bind(bsdf, name, value.texture, &object->place, err);
    if (value.texture)
        value.value = mitsuba_texture_mean(m, object, value.texture);
    return set_number(bsdf, name, fmax(value.value.r, ALPHA_MIN), object, err);
}

/* Other microfacets than ours are noted. */
static bool set_distribution(struct mitsuba *m, struct mitsuba_node *object,
                             struct bsdf *bsdf, struct err *err)
{
    const char *name = "beckmann";
    if (!mitsuba_string(object, "distribution", &name, err))
        return false;
    bool ggx = text_equal(name, "ggx");
    if (!ggx && !text_equal(name, "beckmann"))
        log_note(&m->desc->log, &object->place,
                 "distribution \"%s\" is taken as \"beckmann\"", name);
    return set_number(bsdf, "distribution", ggx ? 0.0 : 1.0, object, err);
}

/* alpha, or alpha_u and alpha_v. */
static bool set_roughness(struct mitsuba *m, struct mitsuba_node *object,
                          struct bsdf *bsdf, struct err *err)
{
    struct mitsuba_value alpha = {.value = rgb_grey(0.1)}, u, v;
    if (!mitsuba_value(m, object, "alpha", &alpha, err))
        return false;
    u = v = alpha;
    return mitsuba_value(m, object, "alpha_u", &u, err) &&
           mitsuba_value(m, object, "alpha_v", &v, err) &&
           pass_alpha(m, object, "alpha_u", u, bsdf, err) &&
           pass_alpha(m, object, "alpha_v", v, bsdf, err) &&
           set_distribution(m, object, bsdf, err);
}

/* The kinds that let light through share their parameters. */
static bool read_glass(struct mitsuba *m, struct mitsuba_node *object, const char *kind,
                       struct bsdf *bsdf, struct err *err)
{
    double eta;
    start(bsdf, kind);
    return mitsuba_ior_ratio(object, MITSUBA_IOR_BK7, &eta, err) &&
           set_number(bsdf, "eta", eta, object, err) &&
           mitsuba_material_pass(m, object, "specular_reflectance", 1.0, bsdf,
                                 "reflectance", err) &&
           mitsuba_material_pass(m, object, "specular_transmittance", 1.0, bsdf,
                                 "transmittance", err);
}

static bool dielectric(struct mitsuba *m, struct mitsuba_node *object, int *index,
                       struct err *err)
{
    struct bsdf bsdf;
    return read_glass(m, object, "dielectric", &bsdf, err) &&
           mitsuba_material_add(m, &bsdf, object, index, err);
}

static bool roughdielectric(struct mitsuba *m, struct mitsuba_node *object, int *index,
                            struct err *err)
{
    struct bsdf bsdf;
    return read_glass(m, object, "roughdielectric", &bsdf, err) &&
           set_roughness(m, object, &bsdf, err) &&
           mitsuba_material_add(m, &bsdf, object, index, err);
}

static bool thindielectric(struct mitsuba *m, struct mitsuba_node *object, int *index,
                           struct err *err)
{
    struct bsdf bsdf;
    return read_glass(m, object, "thindielectric", &bsdf, err) &&
           mitsuba_material_add(m, &bsdf, object, index, err);
}

static bool metal(struct mitsuba *m, struct mitsuba_node *object, bool rough, int *index,
                  struct err *err)
{
    struct rgb eta = rgb_grey(0.0), k = rgb_grey(1.0); /* which reflect all */
    bool perfect;
    struct bsdf bsdf;
    if (!mitsuba_ior_metal(m, object, &eta, &k, &perfect, err))
        return false;
    start(&bsdf, rough ? "roughconductor" : perfect ? "mirror" : "conductor");
    if ((rough || !perfect) && (!set_rgb(&bsdf, "eta", eta, object, err) ||
                                !set_rgb(&bsdf, "k", k, object, err)))
        return false;
    return (!rough || set_roughness(m, object, &bsdf, err)) &&
           mitsuba_material_pass(m, object, "specular_reflectance", 1.0, &bsdf,
                                 "reflectance", err) &&
           add_opaque(m, &bsdf, object, index, err);
}

static bool conductor(struct mitsuba *m, struct mitsuba_node *object, int *index,
                      struct err *err)
{
    return metal(m, object, false, index, err);
}

static bool roughconductor(struct mitsuba *m, struct mitsuba_node *object, int *index,
                           struct err *err)
{
    return metal(m, object, true, index, err);
}

/* A dielectric coat over a diffuse base. */
static bool coated(struct mitsuba *m, struct mitsuba_node *object, const char *kind,
                   struct bsdf *bsdf, struct err *err)
{
    bool nonlinear = false;
    double eta;
    start(bsdf, kind);
    return mitsuba_ior_ratio(object, MITSUBA_IOR_POLYPROPYLENE, &eta, err) &&
           mitsuba_boolean(object, "nonlinear", &nonlinear, err) &&
           set_number(bsdf, "eta", eta, object, err) &&
           set_number(bsdf, "nonlinear", nonlinear, object, err) &&
           mitsuba_material_pass(m, object, "diffuse_reflectance", 0.5, bsdf,
                                 "reflectance", err) &&
           mitsuba_material_pass(m, object, "specular_reflectance", 1.0, bsdf, "specular",
                                 err);
}

static bool plastic(struct mitsuba *m, struct mitsuba_node *object, int *index,
                    struct err *err)
{
    struct bsdf bsdf;
    return coated(m, object, "plastic", &bsdf, err) &&
           add_opaque(m, &bsdf, object, index, err);
}

static bool roughplastic(struct mitsuba *m, struct mitsuba_node *object, int *index,
                         struct err *err)
{
    struct bsdf bsdf;
    return coated(m, object, "roughplastic", &bsdf, err) &&
           set_roughness(m, object, &bsdf, err) &&
           add_opaque(m, &bsdf, object, index, err);
}

/* The diffuse front of a material; NULL if there is none. */
static const struct bsdf *diffuse_front(const struct bsdf *bsdf)
{
    if (text_equal(bsdf->type->name, "sides") && bsdf->child[0] && !bsdf->child[1])
        bsdf = bsdf->child[0];
    return text_equal(bsdf->type->name, "diffuse") ? bsdf : NULL;
}

/* Unlike plastic, Mitsuba's coat lets what the base throws back out at once, or loses it:
 * rho over pi in place of rho' / (1 - F_in rho'), so rho' is rho / (1 + F_in rho). */
static bool coat_diffuse(struct mitsuba *m, const struct mitsuba_node *object,
                         const struct bsdf *base, struct bsdf *coat, double eta,
                         struct err *err)
{
    const struct bsdf_param *at = bsdf_param_find(base->type, "reflectance");
    const double *rho = base->param + at->offset;
    double back = 1.0 - (1.0 - fresnel_dielectric_mean(eta)) / (eta * eta);
    if (!set_number(coat, "nonlinear", 1.0, object, err))
        return false;
    if (base->bound[0].texture) {
        log_note(&m->desc->log, &object->place,
                 "the coat over a texture reflects light back to it, which Mitsuba's "
                 "does not");
        return bsdf_bind(coat, "reflectance", base->bound[0].texture, &object->place,
                         err);
    }
    return set_rgb(coat, "reflectance",
                   rgb(rho[0] / (1.0 + back * rho[0]), rho[1] / (1.0 + back * rho[1]),
                       rho[2] / (1.0 + back * rho[2])),
                   object, err);
}

/* A coat over another material: here over a diffuse one. */
static bool add_coat(struct mitsuba *m, struct mitsuba_node *object, const char *kind,
                     int *index, struct err *err)
{
    struct bsdf bsdf;
    struct rgb absorbed = rgb_grey(0.0);
    double eta;
    start(&bsdf, kind);
    if (!mitsuba_mixture_first(m, object, index, err) ||
        !mitsuba_ior_ratio(object, MITSUBA_IOR_BK7, &eta, err) ||
        !mitsuba_colour(m, object, "sigma_a", &absorbed, err) ||
        !set_number(&bsdf, "eta", eta, object, err) ||
        !mitsuba_material_pass(m, object, "specular_reflectance", 1.0, &bsdf, "specular",
                               err) ||
        (bsdf.type->fixed_alpha && !set_roughness(m, object, &bsdf, err)))
        return false;
    if (!rgb_is_black(absorbed))
        log_note(&m->desc->log, &object->place, "coats do not absorb here");
    const struct bsdf *under = *index == MITSUBA_MATERIAL_NONE
                                   ? NULL
                                   : &m->desc->materials[*index];
    const struct bsdf *base = under ? diffuse_front(under) : NULL;
    if (!base) {
        log_note(&m->desc->log, &object->place,
                 "a coat over what is not diffuse is left out");
        return true;
    }
    const struct texture *bump = under->bump;
    if (!coat_diffuse(m, object, base, &bsdf, eta, err) ||
        !add_opaque(m, &bsdf, object, index, err))
        return false;
    m->desc->materials[*index].bump = bump; /* of the outermost node */
    return true;
}

static bool coating(struct mitsuba *m, struct mitsuba_node *object, int *index,
                    struct err *err)
{
    return add_coat(m, object, "plastic", index, err);
}

static bool roughcoating(struct mitsuba *m, struct mitsuba_node *object, int *index,
                         struct err *err)
{
    return add_coat(m, object, "roughplastic", index, err);
}

static bool nothing(struct mitsuba *m, struct mitsuba_node *object, int *index,
                    struct err *err)
{
    (void)m, (void)object, (void)err;
    *index = MITSUBA_MATERIAL_NONE;
    return true;
}

static const struct material_row {
    const char *type;
    bool (*read)(struct mitsuba *m, struct mitsuba_node *object, int *index,
                 struct err *err);
    const char *note; /* NULL: as Mitsuba means it */
} rows[] = {
    {"twosided", mitsuba_mixture_sides, NULL},
    {"diffuse", diffuse, NULL},
    {"dielectric", dielectric, NULL},
    {"roughdielectric", roughdielectric, NULL},
    {"conductor", conductor, NULL},
    {"roughconductor", roughconductor, NULL},
    {"null", nothing, NULL},
    {"plastic", plastic, NULL},
    {"roughplastic", roughplastic, NULL},
    {"thindielectric", thindielectric, NULL},
    {"phong", phong, NULL},
    {"mask", mitsuba_mixture_mask, NULL},
    {"bumpmap", mitsuba_mixture_bump, NULL},
    {"blendbsdf", mitsuba_mixture_blend, NULL},
    {"mixturebsdf", mitsuba_mixture_weighted, NULL},
    {"coating", coating, NULL},
    {"roughcoating", roughcoating, NULL},
    {"ward", diffuse_part, "its diffuse part"},
    {"principled", base_colour, "its diffuse part"},
    {"roughdiffuse", diffuse, "diffuse"},
    {"normalmap", mitsuba_mixture_first, "smooth"},
};

#define ROWS (sizeof rows / sizeof rows[0])

/* The row of an object's type; diffuse, with a note, if there is none. */
static const struct material_row *find_row(struct mitsuba *m,
                                           const struct mitsuba_node *object)
{
    const char *known[ROWS + 1] = {0};
    const struct material_row *fallback = NULL;
    for (size_t i = 0; i < ROWS; i++) {
        known[i] = rows[i].type;
        if (text_equal(mitsuba_type(object), rows[i].type))
            return &rows[i];
        if (rows[i].read == diffuse && !rows[i].note)
            fallback = &rows[i];
    }
    mitsuba_unknown(m, object, known, "taken as diffuse");
    return fallback;
}

bool mitsuba_material(struct mitsuba *m, struct mitsuba_node *object, int *index,
                      struct err *err)
{
    int *kept = &object->material[m->two_sided > 0];
    if (*kept != -1) {
        *index = *kept;
        return true;
    }
    const struct material_row *row = find_row(m, object);
    if (!mitsuba_enter(m, object, err))
        return false;
    bool read = row->read(m, object, index, err);
    mitsuba_leave(m, object);
    if (!read)
        return false;
    if (row->note)
        log_note(&m->desc->log, &object->place,
                 "bsdf \"%s\" is not read yet: taken as %s", row->type, row->note);
    mitsuba_report(m, object);
    *kept = *index;
    return true;
}

bool mitsuba_material_default(struct mitsuba *m, bool emitter, int *index,
                              struct err *err)
{
    struct bsdf bsdf;
    int *kept = &m->defaults[emitter];
    if (*kept < 0) {
        start(&bsdf, emitter ? "black" : "diffuse"); /* which is .5 */
        if (!bsdf_prepare(&bsdf, NULL, err))
            return false;
        *kept = scene_desc_add_material(m->desc, &bsdf);
    }
    *index = *kept;
    return true;
}

#include "import/mitsuba/mitsuba_material.h"

#include "base/text.h"
#include "import/mitsuba/mitsuba_bsdf.h"
#include "import/mitsuba/mitsuba_coat.h"
#include "import/mitsuba/mitsuba_ior.h"
#include "import/mitsuba/mitsuba_principled.h"
#include "import/mitsuba/mitsuba_property.h"
#include "math/warp.h"

#include <math.h>

#define SQRT_HALF 0.70710678118654752440

static bool add_diffuse(struct mitsuba *m, struct mitsuba_node *object,
                        const char *property, int *index, struct err *err)
{
    struct bsdf bsdf;
    struct mitsuba_value reflectance = {.value = rgb_grey(0.5)};
    if (!mitsuba_value(m, object, property, &reflectance, err))
        return false;
    if (!reflectance.texture && rgb_is_black(reflectance.value)) {
        mitsuba_bsdf_start(&bsdf, "black");
        return mitsuba_bsdf_add(m, &bsdf, object, index, err);
    }
    mitsuba_bsdf_start(&bsdf, "diffuse");
    return mitsuba_bsdf_set_value(&bsdf, "reflectance", &reflectance, object, err) &&
           mitsuba_bsdf_add_opaque(m, &bsdf, object, index, err);
}

static bool diffuse(struct mitsuba *m, struct mitsuba_node *object, int *index,
                    struct err *err)
{
    return add_diffuse(m, object, "reflectance", index, err);
}

static bool difftrans(struct mitsuba *m, struct mitsuba_node *object, int *index,
                      struct err *err)
{
    struct bsdf bsdf;
    mitsuba_bsdf_start(&bsdf, "translucent");
    return mitsuba_bsdf_set_number(&bsdf, "reflectance", 0.0, object, err) &&
           mitsuba_bsdf_pass(m, object, "transmittance", 0.5, &bsdf, "transmittance",
                             err) &&
           mitsuba_bsdf_add(m, &bsdf, object, index, err);
}

/* alpha is the slope of microfacets, 1/sqrt(2) of which Mitsuba takes as the sigma of
 * Oren and Nayar. */
static bool roughdiffuse(struct mitsuba *m, struct mitsuba_node *object, int *index,
                         struct err *err)
{
    struct bsdf bsdf;
    struct mitsuba_value alpha = {.value = rgb_grey(0.2)};
    struct texture_set *set = &m->desc->textures;
    bool fast = false;
    mitsuba_bsdf_start(&bsdf, "orennayar");
    if (!mitsuba_value(m, object, "alpha", &alpha, err) ||
        !mitsuba_boolean(object, "use_fast_approx", &fast, err))
        return false;
    if (alpha.texture)
        alpha.texture = texture_product(set, alpha.texture,
                                        texture_constant(set, rgb_grey(SQRT_HALF)));
    double sigma = fmin(SQRT_HALF * alpha.value.r, 0.5 * MATH_PI);
    return (alpha.texture
                ? bsdf_bind(&bsdf, "sigma", alpha.texture, &object->place, err)
                : mitsuba_bsdf_set_number(&bsdf, "sigma", sigma, object, err)) &&
           mitsuba_bsdf_set_number(&bsdf, "full", !fast, object, err) &&
           mitsuba_bsdf_pass(m, object, "reflectance", 0.5, &bsdf, "reflectance", err) &&
           mitsuba_bsdf_add_opaque(m, &bsdf, object, index, err);
}

static bool base_colour(struct mitsuba *m, struct mitsuba_node *object, int *index,
                        struct err *err)
{
    return add_diffuse(m, object, "base_color", index, err);
}

static bool phong(struct mitsuba *m, struct mitsuba_node *object, int *index,
                  struct err *err)
{
    struct bsdf bsdf;
    struct rgb exponent = rgb_grey(30.0);
    mitsuba_bsdf_start(&bsdf, "phong");
    return mitsuba_colour(m, object, "exponent", &exponent, err) &&
           mitsuba_bsdf_set_number(&bsdf, "exponent", exponent.r, object, err) &&
           mitsuba_bsdf_pass(m, object, "diffuse_reflectance", 0.5, &bsdf, "kd", err) &&
           mitsuba_bsdf_pass(m, object, "specular_reflectance", 0.2, &bsdf, "ks", err) &&
           mitsuba_bsdf_add_opaque(m, &bsdf, object, index, err);
}

/* The kinds that let light through share their parameters. */
static bool read_glass(struct mitsuba *m, struct mitsuba_node *object, const char *kind,
                       struct bsdf *bsdf, struct err *err)
{
    double eta;
    mitsuba_bsdf_start(bsdf, kind);
    return mitsuba_ior_ratio(object, MITSUBA_IOR_BK7, &eta, err) &&
           mitsuba_bsdf_set_number(bsdf, "eta", eta, object, err) &&
           mitsuba_bsdf_pass(m, object, "specular_reflectance", 1.0, bsdf, "reflectance",
                             err) &&
           mitsuba_bsdf_pass(m, object, "specular_transmittance", 1.0, bsdf,
                             "transmittance", err);
}

static bool dielectric(struct mitsuba *m, struct mitsuba_node *object, int *index,
                       struct err *err)
{
    struct bsdf bsdf;
    return read_glass(m, object, "dielectric", &bsdf, err) &&
           mitsuba_bsdf_add(m, &bsdf, object, index, err);
}

static bool roughdielectric(struct mitsuba *m, struct mitsuba_node *object, int *index,
                            struct err *err)
{
    struct bsdf bsdf;
    return read_glass(m, object, "roughdielectric", &bsdf, err) &&
           mitsuba_bsdf_roughness(m, object, &bsdf, err) &&
           mitsuba_bsdf_add(m, &bsdf, object, index, err);
}

static bool thindielectric(struct mitsuba *m, struct mitsuba_node *object, int *index,
                           struct err *err)
{
    struct bsdf bsdf;
    return read_glass(m, object, "thindielectric", &bsdf, err) &&
           mitsuba_bsdf_add(m, &bsdf, object, index, err);
}

static bool metal(struct mitsuba *m, struct mitsuba_node *object, bool rough, int *index,
                  struct err *err)
{
    struct rgb eta = rgb_grey(0.0), k = rgb_grey(1.0); /* which reflect all */
    bool perfect;
    struct bsdf bsdf;
    if (!mitsuba_ior_metal(m, object, &eta, &k, &perfect, err))
        return false;
    mitsuba_bsdf_start(&bsdf, rough     ? "roughconductor"
                              : perfect ? "mirror"
                                        : "conductor");
    if ((rough || !perfect) && (!mitsuba_bsdf_set_rgb(&bsdf, "eta", eta, object, err) ||
                                !mitsuba_bsdf_set_rgb(&bsdf, "k", k, object, err)))
        return false;
    return (!rough || mitsuba_bsdf_roughness(m, object, &bsdf, err)) &&
           mitsuba_bsdf_pass(m, object, "specular_reflectance", 1.0, &bsdf, "reflectance",
                             err) &&
           mitsuba_bsdf_add_opaque(m, &bsdf, object, index, err);
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
    mitsuba_bsdf_start(bsdf, kind);
    return mitsuba_ior_ratio(object, MITSUBA_IOR_POLYPROPYLENE, &eta, err) &&
           mitsuba_boolean(object, "nonlinear", &nonlinear, err) &&
           mitsuba_bsdf_set_number(bsdf, "eta", eta, object, err) &&
           mitsuba_bsdf_set_number(bsdf, "nonlinear", nonlinear, object, err) &&
           mitsuba_bsdf_pass(m, object, "diffuse_reflectance", 0.5, bsdf, "reflectance",
                             err) &&
           mitsuba_bsdf_pass(m, object, "specular_reflectance", 1.0, bsdf, "specular",
                             err);
}

static bool plastic(struct mitsuba *m, struct mitsuba_node *object, int *index,
                    struct err *err)
{
    struct bsdf bsdf;
    return coated(m, object, "plastic", &bsdf, err) &&
           mitsuba_bsdf_add_opaque(m, &bsdf, object, index, err);
}

static bool roughplastic(struct mitsuba *m, struct mitsuba_node *object, int *index,
                         struct err *err)
{
    struct bsdf bsdf;
    return coated(m, object, "roughplastic", &bsdf, err) &&
           mitsuba_bsdf_roughness(m, object, &bsdf, err) &&
           mitsuba_bsdf_add_opaque(m, &bsdf, object, index, err);
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
    /* One of the two; combine has read `most` materials, or fewer, that stand in it. */
    bool (*read)(struct mitsuba *m, struct mitsuba_node *object, int *index,
                 struct err *err);
    bool (*combine)(struct mitsuba *m, struct mitsuba_node *object,
                    const struct mitsuba_parts *parts, int *index, struct err *err);
    size_t most;
    bool two_sided;
    const char *note; /* NULL: as Mitsuba means it */
} rows[] = {
    {"diffuse", .read = diffuse}, /* first: what unknown ones are taken as */
    {"twosided", .combine = mitsuba_mixture_sides, .most = 2, .two_sided = true},
    {"dielectric", .read = dielectric},
    {"roughdielectric", .read = roughdielectric},
    {"conductor", .read = conductor},
    {"roughconductor", .read = roughconductor},
    {"null", .read = nothing},
    {"plastic", .read = plastic},
    {"roughplastic", .read = roughplastic},
    {"thindielectric", .read = thindielectric},
    {"phong", .read = phong},
    {"difftrans", .read = difftrans},
    {"roughdiffuse", .read = roughdiffuse},
    {"mask", .combine = mitsuba_mixture_mask, .most = 1},
    {"bumpmap", .combine = mitsuba_mixture_bump, .most = 1},
    {"normalmap", .combine = mitsuba_mixture_normals, .most = 1},
    {"blendbsdf", .combine = mitsuba_mixture_blend, .most = 2},
    {"mixturebsdf", .combine = mitsuba_mixture_weighted, .most = MITSUBA_PARTS_MAX},
    {"coating", .combine = mitsuba_coat_smooth, .most = 1},
    {"roughcoating", .combine = mitsuba_coat_rough, .most = 1},
    {"ward", .read = mitsuba_ward, .note = "a glossy coat over a diffuse base"},
    {"principled", .read = mitsuba_principled,
     .note = "rough metal, rough glass and a rough coat over a diffuse base"},
    {"principledthin", .read = base_colour, .note = "its diffuse part"},
    {"pplastic", .read = roughplastic, .note = "roughplastic: nothing is polarised"},
    {"hk", .read = diffuse, .note = "diffuse"},
    {"irawan", .read = diffuse, .note = "diffuse"},
    {"measured", .read = diffuse, .note = "diffuse"},
    {"hair", .read = diffuse, .note = "diffuse"},
    {"polarizer", .read = nothing, .note = "nothing: light passes it whole"},
    {"retarder", .read = nothing, .note = "nothing: light passes it whole"},
    {"circular", .read = nothing, .note = "nothing: light passes it whole"},
};

#define ROWS (sizeof rows / sizeof rows[0])

/* The row of an object's type; diffuse, with a note, if there is none. */
static const struct material_row *find_row(struct mitsuba *m,
                                           const struct mitsuba_node *object)
{
    const char *known[ROWS + 1] = {0};
    for (size_t i = 0; i < ROWS; i++) {
        known[i] = rows[i].type;
        if (text_equal(mitsuba_type(object), rows[i].type))
            return &rows[i];
    }
    mitsuba_unknown(m, object, known, "taken as diffuse");
    return &rows[0];
}

/* The first `most` materials that stand in the object, at least one. */
static bool read_parts(struct mitsuba *m, const struct mitsuba_node *object, size_t most,
                       struct mitsuba_parts *parts, struct err *err)
{
    parts->count = 0;
    for (size_t i = 0; i < object->child_count; i++) {
        struct mitsuba_node *target = mitsuba_resolve(m, object->children[i], err);
        if (!target)
            return false;
        if (!text_equal(target->name, "bsdf") || parts->count == most)
            continue;
        object->children[i]->used = true;
        if (!mitsuba_material(m, target, &parts->index[parts->count++], err))
            return false;
    }
    return parts->count > 0 ||
           err_set(err, ERR_VALUE, &object->place, "bsdf \"%s\" wants a <bsdf> in it",
                   mitsuba_type(object));
}

static bool read_combined(struct mitsuba *m, struct mitsuba_node *object,
                          const struct material_row *row, int *index, struct err *err)
{
    struct mitsuba_parts parts;
    m->two_sided += row->two_sided;
    bool read = read_parts(m, object, row->most, &parts, err);
    m->two_sided -= row->two_sided;
    return read && row->combine(m, object, &parts, index, err);
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
    bool read = row->read ? row->read(m, object, index, err)
                          : read_combined(m, object, row, index, err);
    mitsuba_leave(m, object);
    if (!read)
        return false;
    if (row->note)
        log_note(&m->desc->log, &object->place,
                 "bsdf \"%s\" is not read as it is: taken as %s", row->type, row->note);
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
        mitsuba_bsdf_start(&bsdf, emitter ? "black" : "diffuse"); /* which is .5 */
        if (!bsdf_prepare(&bsdf, NULL, err))
            return false;
        *kept = scene_desc_add_material(m->desc, &bsdf);
    }
    *index = *kept;
    return true;
}

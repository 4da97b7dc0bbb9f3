#include "import/mitsuba_scene.h"

#include "base/mem.h"
#include "base/text.h"

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

static bool add(struct mitsuba *m, struct bsdf *bsdf, const struct mitsuba_node *object,
                int *index, struct err *err)
{
    if (!bsdf_prepare(bsdf, &object->place, err))
        return false;
    *index = scene_desc_add_material(m->desc, bsdf);
    return true;
}

/* Here all surfaces that let nothing through have two equal sides. */
static void note_sides(struct mitsuba *m, const struct mitsuba_node *object)
{
    if (m->two_sided == 0)
        log_note(&m->desc->log, &object->place,
                 "%s without \"twosided\": its back, black in Mitsuba, scatters here as "
                 "its front does",
                 mitsuba_type(object));
}

static bool add_diffuse(struct mitsuba *m, struct mitsuba_node *object,
                        const char *property, double fallback, int *index,
                        struct err *err)
{
    struct bsdf bsdf;
    struct rgb reflectance = rgb_grey(fallback);
    if (!mitsuba_colour(m, object, property, &reflectance, err))
        return false;
    if (rgb_is_black(reflectance)) {
        start(&bsdf, "black");
        return add(m, &bsdf, object, index, err);
    }
    note_sides(m, object);
    start(&bsdf, "diffuse");
    return set_rgb(&bsdf, "reflectance", reflectance, object, err) &&
           add(m, &bsdf, object, index, err);
}

static bool diffuse(struct mitsuba *m, struct mitsuba_node *object, int *index,
                    struct err *err)
{
    return add_diffuse(m, object, "reflectance", 0.5, index, err);
}

static bool principled(struct mitsuba *m, struct mitsuba_node *object, int *index,
                       struct err *err)
{
    return add_diffuse(m, object, "base_color", 0.5, index, err);
}

static bool phong(struct mitsuba *m, struct mitsuba_node *object, int *index,
                  struct err *err)
{
    return add_diffuse(m, object, "diffuse_reflectance", 0.5, index, err);
}

/* alpha, or alpha_u and alpha_v; other microfacets than those of ours are noted. */
static bool set_roughness(struct mitsuba *m, struct mitsuba_node *object,
                          struct bsdf *bsdf, struct err *err)
{
    double alpha = 0.1, kind = 1.0;
    const char *name = "beckmann";
    if (!mitsuba_float(object, "alpha", &alpha, err) ||
        !mitsuba_string(object, "distribution", &name, err))
        return false;
    double u = alpha, v = alpha;
    if (!mitsuba_float(object, "alpha_u", &u, err) ||
        !mitsuba_float(object, "alpha_v", &v, err))
        return false;
    u = fmax(u, ALPHA_MIN);
    v = fmax(v, ALPHA_MIN);
    if (text_equal(name, "ggx"))
        kind = 0.0;
    else if (!text_equal(name, "beckmann"))
        log_note(&m->desc->log, &object->place,
                 "distribution \"%s\" is taken as \"beckmann\"", name);
    return bsdf_set(bsdf, "alpha_u", &u, 1, &object->place, err) &&
           bsdf_set(bsdf, "alpha_v", &v, 1, &object->place, err) &&
           bsdf_set(bsdf, "distribution", &kind, 1, &object->place, err);
}

static bool set_glass(struct mitsuba *m, struct mitsuba_node *object, double eta,
                      struct bsdf *bsdf, struct err *err)
{
    struct rgb reflectance = rgb_grey(1.0), transmittance = rgb_grey(1.0);
    return mitsuba_colour(m, object, "specular_reflectance", &reflectance, err) &&
           mitsuba_colour(m, object, "specular_transmittance", &transmittance, err) &&
           bsdf_set(bsdf, "eta", &eta, 1, &object->place, err) &&
           set_rgb(bsdf, "reflectance", reflectance, object, err) &&
           set_rgb(bsdf, "transmittance", transmittance, object, err);
}

static bool dielectric(struct mitsuba *m, struct mitsuba_node *object, int *index,
                       struct err *err)
{
    struct bsdf bsdf;
    double eta;
    start(&bsdf, "dielectric");
    return mitsuba_ior_ratio(m, object, &eta, err) &&
           set_glass(m, object, eta, &bsdf, err) && add(m, &bsdf, object, index, err);
}

static bool roughdielectric(struct mitsuba *m, struct mitsuba_node *object, int *index,
                            struct err *err)
{
    struct bsdf bsdf;
    double eta;
    start(&bsdf, "roughdielectric");
    return mitsuba_ior_ratio(m, object, &eta, err) &&
           set_glass(m, object, eta, &bsdf, err) &&
           set_roughness(m, object, &bsdf, err) && add(m, &bsdf, object, index, err);
}

/* A pane seen from afar: light goes straight on. */
static bool thindielectric(struct mitsuba *m, struct mitsuba_node *object, int *index,
                           struct err *err)
{
    struct bsdf bsdf;
    start(&bsdf, "dielectric");
    return set_glass(m, object, 1.0, &bsdf, err) && add(m, &bsdf, object, index, err);
}

static bool metal(struct mitsuba *m, struct mitsuba_node *object, bool rough, int *index,
                  struct err *err)
{
    struct rgb eta = rgb_grey(0.0), k = rgb_grey(0.0), reflectance = rgb_grey(1.0);
    bool perfect;
    struct bsdf bsdf;
    if (!mitsuba_ior_metal(m, object, &eta, &k, &perfect, err) ||
        !mitsuba_colour(m, object, "specular_reflectance", &reflectance, err))
        return false;
    note_sides(m, object);
    if (perfect && !rough) {
        start(&bsdf, "mirror");
    } else {
        start(&bsdf, rough ? "roughconductor" : "conductor");
        if (perfect)
            k = rgb_grey(1.0); /* no eta and some k reflect all */
        if (!set_rgb(&bsdf, "eta", eta, object, err) ||
            !set_rgb(&bsdf, "k", k, object, err) ||
            (rough && !set_roughness(m, object, &bsdf, err)))
            return false;
    }
    return set_rgb(&bsdf, "reflectance", reflectance, object, err) &&
           add(m, &bsdf, object, index, err);
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

/* A dielectric coat over a diffuse base, as far as substrate means it. */
static bool coated(struct mitsuba *m, struct mitsuba_node *object, double alpha,
                   int *index, struct err *err)
{
    struct bsdf bsdf;
    struct rgb kd = rgb_grey(0.5), ks = rgb_grey(1.0);
    double eta;
    if (!mitsuba_ior_ratio(m, object, &eta, err) ||
        !mitsuba_colour(m, object, "diffuse_reflectance", &kd, err) ||
        !mitsuba_colour(m, object, "specular_reflectance", &ks, err))
        return false;
    double f0 = (eta - 1.0) / (eta + 1.0);
    note_sides(m, object);
    start(&bsdf, "substrate");
    return set_rgb(&bsdf, "kd", kd, object, err) &&
           set_rgb(&bsdf, "ks", rgb_scale(ks, f0 * f0), object, err) &&
           bsdf_set(&bsdf, "alpha", &alpha, 1, &object->place, err) &&
           add(m, &bsdf, object, index, err);
}

static bool plastic(struct mitsuba *m, struct mitsuba_node *object, int *index,
                    struct err *err)
{
    return coated(m, object, 1e-3, index, err);
}

static bool roughplastic(struct mitsuba *m, struct mitsuba_node *object, int *index,
                         struct err *err)
{
    double alpha = 0.1;
    return mitsuba_float(object, "alpha", &alpha, err) &&
           coated(m, object, fmax(alpha, 1e-3), index, err);
}

/* Of those that change or mix other materials: the first that it holds. */
static bool nested(struct mitsuba *m, struct mitsuba_node *object, int *index,
                   struct err *err)
{
    struct mitsuba_node *inner;
    if (!mitsuba_child(m, object, "bsdf", &inner, err))
        return false;
    if (!inner)
        return err_set(err, ERR_VALUE, &object->place, "bsdf \"%s\" wants a <bsdf> in it",
                       mitsuba_type(object));
    return mitsuba_material(m, inner, index, err);
}

static bool twosided(struct mitsuba *m, struct mitsuba_node *object, int *index,
                     struct err *err)
{
    m->two_sided++;
    bool read = nested(m, object, index, err);
    m->two_sided--;
    return read;
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
    {"twosided", twosided, NULL},
    {"diffuse", diffuse, NULL},
    {"dielectric", dielectric, NULL},
    {"roughdielectric", roughdielectric, NULL},
    {"conductor", conductor, NULL},
    {"roughconductor", roughconductor, NULL},
    {"null", nothing, NULL},
    {"plastic", plastic, "substrate"},
    {"roughplastic", roughplastic, "substrate"},
    {"thindielectric", thindielectric, "clear, without reflection"},
    {"phong", phong, "its diffuse part"},
    {"ward", phong, "its diffuse part"},
    {"principled", principled, "its diffuse part"},
    {"roughdiffuse", diffuse, "diffuse"},
    {"mask", nested, "opaque"},
    {"bumpmap", nested, "smooth"},
    {"normalmap", nested, "smooth"},
    {"coating", nested, "what it coats"},
    {"roughcoating", nested, "what it coats"},
    {"blendbsdf", nested, "the first that it blends"},
    {"mixturebsdf", nested, "the first that it mixes"},
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
    if (object->material != -1) {
        *index = object->material;
        return true;
    }
    const struct material_row *row = find_row(m, object);
    if (!mitsuba_enter(object, err))
        return false;
    bool read = row->read(m, object, index, err);
    mitsuba_leave(object);
    if (!read)
        return false;
    if (row->note)
        log_note(&m->desc->log, &object->place,
                 "bsdf \"%s\" is not read yet: taken as %s", row->type, row->note);
    mitsuba_report(m, object);
    object->material = *index;
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

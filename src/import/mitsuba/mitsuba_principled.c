#include "import/mitsuba/mitsuba_principled.h"

#include "import/mitsuba/mitsuba_bsdf.h"
#include "import/mitsuba/mitsuba_property.h"

#include <math.h>

#define ALPHA_LEAST 1e-3 /* Mitsuba's principled */
#define ETA_LEAST   1.003

/* What of "principled" is read. */
struct principled {
    struct mitsuba_value base; /* colour of all parts */
    struct mitsuba_value metallic;
    double glass; /* spec_trans */
    double eta;
    double alpha[2];
};

/* The index that reflects this much straight on. */
static double eta_of(double reflectance)
{
    double root = sqrt(fmin(fmax(reflectance, 0.0), 0.98));
    return (1.0 + root) / (1.0 - root);
}

/* A number, where a texture has its mean. */
static bool number(struct mitsuba *m, struct mitsuba_node *object, const char *name,
                   double *value, struct err *err)
{
    struct rgb read = rgb_grey(*value);
    if (!mitsuba_colour(m, object, name, &read, err))
        return false;
    *value = read.r;
    return true;
}

static bool read_numbers(struct mitsuba *m, struct mitsuba_node *object,
                         struct principled *p, struct err *err)
{
    double roughness = 0.5, anisotropic = 0.0, specular = 0.5;
    if (!number(m, object, "spec_trans", &p->glass, err) ||
        !number(m, object, "roughness", &roughness, err) ||
        !number(m, object, "anisotropic", &anisotropic, err) ||
        !number(m, object, "specular", &specular, err))
        return false;
    p->eta = eta_of(0.08 * specular);
    if (!mitsuba_float(object, "eta", &p->eta, err))
        return false;
    double aspect = sqrt(1.0 - 0.9 * fmin(fmax(anisotropic, 0.0), 1.0));
    p->alpha[0] = fmin(fmax(roughness * roughness / aspect, ALPHA_LEAST), 1.0);
    p->alpha[1] = fmin(fmax(roughness * roughness * aspect, ALPHA_LEAST), 1.0);
    p->glass = fmin(fmax(p->glass, 0.0), 1.0);
    p->eta = fmin(fmax(p->eta, ETA_LEAST), 20.0);
    return true;
}

/* GGX of these roughnesses; the part, prepared. */
static const struct bsdf *finish_part(struct mitsuba *m, const struct principled *p,
                                      struct bsdf *bsdf,
                                      const struct mitsuba_node *object, struct err *err)
{
    return mitsuba_bsdf_set_number(bsdf, "alpha_u", p->alpha[0], object, err) &&
                   mitsuba_bsdf_set_number(bsdf, "alpha_v", p->alpha[1], object, err) &&
                   bsdf_prepare(bsdf, &object->place, err)
               ? scene_desc_add_part(m->desc, bsdf)
               : NULL;
}

static const struct bsdf *coat_part(struct mitsuba *m, const struct principled *p,
                                    const struct mitsuba_node *object, struct err *err)
{
    struct bsdf bsdf;
    mitsuba_bsdf_start(&bsdf, "roughplastic");
    return mitsuba_bsdf_set_value(&bsdf, "reflectance", &p->base, object, err) &&
                   mitsuba_bsdf_set_number(&bsdf, "eta", p->eta, object, err)
               ? finish_part(m, p, &bsdf, object, err)
               : NULL;
}

static const struct bsdf *glass_part(struct mitsuba *m, const struct principled *p,
                                     const struct mitsuba_node *object, struct err *err)
{
    struct bsdf bsdf;
    mitsuba_bsdf_start(&bsdf, "roughdielectric");
    return mitsuba_bsdf_set_value(&bsdf, "transmittance", &p->base, object, err) &&
                   mitsuba_bsdf_set_number(&bsdf, "eta", p->eta, object, err)
               ? finish_part(m, p, &bsdf, object, err)
               : NULL;
}

/* The base colour is what the metal reflects straight on; a texture tints one that
 * reflects nearly all. */
static const struct bsdf *metal_part(struct mitsuba *m, const struct principled *p,
                                     const struct mitsuba_node *object, struct err *err)
{
    struct bsdf bsdf;
    const struct rgb c = p->base.value;
    bool textured = p->base.texture != NULL;
    struct rgb eta = textured ? rgb_grey(0.0)
                              : rgb(eta_of(c.r), eta_of(c.g), eta_of(c.b));
    mitsuba_bsdf_start(&bsdf, "roughconductor");
    return mitsuba_bsdf_set_rgb(&bsdf, "eta", eta, object, err) &&
                   mitsuba_bsdf_set_rgb(&bsdf, "k", rgb_grey(textured), object, err) &&
                   (!textured ||
                    mitsuba_bsdf_set_value(&bsdf, "reflectance", &p->base, object, err))
               ? finish_part(m, p, &bsdf, object, err)
               : NULL;
}

/* first (1 - weight) + second weight; either alone where nothing is left of the other. */
static bool blend(const struct mitsuba_value *weight, const struct bsdf *first,
                  const struct bsdf *second, struct bsdf *out,
                  const struct mitsuba_node *object, struct err *err)
{
    const struct bsdf *only = !first ? second : !second ? first : NULL;
    if (only) {
        *out = *only;
        return true;
    }
    mitsuba_bsdf_start(out, "blend");
    out->child[0] = first;
    out->child[1] = second;
    return mitsuba_bsdf_set_value(out, "weight", weight, object, err) &&
           bsdf_prepare(out, &object->place, err);
}

bool mitsuba_principled(struct mitsuba *m, struct mitsuba_node *object, int *index,
                        struct err *err)
{
    struct principled p = {.base = {.value = rgb_grey(0.5)}};
    if (!mitsuba_value(m, object, "base_color", &p.base, err) ||
        !mitsuba_value(m, object, "metallic", &p.metallic, err) ||
        !read_numbers(m, object, &p, err))
        return false;
    double metallic = p.metallic.texture ? 0.5 : fmin(p.metallic.value.r, 1.0);
    const struct mitsuba_value glassy = {.value = rgb_grey(p.glass)};
    p.metallic.value = rgb_grey(metallic);
    const struct bsdf *coat = NULL, *glass = NULL, *metal = NULL;
    if ((metallic < 1.0 && p.glass < 1.0 && !(coat = coat_part(m, &p, object, err))) ||
        (metallic < 1.0 && p.glass > 0.0 && !(glass = glass_part(m, &p, object, err))) ||
        (metallic > 0.0 && !(metal = metal_part(m, &p, object, err))))
        return false;
    struct bsdf under, all;
    const struct bsdf *below = NULL;
    if (coat || glass) {
        if (!blend(&glassy, coat, glass, &under, object, err))
            return false;
        below = scene_desc_add_part(m->desc, &under);
    }
    if (!blend(&p.metallic, below, metal, &all, object, err))
        return false;
    return glass ? mitsuba_bsdf_add(m, &all, object, index, err)
                 : mitsuba_bsdf_add_opaque(m, &all, object, index, err);
}

bool mitsuba_ward(struct mitsuba *m, struct mitsuba_node *object, int *index,
                  struct err *err)
{
    static const char *const ignored[] = {"variant", NULL};
    struct bsdf bsdf;
    double alpha[2] = {0.1, 0.1};
    mitsuba_bsdf_start(&bsdf, "substrate");
    mitsuba_ignore(object, ignored);
    if (!number(m, object, "alpha", &alpha[0], err))
        return false;
    alpha[1] = alpha[0];
    return number(m, object, "alpha_u", &alpha[0], err) &&
           number(m, object, "alpha_v", &alpha[1], err) &&
           mitsuba_bsdf_set_number(&bsdf, "alpha_u", alpha[0], object, err) &&
           mitsuba_bsdf_set_number(&bsdf, "alpha_v", alpha[1], object, err) &&
           mitsuba_bsdf_pass(m, object, "diffuse_reflectance", 0.5, &bsdf, "kd", err) &&
           mitsuba_bsdf_pass(m, object, "specular_reflectance", 0.2, &bsdf, "ks", err) &&
           mitsuba_bsdf_add_opaque(m, &bsdf, object, index, err);
}

/* Materials that let light through diffusely, of all versions. */
#include "import/pbrt/pbrt_material_tables.h"

#include "import/pbrt/pbrt_bsdf.h"
#include "surface/microfacet.h"

#include <math.h>

/* What the two lobes of a translucent surface scatter. */
struct lobes {
    struct pbrt_value reflects, transmits;
};

static struct lobes times(struct pbrt *p, const struct lobes *lobes,
                          const struct pbrt_value *by)
{
    return (struct lobes){pbrt_bsdf_product(p, &lobes->reflects, by),
                          pbrt_bsdf_product(p, &lobes->transmits, by)};
}

/* The largest component; a texture's is taken as 1. */
static double bound(const struct pbrt_value *value)
{
    return value->texture ? 1.0 : rgb_max(value->value);
}

static struct pbrt_value at_most_1(struct pbrt_value value)
{
    value.value = rgb(fmin(value.value.r, 1.0), fmin(value.value.g, 1.0),
                      fmin(value.value.b, 1.0));
    return value;
}

static bool set_lobes(struct pbrt *p, struct bsdf *bsdf, const struct lobes *lobes,
                      double factor, const struct place *at, struct err *err)
{
    struct pbrt_value reflects = pbrt_bsdf_scaled(p, &lobes->reflects, factor);
    struct pbrt_value transmits = pbrt_bsdf_scaled(p, &lobes->transmits, factor);
    reflects = at_most_1(reflects);
    transmits = at_most_1(transmits);
    return pbrt_bsdf_set_value(bsdf, "reflectance", &reflects, at, err) &&
           pbrt_bsdf_set_value(bsdf, "transmittance", &transmits, at, err);
}

bool pbrt_material_diffuse_transmission(struct pbrt *p, const struct place *at,
                                        struct bsdf *bsdf, struct err *err)
{
    struct lobes lobes = {.reflects = {.value = rgb_grey(0.25)},
                          .transmits = {.value = rgb_grey(0.25)}};
    double scale = 1.0;
    return pbrt_colour_value(p, "reflectance", &lobes.reflects, err) &&
           pbrt_colour_value(p, "transmittance", &lobes.transmits, err) &&
           pbrt_params_float(&p->params, "scale", &scale, err) &&
           pbrt_bsdf_start(bsdf, "translucent", at, err) &&
           set_lobes(p, bsdf, &lobes, fmax(scale, 0.0), at, err);
}

bool pbrt_material_matte_translucent(struct pbrt *p, const struct place *at,
                                     struct bsdf *bsdf, struct err *err)
{
    struct lobes lobes = {.reflects = {.value = rgb_grey(1.0)},
                          .transmits = {.value = rgb_grey(1.0)}};
    bool conserves = false;
    double sigma = 0.0;
    if (!pbrt_colour_value(p, "Kr", &lobes.reflects, err) ||
        !pbrt_colour_value(p, "Kt", &lobes.transmits, err) ||
        !pbrt_params_bool(&p->params, "energyconserving", &conserves, err) ||
        !pbrt_colour_float(p, "sigma", &sigma, NULL, err))
        return false;
    if (sigma != 0.0)
        log_note(&p->desc->log, at,
                 "mattetranslucent with a sigma is taken as Lambertian");
    if (conserves) {
        struct pbrt_value left = pbrt_bsdf_complement(p, &lobes.reflects);
        lobes.transmits = pbrt_bsdf_product(p, &lobes.transmits, &left);
    }
    return pbrt_bsdf_start(bsdf, "translucent", at, err) &&
           set_lobes(p, bsdf, &lobes, 1.0, at, err);
}

/* Read from v3's translucent: both lobes under Kd, and under Ks those of rough glass. */
struct translucent {
    struct lobes diffuse, glossy;
    struct pbrt_roughness roughness;
};

static bool read_translucent(struct pbrt *p, struct translucent *t, struct err *err)
{
    struct pbrt_value kd = {.value = rgb_grey(0.25)}, ks = {.value = rgb_grey(0.25)};
    struct lobes sides = {.reflects = {.value = rgb_grey(0.5)},
                          .transmits = {.value = rgb_grey(0.5)}};
    if (!pbrt_colour_value(p, "Kd", &kd, err) || !pbrt_colour_value(p, "Ks", &ks, err) ||
        !pbrt_colour_value(p, "reflect", &sides.reflects, err) ||
        !pbrt_colour_value(p, "transmit", &sides.transmits, err) ||
        !pbrt_bsdf_roughness(p, "", "roughness", 0.1, microfacet_roughness_to_alpha,
                             &t->roughness, err))
        return false;
    t->diffuse = times(p, &sides, &kd);
    t->glossy = times(p, &sides, &ks);
    return true;
}

/* The kind with the two lobes, each times the factor; the glossy ones are rough. */
static bool make_part(struct pbrt *p, const char *kind, const struct lobes *lobes,
                      double factor, const struct pbrt_roughness *roughness,
                      const struct place *at, struct bsdf *part, struct err *err)
{
    return pbrt_bsdf_start(part, kind, at, err) &&
           set_lobes(p, part, lobes, factor, at, err) &&
           (!roughness || pbrt_bsdf_set_roughness(part, roughness, at, err));
}

/* v3 adds the two pairs of lobes. A blend takes shares of its parts, so each is brighter
 * by the inverse of its share; shares in the ratio of the largest colours keep both
 * within 1, if their sum is. */
bool pbrt_material_translucent(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                               struct err *err)
{
    struct translucent t;
    if (!read_translucent(p, &t, err))
        return false;
    double diffuse = fmax(bound(&t.diffuse.reflects), bound(&t.diffuse.transmits));
    double glossy = fmax(bound(&t.glossy.reflects), bound(&t.glossy.transmits));
    if (diffuse == 0.0 && glossy == 0.0)
        return pbrt_bsdf_start(bsdf, "black", at, err);
    if (glossy == 0.0)
        return make_part(p, "translucent", &t.diffuse, 1.0, NULL, at, bsdf, err);
    if (diffuse == 0.0)
        return make_part(p, "roughdielectric", &t.glossy, 1.0, &t.roughness, at, bsdf,
                         err);
    struct bsdf parts[2];
    double sum = diffuse + glossy, share = glossy / sum;
    if (!make_part(p, "translucent", &t.diffuse, 1.0 / (1.0 - share), NULL, at, &parts[0],
                   err) ||
        !make_part(p, "roughdielectric", &t.glossy, 1.0 / share, &t.roughness, at,
                   &parts[1], err) ||
        !bsdf_prepare(&parts[0], at, err) || !bsdf_prepare(&parts[1], at, err) ||
        !pbrt_bsdf_start(bsdf, "blend", at, err))
        return false;
    for (int i = 0; i < 2; i++)
        bsdf->child[i] = scene_desc_add_part(p->desc, &parts[i]);
    return bsdf_set(bsdf, "weight", &share, 1, at, err);
}

/* Materials that LuxRender has beside those of pbrt v3. */
#include "import/pbrt/pbrt_material_tables.h"

#include "import/pbrt/pbrt_bsdf.h"

static bool glossy(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                   struct err *err)
{
    static const char *const ignored[] = {"multibounce", "index", NULL};
    pbrt_params_ignore(&p->params, ignored);
    return pbrt_material_v3_substrate(p, at, bsdf, err);
}

/* Glass with the index of the last named volume; architectural glass does not refract. */
static bool glass2(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                   struct err *err)
{
    static const char *const ignored[] = {"dispersion", NULL};
    bool thin = false;
    pbrt_params_ignore(&p->params, ignored);
    return pbrt_params_bool(&p->params, "architectural", &thin, err) &&
           pbrt_bsdf_start(bsdf, thin ? "thindielectric" : "dielectric", at, err) &&
           bsdf_set(bsdf, "eta", &p->lux_index, 1, at, err);
}

static bool carpaint(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                     struct err *err)
{
    static const char *const ignored[] = {"name", NULL};
    static const double alpha = 0.1;
    pbrt_params_ignore(&p->params, ignored);
    log_note(&p->desc->log, at, "carpaint is taken as a glossy coat over dark blue");
    return pbrt_bsdf_start(bsdf, "substrate", at, err) &&
           pbrt_bsdf_set_rgb(bsdf, "kd", rgb(0.005, 0.02, 0.1), at, err) &&
           pbrt_bsdf_set_rgb(bsdf, "ks", rgb_grey(0.1), at, err) &&
           bsdf_set(bsdf, "alpha", &alpha, 1, at, err);
}

const struct pbrt_material_row pbrt_material_lux[] = {
    {"glossy", glossy},     {"glass2", glass2},
    {"carpaint", carpaint}, {"mattetranslucent", pbrt_material_matte_translucent},
    {NULL, NULL},
};

#include "import/pbrt/pbrt_mixture.h"

#include "import/pbrt/pbrt_bsdf.h"

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
bool pbrt_mixture_mix(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                      struct err *err)
{
    const struct pbrt_param *names = pbrt_params_find(&p->params, "materials",
                                                      PBRT_STRING);
    struct pbrt_value amount = {.value = rgb_grey(0.5)};
    bool first = !p->lux;
    return pbrt_bsdf_start(bsdf, "blend", at, err) &&
           (names ? mixed_list(p, names, bsdf, err)
                  : mixed_part(p, "namedmaterial1", &bsdf->child[first], err) &&
                        mixed_part(p, "namedmaterial2", &bsdf->child[!first], err)) &&
           (p->lux || names ? pbrt_colour_float_value(p, "amount", &amount, err)
                            : pbrt_colour_value(p, "amount", &amount, err)) &&
           pbrt_bsdf_set_value(bsdf, "weight", &amount, at, err);
}

bool pbrt_mixture_masked(struct pbrt *p, int material, const struct texture *alpha,
                         int *index, struct err *err)
{
    struct bsdf through, mask;
    if (!pbrt_bsdf_start(&through, "null", NULL, err) ||
        !bsdf_prepare(&through, NULL, err) || !pbrt_bsdf_start(&mask, "blend", NULL, err))
        return false;
    mask.child[0] = scene_desc_add_part(p->desc, &through);
    mask.child[1] = scene_desc_add_part(p->desc, &p->desc->materials[material]);
    mask.relief = mask.child[1]->relief;
    if (!bsdf_bind(&mask, "weight", alpha, &p->params.place, err) ||
        !bsdf_prepare(&mask, &p->params.place, err))
        return false;
    *index = scene_desc_add_material(p->desc, &mask);
    return true;
}

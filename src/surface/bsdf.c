#include "surface/bsdf.h"

#include "base/mem.h"
#include "base/text.h"
#include "surface/bsdf_kind.h"

const struct bsdf_type *const bsdf_types[] = {
    &bsdf_type_diffuse,         &bsdf_type_black,      &bsdf_type_mirror,
    &bsdf_type_conductor,       &bsdf_type_dielectric, &bsdf_type_roughconductor,
    &bsdf_type_roughdielectric, &bsdf_type_substrate,  NULL,
};

const struct bsdf_type *bsdf_find(const char *name)
{
    for (int i = 0; bsdf_types[i]; i++)
        if (text_equal(bsdf_types[i]->name, name))
            return bsdf_types[i];
    return NULL;
}

void bsdf_init(struct bsdf *bsdf, const struct bsdf_type *type)
{
    *bsdf = (struct bsdf){.type = type};
    for (const struct bsdf_param *p = type->params; p->name; p++)
        for (int i = 0; i < p->count; i++)
            bsdf->param[p->offset + i] = p->fallback[i];
}

const struct bsdf_param *bsdf_param_find(const struct bsdf_type *type, const char *name)
{
    for (const struct bsdf_param *p = type->params; p->name; p++)
        if (text_equal(p->name, name))
            return p;
    return NULL;
}

static bool unknown_param(const struct bsdf_type *type, const char *name,
                          const struct place *at, struct err *err)
{
    const char *names[BSDF_PARAMS + 1] = {NULL};
    struct text list = {0};
    for (int i = 0; type->params[i].name; i++) {
        names[i] = type->params[i].name;
        text_append(&list, "%s%s", i ? ", " : "", names[i]);
    }
    const char *near = text_nearest(name, names);
    err_set(err, ERR_VALUE, at, "%s has no parameter '%s'%s%s%s; it takes: %s",
            type->name, name, near ? " (did you mean '" : "", near ? near : "",
            near ? "'?)" : "", names[0] ? list.data : "none");
    mem_free(list.data);
    return false;
}

bool bsdf_set(struct bsdf *bsdf, const char *name, const double *values, int count,
              const struct place *at, struct err *err)
{
    const char *kind = bsdf->type->name;
    const struct bsdf_param *p = bsdf_param_find(bsdf->type, name);
    if (!p)
        return unknown_param(bsdf->type, name, at, err);
    if (count != p->count && count != 1)
        return err_set(err, ERR_VALUE, at, "%s: %s takes %s, not %d numbers", kind, name,
                       p->count == 1 ? "1 number" : "1 number or 3 (r, g, b)", count);
    for (int i = 0; i < count; i++)
        if (!(values[i] >= p->min && values[i] <= p->max))
            return err_set(err, ERR_VALUE, at, "%s: %s = %g must be from %g to %g", kind,
                           name, values[i], p->min, p->max);
    for (int i = 0; i < p->count; i++)
        bsdf->param[p->offset + i] = values[count == 1 ? 0 : i];
    return true;
}

bool bsdf_kind_eval_nothing(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                            enum transport mode, struct bsdf_value *out)
{
    (void)bsdf, (void)wo, (void)wi, (void)mode;
    return bsdf_kind_no_value(out);
}

bool bsdf_kind_mirror_sample(struct vec3 wo, struct rgb weight, double pdf,
                             struct bsdf_sample *out)
{
    if (wo.z == 0.0f || pdf <= 0.0 || rgb_is_black(weight))
        return bsdf_kind_no_sample(out);
    *out = (struct bsdf_sample){.wi = vec3(-wo.x, -wo.y, wo.z),
                                .weight = weight,
                                .pdf = pdf,
                                .pdf_rev = pdf,
                                .delta = true};
    return true;
}

bool bsdf_kind_prepare_microfacet(struct bsdf *bsdf, int alpha, int distribution,
                                  int derived, const struct place *at, struct err *err)
{
    double which = bsdf->param[distribution];
    if (which != MICROFACET_GGX && which != MICROFACET_BECKMANN)
        return err_set(err, ERR_VALUE, at,
                       "%s: distribution must be 0 (GGX) or 1 (Beckmann), not %g",
                       bsdf->type->name, which);
    struct microfacet mf = bsdf_kind_roughness(bsdf->param + alpha);
    bsdf->param[derived] = mf.alpha_u;
    bsdf->param[derived + 1] = mf.alpha_v;
    bsdf->param[derived + 2] = which;
    if (mf.alpha_u != mf.alpha_v)
        bsdf->flags |= BSDF_ANISOTROPIC;
    return true;
}

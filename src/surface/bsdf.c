#include "surface/bsdf.h"

#include "base/mem.h"
#include "base/text.h"
#include "surface/bsdf_kind.h"
#include "surface/direction.h"

const struct bsdf_type *const bsdf_types[] = {
    &bsdf_type_diffuse,
    &bsdf_type_black,
    &bsdf_type_mirror,
    &bsdf_type_conductor,
    &bsdf_type_dielectric,
    &bsdf_type_roughconductor,
    &bsdf_type_roughdielectric,
    &bsdf_type_substrate,
    &bsdf_type_null,
    &bsdf_type_thindielectric,
    &bsdf_type_plastic,
    &bsdf_type_roughplastic,
    &bsdf_type_phong,
    &bsdf_type_uber,
    &bsdf_type_translucent,
    &bsdf_type_orennayar,
    &bsdf_type_principled,
    &bsdf_type_blend,
    &bsdf_type_sides,
    NULL,
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

bool bsdf_bind(struct bsdf *bsdf, const char *name, const struct texture *texture,
               const struct place *at, struct err *err)
{
    const struct bsdf_param *p = bsdf_param_find(bsdf->type, name);
    if (!p)
        return unknown_param(bsdf->type, name, at, err);
    if (text_equal(name, "eta") || text_equal(name, "distribution"))
        return err_set(err, ERR_UNSUPPORTED, at, "%s: %s takes no texture",
                       bsdf->type->name, name);
    int i = 0;
    while (i < BSDF_TEXTURES && bsdf->bound[i].texture)
        i++;
    if (i == BSDF_TEXTURES)
        return err_set(err, ERR_UNSUPPORTED, at, "%s: more than %d textured parameters",
                       bsdf->type->name, BSDF_TEXTURES);
    bsdf->bound[i] = (struct bsdf_binding){texture, p};
    /* The common part uses a middle value of the texture, so that no lobe is excluded. */
    for (int k = 0; k < p->count; k++)
        bsdf->param[p->offset + k] = fmin(fmax(0.5, p->min), p->max);
    return true;
}

/* Nodes of a material that a texture touches: each takes a place of struct bsdf_nodes. */
static int count_textured(const struct bsdf *bsdf)
{
    int count = 1;
    if (!(bsdf->flags & BSDF_TEXTURED))
        return 0;
    for (int i = 0; i < 2; i++)
        count += bsdf->child[i] ? count_textured(bsdf->child[i]) : 0;
    return count;
}

/* Blends of blends that share their parts double the work with each level. */
static bool count_nodes(struct bsdf *bsdf, const struct place *at, struct err *err)
{
    bsdf->size = 1;
    for (int i = 0; i < 2; i++)
        bsdf->size += bsdf->child[i] ? bsdf->child[i]->size : 0;
    if (bsdf->size > BSDF_SIZE_MAX)
        return err_set(err, ERR_UNSUPPORTED, at,
                       "%s: a blend of blends with %d materials in all, the limit is %d",
                       bsdf->type->name, bsdf->size, BSDF_SIZE_MAX);
    return true;
}

bool bsdf_prepare(struct bsdf *bsdf, const struct place *at, struct err *err)
{
    if (!count_nodes(bsdf, at, err) || !bsdf->type->prepare(bsdf, at, err))
        return false;
    bool textured = bsdf->bound[0].texture != NULL;
    for (int i = 0; i < BSDF_TEXTURES && bsdf->bound[i].texture; i++)
        if (bsdf_kind_is_axis(bsdf->bound[i].param->name))
            bsdf->flags |= BSDF_ANISOTROPIC; /* the axes may differ somewhere */
    for (int i = 0; i < 2; i++)
        textured = textured || (bsdf->child[i] && bsdf->child[i]->flags & BSDF_TEXTURED);
    if (textured)
        bsdf->flags |= BSDF_TEXTURED;
    if (count_textured(bsdf) > BSDF_NODES)
        return err_set(err, ERR_UNSUPPORTED, at,
                       "%s: a blend of more than %d textured materials", bsdf->type->name,
                       BSDF_NODES);
    return true;
}

bool bsdf_kind_is_axis(const char *param)
{
    static const char *const names[] = {"alpha_u", "alpha_v", "anisotropic"};
    for (int i = 0; i < 3; i++)
        if (text_equal(param, names[i]))
            return true;
    return false;
}

static void fill_bound(struct bsdf *bsdf, const struct bsdf *material,
                       const struct texture_point *at)
{
    for (int i = 0; i < BSDF_TEXTURES && material->bound[i].texture; i++) {
        const struct bsdf_param *p = material->bound[i].param;
        struct rgb value = texture_eval(material->bound[i].texture, at);
        double *to = bsdf->param + p->offset;
        to[0] = p->count == 3 ? value.r : rgb_luminance(value);
        if (p->count == 3) {
            to[1] = value.g;
            to[2] = value.b;
        }
        for (int k = 0; k < p->count; k++)
            to[k] = fmin(fmax(to[k], p->min), p->max);
    }
}

const struct bsdf *bsdf_at(const struct bsdf *material, const struct texture_point *at,
                           struct bsdf_nodes *nodes)
{
    struct bsdf *bsdf = &nodes->node[nodes->count++];
    bsdf->type = material->type;
    for (int i = 0; i < 2; i++)
        bsdf->child[i] = material->child[i];
    for (int i = 0; i < material->type->places; i++)
        bsdf->param[i] = material->param[i];
    bsdf->bound[0].texture = NULL;
    fill_bound(bsdf, material, at);
    for (int i = 0; i < 2; i++)
        if (bsdf->child[i] && bsdf->child[i]->flags & BSDF_TEXTURED)
            bsdf->child[i] = bsdf_at(bsdf->child[i], at, nodes);
    bsdf->type->prepare(bsdf, NULL, NULL); /* cannot fail: see bsdf_bind */
    return bsdf;
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
    /* Mirror direction [Pharr16, section 8.2.2]. */
    *out = (struct bsdf_sample){.wi = vec3(-wo.x, -wo.y, wo.z),
                                .weight = weight,
                                .pdf = pdf,
                                .pdf_rev = pdf,
                                .delta = true};
    return true;
}

bool bsdf_kind_refract_sample(struct vec3 wo, double eta, double cos_t, struct rgb weight,
                              double pdf, enum transport mode, struct bsdf_sample *out)
{
    struct direction o = direction_from(wo);
    /* Snell's law [Pharr16, section 8.2.3]. */
    struct direction i = {-o.x / eta, -o.y / eta, copysign(cos_t, -o.z)};
    struct vec3 wi = direction_to_vec3(i);
    if (wi.z == 0.0f || pdf <= 0.0 || rgb_is_black(weight))
        return bsdf_kind_no_sample(out);
    /* Radiance scales by the change of solid angle [Veach97, section 5.2]. */
    if (mode == TRANSPORT_RADIANCE)
        weight = rgb_scale(weight, 1.0 / (eta * eta));
    double jacobian = fabs(o.z) / (cos_t * eta * eta);
    *out = (struct bsdf_sample){.wi = wi,
                                .weight = weight,
                                .pdf = pdf,
                                .pdf_rev = pdf * jacobian,
                                .delta = true,
                                .transmission = true};
    return true;
}

bool bsdf_kind_invert_facet(const struct microfacet *mf, struct vec3 wo, struct vec3 wi,
                            double u[3])
{
    struct direction o = direction_from(wo), i = direction_from(wi);
    o.z = fabs(o.z);
    i.z = fabs(i.z);
    /* The half vector [Walter07 Eq. 13]. */
    struct direction h = direction_mad(o, 1.0, i);
    h = direction_scale(h, 1.0 / sqrt(direction_dot(h, h)));
    return microfacet_invert(mf, o, h, u + 1);
}

#define SAME_DISTANCE 1e-3

bool bsdf_kind_same(struct vec3 a, struct vec3 b)
{
    struct vec3 d = vec3_sub(a, b);
    return vec3_dot(d, d) < (float)(SAME_DISTANCE * SAME_DISTANCE);
}

bool bsdf_kind_is_refraction(struct vec3 wo, struct vec3 wi, double eta, double cos_t)
{
    struct direction o = direction_from(wo);
    /* Snell's law [Pharr16, section 8.2.3]. */
    struct direction i = {-o.x / eta, -o.y / eta, copysign(cos_t, -o.z)};
    return wo.z * wi.z < 0.0f && bsdf_kind_same(wi, direction_to_vec3(i));
}

bool bsdf_kind_invert_mirror(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                             bool delta, double choice, double u[3])
{
    (void)bsdf, (void)choice, (void)u;
    return delta && bsdf_kind_is_mirror(wo, wi);
}

bool bsdf_kind_invert_nothing(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                              bool delta, double choice, double u[3])
{
    (void)bsdf, (void)wo, (void)wi, (void)delta, (void)choice, (void)u;
    return false;
}

bool bsdf_kind_straight_sample(struct vec3 wo, const struct bsdf_straight *straight,
                               struct bsdf_sample *out)
{
    *out = (struct bsdf_sample){
        .wi = vec3_neg(wo),
        .weight = rgb_scale(straight->transmittance, 1.0 / straight->chance),
        .pdf = straight->chance,
        .pdf_rev = straight->chance,
        .delta = true,
        .transmission = true};
    return true;
}

unsigned bsdf_kind_children_flags(const struct bsdf *bsdf)
{
    unsigned all = 0;
    int rough = 0, smooth = 0, straight = 0;
    for (int i = 0; i < 2; i++) {
        unsigned flags = bsdf->child[i] ? bsdf->child[i]->flags : BSDF_BLACK;
        if (flags & BSDF_BLACK)
            continue;
        all |= flags & ~(unsigned)(BSDF_DELTA | BSDF_TEXTURED | BSDF_ONLY_STRAIGHT);
        smooth += (flags & (BSDF_DELTA | BSDF_SOME_DELTA)) != 0;
        straight += (flags & BSDF_ONLY_STRAIGHT) != 0;
        rough += (flags & BSDF_DELTA) == 0;
    }
    if (straight > 0 && straight == smooth)
        all |= BSDF_ONLY_STRAIGHT;
    if (rough + smooth == 0)
        return BSDF_BLACK;
    if (rough == 0)
        return all | BSDF_DELTA;
    return smooth > 0 ? all | BSDF_SOME_DELTA : all;
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

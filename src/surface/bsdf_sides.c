/* One material for each side: child[0] where z > 0, child[1], seen from its own front, on
 * the other side; a child that is missing scatters nothing. For opaque materials only:
 * Mitsuba's are black from behind unless they are made two-sided. */

#include "surface/bsdf_kind.h"

static const struct bsdf_param params[] = {{.name = NULL}};

static bool prepare(struct bsdf *bsdf, const struct place *at, struct err *err)
{
    for (int i = 0; i < 2; i++)
        if (bsdf->child[i] && bsdf->child[i]->flags & BSDF_TRANSMITS)
            return err_set(err, ERR_VALUE, at,
                           "a material that transmits (%s) belongs to both sides",
                           bsdf->child[i]->type->name);
    bsdf->flags = bsdf_kind_children_flags(bsdf);
    return true;
}

/* The side's child, with directions turned to its front; NULL if it is black. */
static const struct bsdf *side(const struct bsdf *bsdf, struct vec3 *wo, struct vec3 *wi)
{
    bool back = wo->z < 0.0f;
    if (back) {
        wo->z = -wo->z;
        wi->z = -wi->z;
    }
    const struct bsdf *child = bsdf->child[back];
    return child && !(child->flags & BSDF_BLACK) ? child : NULL;
}

static bool eval(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                 enum transport mode, struct bsdf_value *out)
{
    const struct bsdf *child = side(bsdf, &wo, &wi);
    return child ? bsdf_eval(child, wo, wi, mode, out) : bsdf_kind_no_value(out);
}

static bool sample(const struct bsdf *bsdf, struct vec3 wo, const double u[3],
                   enum transport mode, struct bsdf_sample *out)
{
    bool back = wo.z < 0.0f;
    struct vec3 unused = {0.0f, 0.0f, 0.0f};
    const struct bsdf *child = side(bsdf, &wo, &unused);
    if (!child || !bsdf_sample(child, wo, u, mode, out))
        return bsdf_kind_no_sample(out);
    if (back)
        out->wi.z = -out->wi.z;
    return true;
}

static bool invert(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi, bool delta,
                   double choice, double u[3])
{
    const struct bsdf *child = side(bsdf, &wo, &wi);
    return child && bsdf_invert(child, wo, wi, delta, choice, u);
}

const struct bsdf_type bsdf_type_sides = {
    .name = "sides",
    .params = params,
    .prepare = prepare,
    .eval = eval,
    .sample = sample,
    .invert = invert,
};

/* Two materials in one: (1 - weight) child[0] + weight child[1]; a child that is missing
 * scatters nothing. With null as one of them it is a mask. A delta lobe of a child stays
 * a delta; what both children scatter elsewhere has one density, whichever was chosen. */

#include "math/warp.h"
#include "surface/bsdf_kind.h"

enum { WEIGHT = 0, CHANCE = 3 /* of child[1] */ };

static const struct bsdf_param params[] = {
    {"weight", WEIGHT, 3, {0.5, 0.5, 0.5}, 0.0, 1.0},
    {.name = NULL},
};

static bool scatters(const struct bsdf *bsdf, int i)
{
    return bsdf->child[i] && !(bsdf->child[i]->flags & BSDF_BLACK);
}

static bool prepare(struct bsdf *bsdf, const struct place *at, struct err *err)
{
    (void)at, (void)err;
    double chance = fmin(1.0, rgb_luminance(bsdf_kind_rgb(bsdf, WEIGHT)));
    if (!scatters(bsdf, 1))
        chance = 0.0;
    else if (!scatters(bsdf, 0))
        chance = chance > 0.0 ? 1.0 : 0.0;
    bsdf->param[CHANCE] = chance;
    bsdf->flags = bsdf_kind_children_flags(bsdf);
    if (chance > 0.0 && chance < 1.0)
        bsdf->flags |= BSDF_U_LOBE;
    else if (chance == 0.0 && !scatters(bsdf, 0))
        bsdf->flags = BSDF_BLACK;
    else if (chance == 1.0 || chance == 0.0) {
        /* One of them alone, if the weight has no colour. */
        const struct bsdf *only = bsdf->child[chance == 1.0];
        bsdf->flags = only->flags & ~(unsigned)BSDF_TEXTURED;
    }
    return true;
}

static struct rgb tint(const struct bsdf *bsdf, int i)
{
    struct rgb w = bsdf_kind_rgb(bsdf, WEIGHT);
    return i ? w : rgb(1.0 - w.r, 1.0 - w.g, 1.0 - w.b);
}

static double chance_of(const struct bsdf *bsdf, int i)
{
    return i ? bsdf->param[CHANCE] : 1.0 - bsdf->param[CHANCE];
}

static void add_child(const struct bsdf *bsdf, int i, struct vec3 wo, struct vec3 wi,
                      enum transport mode, struct bsdf_value *sum)
{
    struct bsdf_value v;
    double chance = chance_of(bsdf, i);
    if (chance == 0.0 || !bsdf->child[i] || !bsdf_eval(bsdf->child[i], wo, wi, mode, &v))
        return;
    /* (1 - weight) f_0 + weight f_1, and the mixture density. */
    sum->f = rgb_add(sum->f, rgb_mul(v.f, tint(bsdf, i)));
    sum->pdf += chance * v.pdf;
    sum->pdf_rev += chance * v.pdf_rev;
}

static bool eval(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                 enum transport mode, struct bsdf_value *out)
{
    *out = (struct bsdf_value){0};
    add_child(bsdf, 0, wo, wi, mode, out);
    add_child(bsdf, 1, wo, wi, mode, out);
    return out->pdf > 0.0 && !rgb_is_black(out->f) ? true : bsdf_kind_no_value(out);
}

/* Child i's straight lobe; its chance is 0 if there is none. */
static struct bsdf_straight straight_child(const struct bsdf *bsdf, int i, struct vec3 wo)
{
    struct bsdf_straight s;
    if (chance_of(bsdf, i) == 0.0 || !bsdf->child[i] ||
        !bsdf_straight(bsdf->child[i], wo, &s))
        return (struct bsdf_straight){0};
    return s;
}

/* The straight lobes of both children are one delta. Colours that exclude each other can
 * leave nothing of it: then there is no such lobe, and its chance is the children's. */
static bool straight(const struct bsdf *bsdf, struct vec3 wo, struct bsdf_straight *out)
{
    *out = (struct bsdf_straight){0};
    for (int i = 0; i < 2; i++) {
        struct bsdf_straight s = straight_child(bsdf, i, wo);
        out->transmittance = rgb_add(out->transmittance,
                                     rgb_mul(s.transmittance, tint(bsdf, i)));
        out->chance += s.chance * chance_of(bsdf, i);
    }
    if (rgb_is_black(out->transmittance))
        *out = (struct bsdf_straight){0};
    return out->chance > 0.0;
}

/* Chances of the children without the straight lobes, and below which of its own numbers
 * a child would go straight on. */
struct share {
    double of[2], below[2];
};

static inline struct share share_of(const struct bsdf *bsdf, struct vec3 wo,
                                    double passes)
{
    struct share share;
    for (int i = 0; i < 2; i++) {
        share.below[i] = passes > 0.0 ? straight_child(bsdf, i, wo).chance : 0.0;
        share.of[i] = chance_of(bsdf, i) * (1.0 - share.below[i]) / (1.0 - passes);
    }
    return share;
}

/* Chooses a child and makes *u, the number of this choice, that of the child's own. The
 * chances are those without the straight lobes, of which the children's numbers keep
 * clear. */
static int choose(const struct bsdf *bsdf, struct vec3 wo, double passes, double *u)
{
    struct share share = share_of(bsdf, wo, passes);
    *u = (*u - passes) / (1.0 - passes);
    int i = share.of[0] == 0.0 || (share.of[1] > 0.0 && *u >= share.of[0]);
    if (share.of[0] > 0.0 && share.of[1] > 0.0)
        *u = fmin((i ? *u - share.of[0] : *u) / share.of[i], WARP_BELOW_ONE);
    *u = fmin(share.below[i] + (1.0 - share.below[i]) * *u, WARP_BELOW_ONE);
    return i;
}

static bool sample(const struct bsdf *bsdf, struct vec3 wo, const double u[3],
                   enum transport mode, struct bsdf_sample *out)
{
    struct bsdf_straight s = {.chance = 0.0};
    if (bsdf->flags & BSDF_BLACK)
        return bsdf_kind_no_sample(out);
    if (bsdf_straight(bsdf, wo, &s) && u[0] < s.chance)
        return bsdf_kind_straight_sample(wo, &s, out);
    double v[3] = {u[0], u[1], u[2]};
    int i = choose(bsdf, wo, s.chance, v);
    double chance = chance_of(bsdf, i);
    if (!bsdf_sample(bsdf->child[i], wo, v, mode, out))
        return bsdf_kind_no_sample(out);
    if (out->delta) {
        out->weight = rgb_scale(rgb_mul(out->weight, tint(bsdf, i)), 1.0 / chance);
        out->pdf *= chance;
        out->pdf_rev *= chance;
        return !rgb_is_black(out->weight) ? true : bsdf_kind_no_sample(out);
    }
    struct bsdf_value value;
    if (!eval(bsdf, wo, out->wi, mode, &value))
        return bsdf_kind_no_sample(out);
    out->weight = rgb_scale(value.f, fabs((double)out->wi.z) / value.pdf);
    out->pdf = value.pdf;
    out->pdf_rev = value.pdf_rev;
    return true;
}

/* The child that sent wo to wi: by its share of the density there, or, as a delta, the
 * only one that can; -1 if there is none. *choice is a uniform number again. */
static int child_of(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi, bool delta,
                    double *choice)
{
    double share[2] = {0.0, 0.0};
    int i;
    for (i = 0; i < 2; i++) {
        struct bsdf_value v;
        double chance = chance_of(bsdf, i), u[3] = {0.5, 0.5, 0.5};
        if (chance == 0.0 || !scatters(bsdf, i))
            continue;
        if (delta)
            share[i] = bsdf_invert(bsdf->child[i], wo, wi, true, 0.5, u);
        else if (bsdf_eval(bsdf->child[i], wo, wi, TRANSPORT_RADIANCE, &v))
            share[i] = chance * v.pdf;
    }
    bool found = !(delta && share[0] > 0.0 && share[1] > 0.0) &&
                 bsdf_kind_choose(share, choice, &i);
    return found ? i : -1;
}

/* The straight lobe, or a child's numbers with that of the choice, turned back by what
 * choose() does. */
static bool invert(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi, bool delta,
                   double choice, double u[3])
{
    struct bsdf_straight s = {.chance = 0.0};
    bool passes = bsdf_straight(bsdf, wo, &s);
    if (delta && passes && bsdf_kind_same(wi, vec3_neg(wo)))
        return bsdf_kind_invert_lobe(0.0, s.chance, u);
    int i = child_of(bsdf, wo, wi, delta, &choice);
    if (i < 0 || !bsdf_invert(bsdf->child[i], wo, wi, delta, choice, u))
        return false;
    struct share share = share_of(bsdf, wo, s.chance);
    double v = (u[0] - share.below[i]) / (1.0 - share.below[i]);
    if (share.of[0] > 0.0 && share.of[1] > 0.0)
        v = i ? share.of[0] + share.of[1] * v : share.of[0] * v;
    u[0] = s.chance + (1.0 - s.chance) * v;
    return u[0] >= 0.0 && u[0] < 1.0;
}

const struct bsdf_type bsdf_type_blend = {
    .name = "blend",
    .params = params,
    .places = 4,
    .prepare = prepare,
    .eval = eval,
    .sample = sample,
    .invert = invert,
    .straight = straight,
};

/* pbrt v3's uber, and with it plastic: up to five lobes, summed. Lambert's law; a rough
 * coat and a smooth one, both under Fresnel's law; refraction; and, by what opacity
 * leaves, light that goes straight on. Lobes are chosen by their colours alone, so that
 * the chance of a lobe is the same from all directions. */

#include "math/warp.h"
#include "surface/bsdf_kind.h"
#include "surface/fresnel.h"

enum {
    KD = 0,
    KS = 3,
    KR = 6,
    KT = 9,
    OPACITY = 12,
    ETA = 15,
    ALPHA = 16,
    DISTRIBUTION = 19,
    DERIVED = 20,
    CHANCE = 23, /* of the five lobes */
    LOBES = 5
};
/* In the order in which the lobe's number chooses. */
enum lobe { STRAIGHT, DIFFUSE, GLOSSY, MIRROR, REFRACT };

#define INV_PI (1.0 / MATH_PI)

static const struct bsdf_param params[] = {
    {"kd", KD, 3, {0.25, 0.25, 0.25}, 0.0, 1.0},
    {"ks", KS, 3, {0.25, 0.25, 0.25}, 0.0, 1.0},
    {"kr", KR, 3, {0.0, 0.0, 0.0}, 0.0, 1.0},
    {"kt", KT, 3, {0.0, 0.0, 0.0}, 0.0, 1.0},
    {"opacity", OPACITY, 3, {1.0, 1.0, 1.0}, 0.0, 1.0},
    {"eta", ETA, 1, {1.5}, 0.05, 20.0},
    BSDF_KIND_ALPHA_ROWS(ALPHA, MICROFACET_ALPHA_MIN),
    BSDF_KIND_DISTRIBUTION_ROW(DISTRIBUTION),
    {.name = NULL},
};

static struct rgb colour(const struct bsdf *bsdf, enum lobe lobe)
{
    static const int place[LOBES] = {OPACITY, KD, KS, KR, KT};
    struct rgb opacity = bsdf_kind_rgb(bsdf, OPACITY);
    if (lobe == STRAIGHT)
        return rgb(1.0 - opacity.r, 1.0 - opacity.g, 1.0 - opacity.b);
    return rgb_mul(opacity, bsdf_kind_rgb(bsdf, place[lobe]));
}

static unsigned flags_of(const double chance[LOBES])
{
    double rough = chance[DIFFUSE] + chance[GLOSSY];
    double through = chance[REFRACT] + chance[STRAIGHT];
    double smooth = through + chance[MIRROR];
    int lobes = 0;
    for (int i = 0; i < LOBES; i++)
        lobes += chance[i] > 0.0;
    if (lobes == 0)
        return BSDF_BLACK;
    unsigned flags = lobes > 1 ? BSDF_U_LOBE : 0u;
    if (rough > 0.0)
        flags |= BSDF_U_DIRECTION;
    if (rough + chance[MIRROR] > 0.0)
        flags |= BSDF_REFLECTS;
    if (through > 0.0)
        flags |= BSDF_TRANSMITS;
    if (chance[STRAIGHT] > 0.0)
        flags |= BSDF_STRAIGHT;
    if (smooth > 0.0 && smooth == chance[STRAIGHT])
        flags |= BSDF_ONLY_STRAIGHT;
    if (smooth > 0.0)
        flags |= rough > 0.0 ? BSDF_SOME_DELTA : BSDF_DELTA;
    return flags;
}

static bool prepare(struct bsdf *bsdf, const struct place *at, struct err *err)
{
    /* Fresnel's factor makes the coats dim; at eta = 1 they vanish. */
    double coat = bsdf->param[ETA] == 1.0 ? 0.0 : 0.25, sum = 0.0;
    const double share[LOBES] = {1.0, 1.0, coat, coat, 1.0};
    double *chance = bsdf->param + CHANCE;
    for (int i = 0; i < LOBES; i++) {
        chance[i] = share[i] * rgb_luminance(colour(bsdf, (enum lobe)i));
        sum += chance[i];
    }
    for (int i = 0; i < LOBES && sum > 0.0; i++)
        chance[i] /= sum;
    bsdf->flags = flags_of(chance);
    return bsdf_kind_prepare_microfacet(bsdf, ALPHA, DISTRIBUTION, DERIVED, at, err);
}

static double eta_from(const struct bsdf *bsdf, float z)
{
    return z > 0.0f ? bsdf->param[ETA] : 1.0 / bsdf->param[ETA];
}

/* Both directions above. */
static void add_glossy(const struct bsdf *bsdf, double eta, struct direction o,
                       struct direction i, struct bsdf_value *out)
{
    struct microfacet mf = bsdf_kind_microfacet(bsdf, DERIVED);
    struct direction h = direction_mad(o, 1.0, i);
    double length = sqrt(direction_dot(h, h)), cos_t;
    double d = 0.25 * microfacet_d(&mf, direction_scale(h, 1.0 / length));
    double fresnel = fresnel_dielectric(fmin(1.0, 0.5 * length), eta, &cos_t);
    double area_o = microfacet_area(&mf, o), area_i = microfacet_area(&mf, i);
    /* [Walter07 Eq. 20] */
    double scale = d * fresnel / microfacet_cosines_over_g2(o.z, area_o, i.z, area_i);
    out->f = rgb_add(out->f, rgb_scale(colour(bsdf, GLOSSY), scale));
    /* D_visible / (4 cos_h) [Heitz18 Eq. 3], [Walter07 Eq. 14]. */
    out->pdf += bsdf->param[CHANCE + GLOSSY] * d / area_o;
    out->pdf_rev += bsdf->param[CHANCE + GLOSSY] * d / area_i;
}

static bool eval(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                 enum transport mode, struct bsdf_value *out)
{
    (void)mode;
    if (!((double)wo.z * (double)wi.z > 0.0) || !(bsdf->flags & BSDF_U_DIRECTION))
        return bsdf_kind_no_value(out);
    double diffuse = bsdf->param[CHANCE + DIFFUSE] * INV_PI;
    /* rho / pi [Pharr16, section 8.3]. */
    *out = (struct bsdf_value){rgb_scale(colour(bsdf, DIFFUSE), INV_PI),
                               diffuse * fabs((double)wi.z),
                               diffuse * fabs((double)wo.z)};
    if (bsdf->param[CHANCE + GLOSSY] > 0.0) {
        struct direction o = direction_from(wo), i = direction_from(wi);
        o.z = fabs(o.z);
        i.z = fabs(i.z);
        add_glossy(bsdf, eta_from(bsdf, wo.z), o, i, out);
    }
    return out->pdf > 0.0 && !rgb_is_black(out->f) ? true : bsdf_kind_no_value(out);
}

static bool sample_rough(const struct bsdf *bsdf, struct vec3 wo, enum lobe lobe,
                         const double u[2], enum transport mode, struct bsdf_sample *out)
{
    struct vec3 wi;
    if (lobe == DIFFUSE) {
        wi = warp_cosine(u);
    } else {
        struct microfacet mf = bsdf_kind_microfacet(bsdf, DERIVED);
        struct direction o = direction_from(wo);
        o.z = fabs(o.z);
        struct direction h = microfacet_sample(&mf, o, u);
        wi = direction_to_vec3(direction_reflect(o, h));
    }
    return bsdf_kind_sampled(bsdf, wo, wi, eval, mode, out);
}

static enum lobe choose(const double chance[LOBES], double u)
{
    int last = 0;
    for (int i = 0; i < LOBES; i++) {
        if (chance[i] == 0.0)
            continue;
        last = i;
        if (u < chance[i])
            break;
        u -= chance[i];
    }
    return (enum lobe)last;
}

static bool straight(const struct bsdf *bsdf, struct vec3 wo, struct bsdf_straight *out)
{
    (void)wo;
    *out = (struct bsdf_straight){colour(bsdf, STRAIGHT), bsdf->param[CHANCE + STRAIGHT]};
    return true;
}

static bool sample(const struct bsdf *bsdf, struct vec3 wo, const double u[3],
                   enum transport mode, struct bsdf_sample *out)
{
    if (wo.z == 0.0f || bsdf->flags & BSDF_BLACK)
        return bsdf_kind_no_sample(out);
    const double *chances = bsdf->param + CHANCE;
    enum lobe lobe = choose(chances, bsdf->flags & BSDF_U_LOBE ? u[0] : 0.0);
    if (lobe == DIFFUSE || lobe == GLOSSY)
        return sample_rough(bsdf, wo, lobe, u + 1, mode, out);
    if (lobe == STRAIGHT) {
        struct bsdf_straight s;
        straight(bsdf, wo, &s);
        return bsdf_kind_straight_sample(wo, &s, out);
    }
    double chance = chances[lobe], cos_t, eta = eta_from(bsdf, wo.z);
    double fresnel = fresnel_dielectric(fabs((double)wo.z), eta, &cos_t);
    struct rgb weight = rgb_scale(colour(bsdf, lobe), 1.0 / chance);
    /* [Pharr16, sections 8.2.2 and 8.2.3] */
    if (lobe == MIRROR)
        return bsdf_kind_mirror_sample(wo, rgb_scale(weight, fresnel), chance, out);
    return bsdf_kind_refract_sample(wo, eta, cos_t, rgb_scale(weight, 1.0 - fresnel),
                                    chance, mode, out);
}

/* The smooth lobe that sends wo to wi; LOBES if none or two of them do. */
static int smooth_lobe(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi)
{
    double cos_t, eta = eta_from(bsdf, wo.z);
    fresnel_dielectric(fabs((double)wo.z), eta, &cos_t);
    const bool sends[LOBES] = {
        [STRAIGHT] = bsdf_kind_same(wi, vec3_neg(wo)),
        [MIRROR] = bsdf_kind_is_mirror(wo, wi),
        [REFRACT] = bsdf_kind_is_refraction(wo, wi, eta, cos_t),
    };
    int found = LOBES;
    for (int i = 0; i < LOBES; i++) {
        if (!sends[i] || bsdf->param[CHANCE + i] == 0.0)
            continue;
        if (found < LOBES)
            return LOBES;
        found = i;
    }
    return found;
}

/* Of the rough lobes one by its share of the density at wi. */
static int rough_lobe(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                      double choice)
{
    struct bsdf_value v;
    int glossy;
    if (!eval(bsdf, wo, wi, TRANSPORT_RADIANCE, &v))
        return LOBES;
    double diffuse = bsdf->param[CHANCE + DIFFUSE] * INV_PI * fabs((double)wi.z);
    bool coat = bsdf->param[CHANCE + GLOSSY] > 0.0;
    const double share[2] = {diffuse, coat ? fmax(0.0, v.pdf - diffuse) : 0.0};
    if (!bsdf_kind_choose(share, &choice, &glossy))
        return LOBES;
    return glossy ? GLOSSY : DIFFUSE;
}

static bool invert(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi, bool delta,
                   double choice, double u[3])
{
    int lobe = delta ? smooth_lobe(bsdf, wo, wi) : rough_lobe(bsdf, wo, wi, choice);
    if (lobe == LOBES)
        return false;
    double lo = 0.0, hi;
    for (int i = 0; i < lobe; i++)
        lo += bsdf->param[CHANCE + i];
    hi = fmin(1.0, lo + bsdf->param[CHANCE + lobe]);
    if (bsdf->flags & BSDF_U_LOBE && !bsdf_kind_invert_lobe(lo, hi, u))
        return false;
    struct microfacet mf = bsdf_kind_microfacet(bsdf, DERIVED);
    return delta || (lobe == GLOSSY ? bsdf_kind_invert_facet(&mf, wo, wi, u)
                                    : bsdf_kind_invert_cosine(wi, u));
}

const struct bsdf_type bsdf_type_uber = {
    .name = "uber",
    .params = params,
    .places = 28,
    .prepare = prepare,
    .eval = eval,
    .sample = sample,
    .invert = invert,
    .straight = straight,
};

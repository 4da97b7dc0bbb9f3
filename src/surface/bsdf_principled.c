/* Disney's principled material [Burley12], [Burley15] in the form that Mitsuba 3
 * documents: over a front side a diffuse base with retro-reflection, sheen and a flat
 * ("fake subsurface") variant, GGX microfacets that reflect as metal, as tinted or as
 * plain dielectric, and a clear coat; and of the share spec_trans refraction by the same
 * microfacets, which alone is seen from behind. Without refraction both sides look alike.
 *
 * As in the original nothing is taken from the base for what the lobes over it reflect:
 * a white base with a high roughness, sheen or coat returns more than falls on it. */

#include "math/warp.h"
#include "surface/bsdf_kind.h"
#include "surface/fresnel.h"

enum {
    BASE = 0,
    ROUGHNESS = 3,
    ANISOTROPIC = 4,
    METALLIC = 5,
    SPEC_TRANS = 6,
    ETA = 7,
    SPEC_TINT = 8,
    SHEEN = 9,
    SHEEN_TINT = 10,
    FLATNESS = 11,
    COAT = 12,
    COAT_GLOSS = 13,
    DERIVED = 14, /* of the microfacets */
    TINT = 17,    /* the base's colour of luminance 1 */
    DIFFUSE = 20, /* shares of the base: diffuse */
    GLASS = 21,   /* and refracting */
    COAT_ALPHA = 22,
    CHANCE = 23, /* of the three lobes, from the front */
    SIDED = 26   /* 1: refracts somewhere, so the sides differ */
};
enum lobe { LOBE_DIFFUSE, LOBE_SPECULAR, LOBE_COAT, LOBES };

#define INV_PI      (1.0 / MATH_PI)
#define ALPHA_LEAST 1e-3
#define ETA_LEAST   1.001

static const struct bsdf_param params[] = {
    {"base_color", BASE, 3, {0.5, 0.5, 0.5}, 0.0, 1.0},
    {"roughness", ROUGHNESS, 1, {0.5}, 0.0, 1.0},
    {"anisotropic", ANISOTROPIC, 1, {0.0}, 0.0, 1.0},
    {"metallic", METALLIC, 1, {0.0}, 0.0, 1.0},
    {"spec_trans", SPEC_TRANS, 1, {0.0}, 0.0, 1.0},
    {"eta", ETA, 1, {1.5}, ETA_LEAST, 20.0},
    {"spec_tint", SPEC_TINT, 1, {0.0}, 0.0, 1.0},
    {"sheen", SHEEN, 1, {0.0}, 0.0, 1.0},
    {"sheen_tint", SHEEN_TINT, 1, {0.0}, 0.0, 1.0},
    {"flatness", FLATNESS, 1, {0.0}, 0.0, 1.0},
    {"clearcoat", COAT, 1, {0.0}, 0.0, 1.0},
    {"clearcoat_gloss", COAT_GLOSS, 1, {0.0}, 0.0, 1.0},
    {.name = NULL},
};

/* Chances by what the lobes scatter, roughly: the same from all directions. */
static void set_chances(double *p)
{
    double base = rgb_luminance(rgb(p[BASE], p[BASE + 1], p[BASE + 2]));
    double *chance = p + CHANCE, metal = p[METALLIC];
    chance[LOBE_DIFFUSE] = p[DIFFUSE] * (base + 0.2 * p[SHEEN]);
    chance[LOBE_SPECULAR] = 0.05 + metal * base + 0.2 * p[DIFFUSE] + p[GLASS];
    chance[LOBE_COAT] = 0.1 * p[COAT];
    double sum = chance[LOBE_DIFFUSE] + chance[LOBE_SPECULAR] + chance[LOBE_COAT];
    for (int i = 0; i < LOBES; i++)
        chance[i] /= sum;
}

static bool refracts_somewhere(const struct bsdf *bsdf)
{
    for (int i = 0; i < BSDF_TEXTURES && bsdf->bound[i].texture; i++)
        if (bsdf->bound[i].param->offset == SPEC_TRANS)
            return true;
    return bsdf->param[SPEC_TRANS] > 0.0;
}

static bool prepare(struct bsdf *bsdf, const struct place *at, struct err *err)
{
    (void)at, (void)err;
    double *p = bsdf->param, rough = p[ROUGHNESS] * p[ROUGHNESS];
    double aspect = sqrt(1.0 - 0.9 * p[ANISOTROPIC]); /* [Burley12] */
    p[DERIVED] = fmax(ALPHA_LEAST, rough / aspect);
    p[DERIVED + 1] = fmax(ALPHA_LEAST, rough * aspect);
    p[DERIVED + 2] = MICROFACET_GGX;
    double luminance = rgb_luminance(bsdf_kind_rgb(bsdf, BASE));
    for (int i = 0; i < 3; i++)
        p[TINT + i] = luminance > 0.0 ? p[BASE + i] / luminance : 1.0;
    p[DIFFUSE] = (1.0 - p[METALLIC]) * (1.0 - p[SPEC_TRANS]);
    p[GLASS] = (1.0 - p[METALLIC]) * p[SPEC_TRANS];
    p[COAT_ALPHA] = 0.1 + p[COAT_GLOSS] * (0.001 - 0.1);
    if (refracts_somewhere(bsdf))
        p[SIDED] = 1.0; /* and stays so when textures are evaluated */
    set_chances(p);
    bsdf->flags = BSDF_REFLECTS | BSDF_U_DIRECTION;
    if (p[SIDED] == 1.0)
        bsdf->flags |= BSDF_TRANSMITS;
    if (p[SIDED] == 1.0 || p[CHANCE + LOBE_SPECULAR] < 1.0)
        bsdf->flags |= BSDF_U_LOBE;
    if (p[DERIVED] != p[DERIVED + 1])
        bsdf->flags |= BSDF_ANISOTROPIC;
    return true;
}

/* A pair of directions, turned so that o is above. */
struct pair {
    struct direction o, i;
    bool front;            /* o is on the front side */
    double eta;            /* index beyond over that of o's side */
    double area_o, area_i; /* of |cos| */
};

static bool is_front(const struct bsdf *bsdf, struct vec3 wo)
{
    return wo.z > 0.0f || bsdf->param[SIDED] != 1.0;
}

static double lerp(double a, double b, double share)
{
    return a + share * (b - a);
}

/* (1 - cos)^5 [Schlick94] */
static double schlick_weight(double cosine)
{
    double m = fmin(fmax(1.0 - cosine, 0.0), 1.0), m2 = m * m;
    return m2 * m2 * m;
}

/* What the microfacets reflect of light that meets them at cos_h, from the front. */
static struct rgb specular_colour(const struct bsdf *bsdf, double fresnel, double cos_h)
{
    const double *p = bsdf->param;
    double metal = p[METALLIC], tinted = (1.0 - metal) * p[SPEC_TINT];
    double r0 = (p[ETA] - 1.0) / (p[ETA] + 1.0);
    struct rgb sum = rgb_grey((1.0 - metal) * (1.0 - p[SPEC_TINT]) * fresnel);
    if (metal > 0.0)
        sum = rgb_add(
            sum, rgb_scale(fresnel_schlick(cos_h, bsdf_kind_rgb(bsdf, BASE)), metal));
    if (tinted > 0.0)
        sum = rgb_add(
            sum, rgb_scale(fresnel_schlick(cos_h,
                                           rgb_scale(bsdf_kind_rgb(bsdf, TINT), r0 * r0)),
                           tinted));
    return sum;
}

/* Chance that a facet where Fresnel's law gives F reflects rather than refracts. */
static double chance_reflects(const struct bsdf *bsdf, bool front, double fresnel)
{
    return front ? 1.0 - bsdf->param[GLASS] * (1.0 - fresnel) : fresnel;
}

static double chance_specular(const struct bsdf *bsdf, bool front)
{
    return front ? bsdf->param[CHANCE + LOBE_SPECULAR] : 1.0;
}

/* D G_1 G_1 F / (4 cos cos) [Walter07 Eq. 20], where the G_1 are cos / area. */
static void add_specular(const struct bsdf *bsdf, const struct pair *p, double d,
                         double cos_h, struct bsdf_value *out)
{
    double cos_t, fresnel = fresnel_dielectric(cos_h, p->eta, &cos_t);
    struct rgb colour = p->front ? specular_colour(bsdf, fresnel, cos_h)
                                 : rgb_grey(bsdf->param[GLASS] * fresnel);
    double chance = chance_specular(bsdf, p->front) *
                    chance_reflects(bsdf, p->front, fresnel);
    out->f = rgb_add(out->f, rgb_scale(colour, 0.25 * d / (p->area_o * p->area_i)));
    /* D_visible / (4 cos_h) [Heitz18 Eq. 3], [Walter07 Eq. 14]. */
    out->pdf += chance * 0.25 * d / p->area_o;
    out->pdf_rev += chance * 0.25 * d / p->area_i;
}

/* Smith's G_1 of GGX of the coat's fixed roughness .25 [Burley12]. */
static double coat_g1(double cosine)
{
    double tan2 = (1.0 - cosine * cosine) / (cosine * cosine);
    return 2.0 / (1.0 + sqrt(1.0 + 0.25 * 0.25 * tan2));
}

/* GTR with the exponent 1 [Burley12 Eq. 4]. */
static double coat_d(double alpha, double cosine)
{
    double a2 = alpha * alpha;
    return (a2 - 1.0) / (MATH_PI * log(a2) * (1.0 + (a2 - 1.0) * cosine * cosine));
}

static void add_coat(const struct bsdf *bsdf, const struct pair *p, double h_z,
                     double cos_h, struct bsdf_value *out)
{
    double d = coat_d(bsdf->param[COAT_ALPHA], h_z);
    double fresnel = lerp(0.04, 1.0, schlick_weight(cos_h));
    double f = 0.25 * bsdf->param[COAT] * fresnel * d * coat_g1(p->o.z) * coat_g1(p->i.z);
    /* [Walter07 Eq. 14] with the density D cos of facets. */
    double pdf = bsdf->param[CHANCE + LOBE_COAT] * 0.25 * d * h_z / cos_h;
    out->f = rgb_add(out->f, rgb_grey(f));
    out->pdf += pdf;
    out->pdf_rev += pdf;
}

/* The diffuse base [Burley12 Eq. 4 of section 5.3, as split in Burley15], its flat
 * variant and the sheen. */
static void add_diffuse(const struct bsdf *bsdf, const struct pair *p, double cos_h,
                        struct bsdf_value *out)
{
    const double *q = bsdf->param;
    double fo = schlick_weight(p->o.z), fi = schlick_weight(p->i.z);
    double back = 2.0 * q[ROUGHNESS] * cos_h * cos_h;
    double base = (1.0 - 0.5 * fi) * (1.0 - 0.5 * fo) +
                  back * (fo + fi + fo * fi * (back - 1.0));
    if (q[FLATNESS] > 0.0) {
        double flat = lerp(1.0, 0.5 * back, fo) * lerp(1.0, 0.5 * back, fi);
        flat = 1.25 * (flat * (1.0 / (p->o.z + p->i.z) - 0.5) + 0.5);
        base = lerp(base, flat, q[FLATNESS]);
    }
    struct rgb f = rgb_scale(bsdf_kind_rgb(bsdf, BASE), q[DIFFUSE] * INV_PI * base);
    if (q[SHEEN] > 0.0) {
        double sheen = q[SHEEN] * (1.0 - q[METALLIC]) * schlick_weight(cos_h);
        double tint = q[SHEEN_TINT];
        f = rgb_add(f,
                    rgb_scale(rgb(lerp(1.0, q[TINT], tint), lerp(1.0, q[TINT + 1], tint),
                                  lerp(1.0, q[TINT + 2], tint)),
                              sheen));
    }
    double chance = q[CHANCE + LOBE_DIFFUSE] * INV_PI;
    out->f = rgb_add(out->f, f);
    out->pdf += chance * p->i.z;
    out->pdf_rev += chance * p->o.z;
}

static void eval_reflection(const struct bsdf *bsdf, const struct microfacet *mf,
                            const struct pair *p, struct bsdf_value *out)
{
    struct direction h = direction_mad(p->o, 1.0, p->i);
    double length = sqrt(direction_dot(h, h)), cos_h = fmin(1.0, 0.5 * length);
    h = direction_scale(h, 1.0 / length);
    add_specular(bsdf, p, microfacet_d(mf, h), cos_h, out);
    if (p->front && bsdf->param[COAT] > 0.0)
        add_coat(bsdf, p, h.z, cos_h, out);
    if (p->front && bsdf->param[DIFFUSE] > 0.0)
        add_diffuse(bsdf, p, cos_h, out);
}

/* [Walter07 Eqs. 16, 17 and 21], the colour being that of one of two surfaces. */
static void eval_refraction(const struct bsdf *bsdf, const struct microfacet *mf,
                            const struct pair *p, enum transport mode,
                            struct bsdf_value *out)
{
    struct direction h = direction_mad(p->o, p->eta, p->i);
    double length2 = direction_dot(h, h), sign = p->eta > 1.0 ? -1.0 : 1.0;
    h = direction_scale(h, sign / sqrt(length2));
    double cos_oh = direction_dot(p->o, h), cos_ih = -direction_dot(p->i, h);
    if (!(cos_oh > 0.0 && cos_ih > 0.0))
        return;
    double fresnel = fresnel_dielectric_cosines(cos_oh, cos_ih, p->eta);
    double d = microfacet_d(mf, h) * cos_oh * cos_ih / length2;
    double eta2 = p->eta * p->eta, share = bsdf->param[GLASS] * (1.0 - fresnel);
    /* For radiance eta^2 of the Jacobian cancels against 1/eta^2 of the solid angle. */
    double scale = (mode == TRANSPORT_RADIANCE ? 1.0 : eta2) * share * d;
    struct rgb base = bsdf_kind_rgb(bsdf, BASE);
    out->f = rgb_scale(rgb(sqrt(base.r), sqrt(base.g), sqrt(base.b)),
                       scale / (p->area_o * p->area_i));
    double from_o = chance_specular(bsdf, p->front) *
                    (1.0 - chance_reflects(bsdf, p->front, fresnel));
    double from_i = chance_specular(bsdf, !p->front) *
                    (1.0 - chance_reflects(bsdf, !p->front, fresnel));
    out->pdf = from_o * d * eta2 / p->area_o;
    out->pdf_rev = from_i * d / p->area_i;
}

static bool eval(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                 enum transport mode, struct bsdf_value *out)
{
    *out = (struct bsdf_value){0};
    struct pair p = {
        direction_from(wo), direction_from(wi), is_front(bsdf, wo), 0.0, 0.0, 0.0};
    bool sided = bsdf->param[SIDED] == 1.0;
    if (p.o.z < 0.0) {
        p.o = direction_flip(p.o);
        p.i = direction_flip(p.i);
    }
    bool through = p.i.z < 0.0;
    if (p.o.z == 0.0 || p.i.z == 0.0 || (through && !sided) ||
        ((through || !p.front) && bsdf->param[GLASS] == 0.0))
        return false;
    struct microfacet mf = bsdf_kind_microfacet(bsdf, DERIVED);
    struct direction above = {p.i.x, p.i.y, fabs(p.i.z)};
    p.eta = p.front ? bsdf->param[ETA] : 1.0 / bsdf->param[ETA];
    p.area_o = microfacet_area(&mf, p.o);
    p.area_i = microfacet_area(&mf, above);
    if (through)
        eval_refraction(bsdf, &mf, &p, mode, out);
    else
        eval_reflection(bsdf, &mf, &p, out);
    return out->pdf > 0.0 && !rgb_is_black(out->f) ? true : bsdf_kind_no_value(out);
}

/* o reflected or refracted at a visible facet, by the number u. */
static bool sample_specular(const struct bsdf *bsdf, struct direction o, bool front,
                            double u, const double u_facet[2], struct direction *i)
{
    struct microfacet mf = bsdf_kind_microfacet(bsdf, DERIVED);
    struct direction h = microfacet_sample(&mf, o, u_facet);
    double cos_h = fmin(1.0, direction_dot(o, h)), cos_t;
    double eta = front ? bsdf->param[ETA] : 1.0 / bsdf->param[ETA];
    if (cos_h <= 0.0)
        return false;
    double fresnel = fresnel_dielectric(cos_h, eta, &cos_t);
    bool reflects = u < chance_reflects(bsdf, front, fresnel);
    /* [Walter07 Eqs. 39 and 40] */
    *i = reflects ? direction_reflect(o, h)
                  : direction_mad(direction_scale(o, -1.0 / eta), cos_h / eta - cos_t, h);
    return reflects == (i->z > 0.0);
}

/* o reflected at a facet of the coat, sampled by D cos [Burley12]. */
static struct direction sample_coat(double alpha, struct direction o, const double u[2])
{
    double a2 = alpha * alpha, cos2 = (1.0 - pow(a2, 1.0 - u[1])) / (1.0 - a2);
    double sine = sqrt(fmax(0.0, 1.0 - cos2)), phi = 2.0 * MATH_PI * u[0];
    struct direction h = {sine * cos(phi), sine * sin(phi), sqrt(fmax(0.0, cos2))};
    return direction_reflect(o, h);
}

static bool sample(const struct bsdf *bsdf, struct vec3 wo, const double u[3],
                   enum transport mode, struct bsdf_sample *out)
{
    bool front = is_front(bsdf, wo);
    if (wo.z == 0.0f || (!front && bsdf->param[GLASS] == 0.0))
        return bsdf_kind_no_sample(out);
    struct direction o = direction_from(wo), i;
    o.z = fabs(o.z);
    const double *chance = bsdf->param + CHANCE;
    double specular = chance_specular(bsdf, front);
    double u_lobe = bsdf->flags & BSDF_U_LOBE ? u[0] : 0.0;
    if (u_lobe < specular) {
        double v = fmin(u_lobe / specular, WARP_BELOW_ONE);
        if (!sample_specular(bsdf, o, front, v, u + 1, &i))
            return bsdf_kind_no_sample(out);
    } else if (u_lobe < specular + chance[LOBE_DIFFUSE]) {
        i = direction_from(warp_cosine(u + 1));
    } else {
        i = sample_coat(bsdf->param[COAT_ALPHA], o, u + 1);
        if (i.z <= 0.0)
            return bsdf_kind_no_sample(out);
    }
    struct vec3 wi = direction_to_vec3(i);
    wi.z = wo.z < 0.0f ? -wi.z : wi.z;
    struct bsdf_value v;
    if (!eval(bsdf, wo, wi, mode, &v))
        return bsdf_kind_no_sample(out);
    *out = (struct bsdf_sample){.wi = wi,
                                .weight = rgb_scale(v.f, fabs((double)wi.z) / v.pdf),
                                .pdf = v.pdf,
                                .pdf_rev = v.pdf_rev,
                                .transmission = i.z < 0.0};
    return true;
}

/* The density of one lobe at the pair of directions, by the function that adds it. */
static double lobe_pdf(const struct bsdf *bsdf, const struct pair *p, enum lobe lobe)
{
    struct bsdf_value v = {0};
    struct direction h = direction_mad(p->o, 1.0, p->i);
    double length = sqrt(direction_dot(h, h)), cos_h = fmin(1.0, 0.5 * length);
    if (lobe == LOBE_COAT && bsdf->param[COAT] > 0.0)
        add_coat(bsdf, p, h.z / length, cos_h, &v);
    else if (lobe == LOBE_DIFFUSE && bsdf->param[DIFFUSE] > 0.0)
        add_diffuse(bsdf, p, cos_h, &v);
    return v.pdf;
}

/* u with which sample_coat gives i. */
static bool invert_coat(double alpha, const struct pair *p, double u[2])
{
    struct direction h = direction_mad(p->o, 1.0, p->i);
    double a2 = alpha * alpha, square = direction_dot(h, h);
    double turn = atan2(h.y, h.x) / (2.0 * MATH_PI);
    u[0] = turn < 0.0 ? turn + 1.0 : turn;
    /* 1 - (1 - a^2) cos^2 = sin^2 + a^2 cos^2, which does not cancel. */
    u[1] = 1.0 - log((h.x * h.x + h.y * h.y + a2 * h.z * h.z) / square) / log(a2);
    return warp_in_square(u);
}

/* u with which the microfacets of chance `specular` reflect or refract o to i. */
static bool invert_specular(const struct bsdf *bsdf, const struct pair *p,
                            double specular, double u[3])
{
    struct microfacet mf = bsdf_kind_microfacet(bsdf, DERIVED);
    bool reflects = p->i.z > 0.0;
    struct direction h = direction_mad(p->o, reflects ? 1.0 : p->eta, p->i);
    double sign = !reflects && p->eta > 1.0 ? -1.0 : 1.0, cos_t;
    h = direction_scale(h, sign / sqrt(direction_dot(h, h)));
    double cos_h = fmin(1.0, direction_dot(p->o, h));
    if (!(cos_h > 0.0) || !microfacet_invert(&mf, p->o, h, u + 1))
        return false;
    double fresnel = fresnel_dielectric(cos_h, p->eta, &cos_t);
    double chance = specular * chance_reflects(bsdf, p->front, fresnel);
    return !(bsdf->flags & BSDF_U_LOBE) ||
           bsdf_kind_invert_lobe(reflects ? 0.0 : chance, reflects ? chance : specular,
                                 u);
}

/* One of the three lobes by its share of the density at wi. */
static bool invert(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi, bool delta,
                   double choice, double u[3])
{
    struct bsdf_value v;
    if (delta || !eval(bsdf, wo, wi, TRANSPORT_RADIANCE, &v))
        return false;
    struct pair p = {
        direction_from(wo), direction_from(wi), is_front(bsdf, wo), 0.0, 0.0, 0.0};
    if (wo.z < 0.0f) {
        p.o = direction_flip(p.o);
        p.i = direction_flip(p.i);
    }
    p.eta = p.front ? bsdf->param[ETA] : 1.0 / bsdf->param[ETA];
    bool others = p.front && p.i.z > 0.0;
    double diffuse = others ? lobe_pdf(bsdf, &p, LOBE_DIFFUSE) : 0.0;
    double coat = others ? lobe_pdf(bsdf, &p, LOBE_COAT) : 0.0;
    double specular = chance_specular(bsdf, p.front), at = choice * v.pdf;
    double end = fmin(1.0, specular + bsdf->param[CHANCE + LOBE_DIFFUSE]);
    if (at < diffuse)
        return bsdf_kind_invert_lobe(specular, end, u) && bsdf_kind_invert_cosine(wi, u);
    if (at < diffuse + coat)
        return bsdf_kind_invert_lobe(end, 1.0, u) &&
               invert_coat(bsdf->param[COAT_ALPHA], &p, u + 1);
    return invert_specular(bsdf, &p, specular, u);
}

const struct bsdf_type bsdf_type_principled = {
    .name = "principled",
    .params = params,
    .places = 27,
    .prepare = prepare,
    .eval = eval,
    .sample = sample,
    .invert = invert,
};

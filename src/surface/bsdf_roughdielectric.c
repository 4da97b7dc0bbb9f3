/* Ground glass [Walter07]; z > 0 is outside. A visible facet first, then one of its two
 * lobes by Fresnel's law. */

#include "surface/bsdf_kind.h"
#include "surface/fresnel.h"

enum {
    ETA = 0,
    REFLECTANCE = 1,
    TRANSMITTANCE = 4,
    ALPHA = 7,
    DISTRIBUTION = 10,
    DERIVED = 11
};

/* For eta nearer to 1 the half vectors of refraction are lost in rounding. */
#define ETA_GAP 1e-3

static const struct bsdf_param params[] = {
    {"eta", ETA, 1, {1.5}, 0.05, 20.0},
    {"reflectance", REFLECTANCE, 3, {1.0, 1.0, 1.0}, 0.0, 1.0},
    {"transmittance", TRANSMITTANCE, 3, {1.0, 1.0, 1.0}, 0.0, 1.0},
    BSDF_KIND_ALPHA_ROWS(ALPHA, MICROFACET_ALPHA_MIN),
    BSDF_KIND_DISTRIBUTION_ROW(DISTRIBUTION),
    {.name = NULL},
};

static bool prepare(struct bsdf *bsdf, const struct place *at, struct err *err)
{
    double eta = bsdf->param[ETA];
    if (fabs(eta - 1.0) < ETA_GAP)
        return err_set(err, ERR_VALUE, at,
                       "roughdielectric: eta = %g bends no light, so its roughness has "
                       "no effect; use dielectric, or eta off 1 by %g at least",
                       eta, ETA_GAP);
    bsdf->flags = bsdf_kind_sides(bsdf, REFLECTANCE, TRANSMITTANCE);
    bsdf->flags |= bsdf->flags ? BSDF_U_LOBE | BSDF_U_DIRECTION : BSDF_BLACK;
    return bsdf_kind_prepare_microfacet(bsdf, ALPHA, DISTRIBUTION, DERIVED, at, err);
}

/* A pair of directions seen with wo above: areas are those of |cos|. */
struct pair {
    double eta; /* index beyond over index on wo's side */
    double cos_o, area_o, cos_i, area_i;
};

static double cosines_over_g2(const struct pair *p)
{
    return microfacet_cosines_over_g2(p->cos_o, p->area_o, p->cos_i, p->area_i);
}

static bool eval_reflection(const struct bsdf *bsdf, const struct microfacet *mf,
                            const struct pair *p, struct direction o, struct direction i,
                            struct bsdf_value *out)
{
    struct direction h = direction_mad(o, 1.0, i);
    double length = sqrt(direction_dot(h, h)), cos_t;
    double d = microfacet_d(mf, direction_scale(h, 1.0 / length));
    double fresnel = fresnel_dielectric(fmin(1.0, 0.5 * length), p->eta, &cos_t);
    double share = 0.25 * d * fresnel; /* [Walter07 Eqs. 14 and 20] */
    out->f = rgb_scale(bsdf_kind_rgb(bsdf, REFLECTANCE), share / cosines_over_g2(p));
    out->pdf = share / p->area_o;
    out->pdf_rev = share / p->area_i;
    return !rgb_is_black(out->f);
}

/* [Walter07 Eqs. 16, 17 and 21] */
static bool eval_refraction(const struct bsdf *bsdf, const struct microfacet *mf,
                            const struct pair *p, struct direction o, struct direction i,
                            enum transport mode, struct bsdf_value *out)
{
    struct direction h = direction_mad(o, p->eta, i);
    double length2 = direction_dot(h, h), sign = p->eta > 1.0 ? -1.0 : 1.0;
    h = direction_scale(h, sign / sqrt(length2));
    double cos_oh = direction_dot(o, h), cos_ih = -direction_dot(i, h);
    if (!(cos_oh > 0.0 && cos_ih > 0.0))
        return false;
    double fresnel = fresnel_dielectric_cosines(cos_oh, cos_ih, p->eta);
    double share = (1.0 - fresnel) * microfacet_d(mf, h) * cos_oh * cos_ih / length2;
    double eta2 = p->eta * p->eta;
    /* For radiance eta^2 of the Jacobian cancels against 1/eta^2 of the solid angle. */
    double scale = mode == TRANSPORT_RADIANCE ? share : share * eta2;
    out->f = rgb_scale(bsdf_kind_rgb(bsdf, TRANSMITTANCE), scale / cosines_over_g2(p));
    out->pdf = share * eta2 / p->area_o;
    out->pdf_rev = share / p->area_i;
    return !rgb_is_black(out->f);
}

static bool eval(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                 enum transport mode, struct bsdf_value *out)
{
    if (wo.z == 0.0f || wi.z == 0.0f)
        return bsdf_kind_no_value(out);
    struct microfacet mf = bsdf_kind_microfacet(bsdf, DERIVED);
    struct direction o = direction_from(wo), i = direction_from(wi);
    double eta = bsdf->param[ETA];
    if (o.z < 0.0) {
        o = direction_flip(o);
        i = direction_flip(i);
        eta = 1.0 / eta;
    }
    struct direction above = {i.x, i.y, fabs(i.z)};
    struct pair p = {eta, o.z, microfacet_area(&mf, o), above.z,
                     microfacet_area(&mf, above)};
    bool any = i.z > 0.0 ? eval_reflection(bsdf, &mf, &p, o, i, out)
                         : eval_refraction(bsdf, &mf, &p, o, i, mode, out);
    return any ? true : bsdf_kind_no_value(out);
}

/* Scatters o at facet h: fills wi (for wo above), pdfs, weight. */
static bool scatter(const struct bsdf *bsdf, const struct microfacet *mf, double eta,
                    struct direction o, struct direction h, double u_lobe,
                    enum transport mode, struct bsdf_sample *out)
{
    double cos_oh = fmin(1.0, direction_dot(o, h)), cos_t;
    if (cos_oh <= 0.0)
        return false;
    double fresnel = fresnel_dielectric(cos_oh, eta, &cos_t);
    bool transmission = !(u_lobe < fresnel);
    /* [Walter07 Eqs. 39 and 40] */
    struct direction i = transmission
                             ? direction_mad(direction_scale(o, -1.0 / eta),
                                             cos_oh / eta - cos_t, h)
                             : direction_mad(direction_scale(o, -1.0), 2.0 * cos_oh, h);
    out->wi = direction_to_vec3(i);
    out->transmission = transmission;
    if (transmission ? out->wi.z >= 0.0f : out->wi.z <= 0.0f)
        return false;
    i.z = fabs(i.z);
    struct pair p = {eta, o.z, microfacet_area(mf, o), i.z, microfacet_area(mf, i)};
    double weight = p.cos_i * p.area_o / cosines_over_g2(&p);
    double d = microfacet_d(mf, h), share = 0.25 * d * fresnel, forward = share;
    if (transmission) {
        double length = cos_oh - eta * cos_t; /* [Walter07 Eqs. 17 and 38] */
        share = (1.0 - fresnel) * d * cos_oh * cos_t / (length * length);
        forward = share * eta * eta;
        if (mode == TRANSPORT_RADIANCE)
            weight /= eta * eta;
    }
    out->pdf = forward / p.area_o;
    out->pdf_rev = share / p.area_i;
    out->weight = rgb_scale(
        bsdf_kind_rgb(bsdf, transmission ? TRANSMITTANCE : REFLECTANCE), weight);
    return out->pdf > 0.0 && !rgb_is_black(out->weight);
}

static bool sample(const struct bsdf *bsdf, struct vec3 wo, const double u[3],
                   enum transport mode, struct bsdf_sample *out)
{
    *out = (struct bsdf_sample){0};
    if (wo.z == 0.0f)
        return false;
    struct microfacet mf = bsdf_kind_microfacet(bsdf, DERIVED);
    struct direction o = direction_from(wo);
    o.z = fabs(o.z);
    double eta = wo.z > 0.0f ? bsdf->param[ETA] : 1.0 / bsdf->param[ETA];
    struct direction h = microfacet_sample(&mf, o, u + 1);
    if (!scatter(bsdf, &mf, eta, o, h, u[0], mode, out))
        return bsdf_kind_no_sample(out);
    if (wo.z < 0.0f)
        out->wi.z = -out->wi.z;
    return true;
}

/* The facet first, then the lobe's number by Fresnel's law there. */
static bool invert(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi, bool delta,
                   double choice, double u[3])
{
    (void)choice;
    struct microfacet mf = bsdf_kind_microfacet(bsdf, DERIVED);
    struct direction o = direction_from(wo), i = direction_from(wi);
    double eta = wo.z > 0.0f ? bsdf->param[ETA] : 1.0 / bsdf->param[ETA], cos_t;
    if (o.z < 0.0) {
        o = direction_flip(o);
        i = direction_flip(i);
    }
    bool transmits = i.z < 0.0;
    /* The half vectors [Walter07 Eqs. 13 and 16], on the upper side. */
    struct direction h = direction_mad(o, transmits ? eta : 1.0, i);
    double sign = transmits && eta > 1.0 ? -1.0 : 1.0;
    h = direction_scale(h, sign / sqrt(direction_dot(h, h)));
    double cos_oh = fmin(1.0, direction_dot(o, h));
    if (delta || !(cos_oh > 0.0) || !microfacet_invert(&mf, o, h, u + 1))
        return false;
    double fresnel = fresnel_dielectric(cos_oh, eta, &cos_t);
    return transmits ? bsdf_kind_invert_lobe(fresnel, 1.0, u)
                     : bsdf_kind_invert_lobe(0.0, fresnel, u);
}

const struct bsdf_type bsdf_type_roughdielectric = {
    .name = "roughdielectric",
    .params = params,
    .places = 14,
    .prepare = prepare,
    .eval = eval,
    .sample = sample,
    .invert = invert,
};

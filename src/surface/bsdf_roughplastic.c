/* The same as plastic with a rough coat (Mitsuba's roughplastic): the coat reflects by
 * microfacets, and the transmittance T of the coat replaces 1 - F. T is the transmitted
 * albedo of rough glass, tabulated once per material; where a texture gives alpha,
 * for some alphas. */

#include "math/warp.h"
#include "surface/bsdf_kind.h"
#include "surface/fresnel.h"

enum {
    REFLECTANCE = 0,
    SPECULAR = 3,
    ETA = 6,
    NONLINEAR = 7,
    ALPHA = 8,
    DISTRIBUTION = 11,
    DERIVED = 12,
    INNER = 15,
    SHARE = 16,
    BASE = 17,
    TABLE_OF = 20, /* eta and the derived three that the table is of */
    TABLE = 24,
    TEXTURED = 36, /* 1: alpha comes from a texture, and */
    TABLES = 37    /* tables of some alphas are interpolated */
};

#define INV_PI (1.0 / MATH_PI)
#define KNOTS  12 /* of the table, at cos = (k / (KNOTS - 1))^2 */
#define ALPHAS 5  /* of TABLES, (k / (ALPHAS - 1))^2 */
#define GRID   32 /* strata of each number that a knot is averaged over */

static const struct bsdf_param params[] = {
    {"reflectance", REFLECTANCE, 3, {0.5, 0.5, 0.5}, 0.0, 1.0},
    {"specular", SPECULAR, 3, {1.0, 1.0, 1.0}, 0.0, 1.0},
    {"eta", ETA, 1, {1.5}, 1.002, 20.0},
    {"nonlinear", NONLINEAR, 1, {0.0}, 0.0, 1.0},
    BSDF_KIND_ALPHA_ROWS(ALPHA, MICROFACET_ALPHA_MIN),
    BSDF_KIND_DISTRIBUTION_ROW(DISTRIBUTION),
    {.name = NULL},
};

/* Transmitted albedo of rough glass: the mean over visible normals of (1 - F) G2 / G1
 * [Walter07 Eq. 41]. The lobe is not sampled: strata of its number would round F. */
static double transmitted(const struct microfacet *mf, double eta, double cosine)
{
    struct direction o = {sqrt(fmax(0.0, 1.0 - cosine * cosine)), 0.0, cosine};
    double sum = 0.0, area_o = microfacet_area(mf, o);
    for (int k = 0; k < GRID * GRID; k++) {
        int column = k % GRID, row = k / GRID;
        const double u[2] = {(column + 0.5) / GRID, (row + 0.5) / GRID};
        struct direction h = microfacet_sample(mf, o, u);
        double cos_h = fmin(1.0, direction_dot(o, h)), cos_t;
        if (cos_h <= 0.0)
            continue;
        double fresnel = fresnel_dielectric(cos_h, eta, &cos_t);
        struct direction i = direction_mad(direction_scale(o, -1.0 / eta),
                                           cos_h / eta - cos_t, h);
        struct direction above = {i.x, i.y, -i.z}; /* [Walter07 Eq. 40] */
        if (above.z <= 0.0)
            continue;
        double over_g2 = microfacet_cosines_over_g2(o.z, area_o, above.z,
                                                    microfacet_area(mf, above));
        sum += (1.0 - fresnel) * above.z * area_o / over_g2;
    }
    return fmin(1.0, sum / (GRID * GRID));
}

/* T of these microfacets at all knots. */
static void fill_knots(const struct microfacet *mf, double eta, double *table)
{
    for (int k = 0; k < KNOTS; k++) {
        double x = fmax(1e-3, (double)k / (KNOTS - 1));
        table[k] = transmitted(mf, eta, x * x);
    }
}

static bool has_textured_alpha(const struct bsdf *bsdf)
{
    for (int i = 0; i < BSDF_TEXTURES && bsdf->bound[i].texture; i++)
        if (bsdf->bound[i].param->offset >= ALPHA &&
            bsdf->bound[i].param->offset < DISTRIBUTION)
            return true;
    return false;
}

static void fill_tables(struct bsdf *bsdf)
{
    double *p = bsdf->param;
    struct microfacet mf = bsdf_kind_microfacet(bsdf, DERIVED);
    p[TEXTURED] = 1.0;
    for (int k = 0; k < ALPHAS; k++) {
        double x = (double)k / (ALPHAS - 1);
        mf.alpha_u = mf.alpha_v = fmax(1e-3, x * x);
        fill_knots(&mf, p[ETA], p + TABLES + (size_t)k * KNOTS);
    }
}

/* Mean of T over the hemisphere, weighted by the cosine: with x = sqrt(cos) the integral
 * of 4 x^3 T over [0,1], T being linear between the knots. */
static double mean_transmittance(const double *table)
{
    double sum = 0.0, h = 1.0 / (KNOTS - 1);
    for (int k = 0; k + 1 < KNOTS; k++) {
        double a = k * h, b = a + h, slope = (table[k + 1] - table[k]) / h;
        double a4 = a * a * a * a, b4 = b * b * b * b;
        sum += (table[k] - slope * a) * (b4 - a4) + 0.8 * slope * (b4 * b - a4 * a);
    }
    return sum;
}

/* What leaves from inside is what enters, by reciprocity, over eta^2; a white base then
 * gives back all that the coat lets in. */
static void set_inner(double *p)
{
    p[INNER] = 1.0 - mean_transmittance(p + TABLE) / (p[ETA] * p[ETA]);
}

/* The table of an alpha between those of TABLES, linear in its root; of two axes the root
 * of the mean square stands for both. */
static void interpolate_table(double *p)
{
    double u = p[DERIVED], v = p[DERIVED + 1];
    double x = sqrt(sqrt(0.5 * (u * u + v * v))) * (ALPHAS - 1);
    int k = x < ALPHAS - 2 ? (int)x : ALPHAS - 2;
    double share = fmin(x - k, 1.0);
    const double *low = p + TABLES + (size_t)k * KNOTS, *high = low + KNOTS;
    for (int i = 0; i < KNOTS; i++)
        p[TABLE + i] = low[i] + share * (high[i] - low[i]);
    set_inner(p);
}

static void fill_table(struct bsdf *bsdf)
{
    double *p = bsdf->param;
    const double of[4] = {p[ETA], p[DERIVED], p[DERIVED + 1], p[DERIVED + 2]};
    bool known = true;
    for (int i = 0; i < 4; i++) {
        known = known && p[TABLE_OF + i] == of[i];
        p[TABLE_OF + i] = of[i];
    }
    if (known)
        return;
    struct microfacet mf = bsdf_kind_microfacet(bsdf, DERIVED);
    fill_knots(&mf, p[ETA], p + TABLE);
    set_inner(p);
}

static bool prepare(struct bsdf *bsdf, const struct place *at, struct err *err)
{
    double *p = bsdf->param, eta2 = p[ETA] * p[ETA];
    double base = rgb_luminance(bsdf_kind_rgb(bsdf, REFLECTANCE));
    double coat = rgb_luminance(bsdf_kind_rgb(bsdf, SPECULAR));
    bsdf->flags = BSDF_BLACK;
    if (base + coat > 0.0) {
        p[SHARE] = coat / (base + coat);
        bsdf->flags = BSDF_REFLECTS | BSDF_U_DIRECTION;
        if (base > 0.0 && coat > 0.0)
            bsdf->flags |= BSDF_U_LOBE;
    }
    if (!bsdf_kind_prepare_microfacet(bsdf, ALPHA, DISTRIBUTION, DERIVED, at, err))
        return false;
    if (p[TEXTURED] == 1.0)
        interpolate_table(p);
    else
        fill_table(bsdf);
    if (has_textured_alpha(bsdf))
        fill_tables(bsdf);
    for (int i = 0; i < 3; i++) {
        double rho = p[REFLECTANCE + i];
        p[BASE + i] = rho * INV_PI /
                      (eta2 * (1.0 - p[INNER] * (p[NONLINEAR] > 0.5 ? rho : 1.0)));
    }
    return true;
}

static double passes(const struct bsdf *bsdf, double cosine)
{
    double x = sqrt(fmin(cosine, 1.0)) * (KNOTS - 1);
    int k = x < KNOTS - 2 ? (int)x : KNOTS - 2;
    const double *table = bsdf->param + TABLE + k;
    return table[0] + (x - k) * (table[1] - table[0]);
}

/* Probability of the coat lobe, from its transmittance. */
static double choose_coat(const struct bsdf *bsdf, double pass)
{
    double share = bsdf->param[SHARE];
    double coat = (1.0 - pass) * share, base = pass * (1.0 - share);
    return coat > 0.0 ? coat / (coat + base) : share > 0.0 && base == 0.0 ? 1.0 : 0.0;
}

/* Both directions above. */
static bool eval_above(const struct bsdf *bsdf, struct direction o, struct direction i,
                       struct bsdf_value *out)
{
    struct microfacet mf = bsdf_kind_microfacet(bsdf, DERIVED);
    struct direction h = direction_mad(o, 1.0, i);
    double length = sqrt(direction_dot(h, h)), cos_t;
    double d = microfacet_d(&mf, direction_scale(h, 1.0 / length));
    double fresnel = fresnel_dielectric(fmin(1.0, 0.5 * length), bsdf->param[ETA],
                                        &cos_t);
    double area_o = microfacet_area(&mf, o), area_i = microfacet_area(&mf, i);
    double pass_o = passes(bsdf, o.z), pass_i = passes(bsdf, i.z);
    /* [Walter07 Eq. 20] */
    double glossy = 0.25 * d * fresnel /
                    microfacet_cosines_over_g2(o.z, area_o, i.z, area_i);
    out->f = rgb_add(rgb_scale(bsdf_kind_rgb(bsdf, BASE), pass_o * pass_i),
                     rgb_scale(bsdf_kind_rgb(bsdf, SPECULAR), glossy));
    double coat_o = choose_coat(bsdf, pass_o), coat_i = choose_coat(bsdf, pass_i);
    out->pdf = coat_o * 0.25 * d / area_o + (1.0 - coat_o) * i.z * INV_PI;
    out->pdf_rev = coat_i * 0.25 * d / area_i + (1.0 - coat_i) * o.z * INV_PI;
    return out->pdf > 0.0 && !rgb_is_black(out->f) ? true : bsdf_kind_no_value(out);
}

static bool eval(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                 enum transport mode, struct bsdf_value *out)
{
    (void)mode;
    if (!((double)wo.z * (double)wi.z > 0.0) || bsdf->flags & BSDF_BLACK)
        return bsdf_kind_no_value(out);
    struct direction o = direction_from(wo), i = direction_from(wi);
    o.z = fabs(o.z);
    i.z = fabs(i.z);
    return eval_above(bsdf, o, i, out);
}

static bool sample(const struct bsdf *bsdf, struct vec3 wo, const double u[3],
                   enum transport mode, struct bsdf_sample *out)
{
    (void)mode;
    if (wo.z == 0.0f || bsdf->flags & BSDF_BLACK)
        return bsdf_kind_no_sample(out);
    struct microfacet mf = bsdf_kind_microfacet(bsdf, DERIVED);
    struct direction o = direction_from(wo);
    o.z = fabs(o.z);
    double coat = choose_coat(bsdf, passes(bsdf, o.z));
    bool base = bsdf->flags & BSDF_U_LOBE ? u[0] < 1.0 - coat : coat == 0.0;
    struct vec3 wi;
    if (base) {
        wi = warp_cosine(u + 1);
    } else {
        struct direction h = microfacet_sample(&mf, o, u + 1);
        wi = direction_to_vec3(direction_reflect(o, h));
    }
    struct bsdf_value v;
    if (wi.z <= 0.0f || !eval_above(bsdf, o, direction_from(wi), &v))
        return bsdf_kind_no_sample(out);
    double cos_i = (double)wi.z;
    wi.z = copysignf(wi.z, wo.z);
    *out = (struct bsdf_sample){.wi = wi,
                                .weight = rgb_scale(v.f, cos_i / v.pdf),
                                .pdf = v.pdf,
                                .pdf_rev = v.pdf_rev};
    return true;
}

/* Coat or base by its share of the density at wi. */
static bool invert(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi, bool delta,
                   double choice, double u[3])
{
    struct microfacet mf = bsdf_kind_microfacet(bsdf, DERIVED);
    struct bsdf_value v;
    int glossy;
    if (delta || !eval(bsdf, wo, wi, TRANSPORT_RADIANCE, &v))
        return false;
    double base = 1.0 - choose_coat(bsdf, passes(bsdf, fabs((double)wo.z)));
    double diffuse = base * fabs((double)wi.z) * INV_PI;
    const double share[2] = {diffuse, base < 1.0 ? fmax(0.0, v.pdf - diffuse) : 0.0};
    if (!bsdf_kind_choose(share, &choice, &glossy))
        return false;
    if (bsdf->flags & BSDF_U_LOBE &&
        !bsdf_kind_invert_lobe(glossy ? base : 0.0, glossy ? 1.0 : base, u))
        return false;
    return glossy ? bsdf_kind_invert_facet(&mf, wo, wi, u)
                  : bsdf_kind_invert_cosine(wi, u);
}

const struct bsdf_type bsdf_type_roughplastic = {
    .name = "roughplastic",
    .params = params,
    .places = 97,
    .prepare = prepare,
    .eval = eval,
    .sample = sample,
    .invert = invert,
};

/* A diffuse base under a smooth coat of a dielectric; both sides (Mitsuba's plastic). The
 * share 1 - F enters; light from the base is reflected repeatedly at the inner side of
 * the coat, with mean reflectance F_in:
 *     f = (1 - F(wo)) (1 - F(wi)) rho / (pi eta^2 (1 - F_in rho)),
 * or with F_in in place of F_in rho in the linear variant, which keeps the colour. The
 * coat itself is a delta lobe of weight F. */

#include "math/warp.h"
#include "surface/bsdf_kind.h"
#include "surface/fresnel.h"

enum {
    REFLECTANCE = 0,
    SPECULAR = 3,
    ETA = 6,
    NONLINEAR = 7,
    INNER = 8,     /* F_in */
    INNER_ETA = 9, /* of this eta */
    SHARE = 10,    /* of the coat among both */
    BASE = 11      /* f without (1 - F) (1 - F) */
};

#define INV_PI (1.0 / MATH_PI)

static const struct bsdf_param params[] = {
    {"reflectance", REFLECTANCE, 3, {0.5, 0.5, 0.5}, 0.0, 1.0},
    {"specular", SPECULAR, 3, {1.0, 1.0, 1.0}, 0.0, 1.0},
    {"eta", ETA, 1, {1.5}, 1.0, 20.0},
    {"nonlinear", NONLINEAR, 1, {0.0}, 0.0, 1.0},
    {.name = NULL},
};

static bool prepare(struct bsdf *bsdf, const struct place *at, struct err *err)
{
    (void)at, (void)err;
    double *p = bsdf->param, eta2 = p[ETA] * p[ETA];
    if (p[INNER_ETA] != p[ETA]) {
        /* F_in from the mean seen from outside, see surface/fresnel.h. */
        p[INNER] = 1.0 - (1.0 - fresnel_dielectric_mean(p[ETA])) / eta2;
        p[INNER_ETA] = p[ETA];
    }
    double base = rgb_luminance(bsdf_kind_rgb(bsdf, REFLECTANCE));
    double coat = p[ETA] > 1.0 ? rgb_luminance(bsdf_kind_rgb(bsdf, SPECULAR)) : 0.0;
    for (int i = 0; i < 3; i++) {
        double rho = p[REFLECTANCE + i];
        p[BASE + i] = rho * INV_PI /
                      (eta2 * (1.0 - p[INNER] * (p[NONLINEAR] > 0.5 ? rho : 1.0)));
    }
    bsdf->flags = BSDF_BLACK;
    if (base + coat == 0.0)
        return true;
    p[SHARE] = coat / (base + coat);
    bsdf->flags = BSDF_REFLECTS;
    if (base > 0.0)
        bsdf->flags |= BSDF_U_DIRECTION;
    if (coat > 0.0)
        bsdf->flags |= base > 0.0 ? BSDF_SOME_DELTA | BSDF_U_LOBE : BSDF_DELTA;
    return true;
}

static double coat_reflects(const struct bsdf *bsdf, float cosine)
{
    double cos_t;
    return fresnel_dielectric(fabs((double)cosine), bsdf->param[ETA], &cos_t);
}

/* Probability of the coat. */
static double choose_coat(const struct bsdf *bsdf, double fresnel)
{
    double share = bsdf->param[SHARE];
    double coat = fresnel * share, base = (1.0 - fresnel) * (1.0 - share);
    return coat > 0.0 ? coat / (coat + base) : 0.0;
}

static bool eval(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                 enum transport mode, struct bsdf_value *out)
{
    (void)mode;
    double cos_o = fabs((double)wo.z), cos_i = fabs((double)wi.z);
    if (!((double)wo.z * (double)wi.z > 0.0) || !(bsdf->flags & BSDF_U_DIRECTION))
        return bsdf_kind_no_value(out);
    double fo = coat_reflects(bsdf, wo.z), fi = coat_reflects(bsdf, wi.z);
    /* The f of this file's head [Jakob10, section 8.2, plastic]. */
    out->f = rgb_scale(bsdf_kind_rgb(bsdf, BASE), (1.0 - fo) * (1.0 - fi));
    out->pdf = (1.0 - choose_coat(bsdf, fo)) * cos_i * INV_PI;
    out->pdf_rev = (1.0 - choose_coat(bsdf, fi)) * cos_o * INV_PI;
    return out->pdf > 0.0 && !rgb_is_black(out->f) ? true : bsdf_kind_no_value(out);
}

static bool sample(const struct bsdf *bsdf, struct vec3 wo, const double u[3],
                   enum transport mode, struct bsdf_sample *out)
{
    if (wo.z == 0.0f || bsdf->flags & BSDF_BLACK)
        return bsdf_kind_no_sample(out);
    double fresnel = coat_reflects(bsdf, wo.z), coat = choose_coat(bsdf, fresnel);
    bool base = bsdf->flags & BSDF_U_LOBE ? u[0] < 1.0 - coat
                                          : (bsdf->flags & BSDF_U_DIRECTION) != 0;
    if (!base) {
        struct rgb weight = rgb_scale(bsdf_kind_rgb(bsdf, SPECULAR), fresnel / coat);
        return bsdf_kind_mirror_sample(wo, weight, coat, out);
    }
    struct vec3 wi = warp_cosine(u + 1);
    return bsdf_kind_sampled(bsdf, wo, wi, eval, mode, out);
}

static bool invert(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi, bool delta,
                   double choice, double u[3])
{
    (void)choice;
    if (wo.z * wi.z <= 0.0f || (delta && !bsdf_kind_is_mirror(wo, wi)))
        return false;
    double base = 1.0 - choose_coat(bsdf, coat_reflects(bsdf, wo.z));
    if (bsdf->flags & BSDF_U_LOBE &&
        !bsdf_kind_invert_lobe(delta ? base : 0.0, delta ? 1.0 : base, u))
        return false;
    return delta || bsdf_kind_invert_cosine(wi, u);
}

const struct bsdf_type bsdf_type_plastic = {
    .name = "plastic",
    .params = params,
    .places = 14,
    .prepare = prepare,
    .eval = eval,
    .sample = sample,
    .invert = invert,
};

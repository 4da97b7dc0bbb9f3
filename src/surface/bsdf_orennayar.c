/* Rough diffuse surfaces: grooves of Lambertian facets whose slope angles have the
 * standard deviation sigma [Oren94]; both sides. By default their "qualitative" model,
 * which pbrt and LuxRender use; `full` is the one that it simplifies, with the light that
 * facets send to each other. Sampled by the cosine. */

#include "math/warp.h"
#include "surface/bsdf_kind.h"

enum { REFLECTANCE = 0, SIGMA = 3, FULL = 4, TERM = 5 /* of sigma, see prepare */ };

#define INV_PI (1.0 / MATH_PI)

static const struct bsdf_param params[] = {
    {"reflectance", REFLECTANCE, 3, {0.5, 0.5, 0.5}, 0.0, 1.0},
    {"sigma", SIGMA, 1, {0.35}, 0.0, 0.5 * MATH_PI}, /* radians */
    {"full", FULL, 1, {0.0}, 0.0, 1.0},
    {.name = NULL},
};

static bool prepare(struct bsdf *bsdf, const struct place *at, struct err *err)
{
    (void)at, (void)err;
    double *p = bsdf->param, square = p[SIGMA] * p[SIGMA];
    /* C_1, and the factors of sigma in C_2, C_3 and the double scattering [Oren94]. */
    p[TERM] = 1.0 - 0.5 * square / (square + 0.33);
    p[TERM + 1] = 0.45 * square / (square + 0.09);
    p[TERM + 2] = 0.125 * square / (square + 0.09);
    p[TERM + 3] = 0.17 * square / (square + 0.13);
    bool black = rgb_is_black(bsdf_kind_rgb(bsdf, REFLECTANCE));
    bsdf->flags = black ? BSDF_BLACK : BSDF_REFLECTS | BSDF_U_DIRECTION;
    return true;
}

/* Both directions above; a is the larger angle to the normal, b the smaller. f pi / rho
 * of the qualitative model [Oren94]; along = cos(phi) sin a sin b. */
static double qualitative(const double *term, double along, double cos_b)
{
    return term[0] + term[1] * fmax(0.0, along) / cos_b;
}

/* f pi of the full model [Oren94] without the factors rho of single and rho^2 of double
 * scattering. */
static void full(const double *term, double along, double cos_a, double cos_b,
                 double scattered[2])
{
    double sin_a = sqrt(fmax(0.0, 1.0 - cos_a * cos_a));
    double sin_b = sqrt(fmax(0.0, 1.0 - cos_b * cos_b));
    double cos_phi = sin_b > 0.0 ? fmin(1.0, fmax(-1.0, along / (sin_a * sin_b))) : 0.0;
    double a = 2.0 * INV_PI * acos(fmin(1.0, cos_a));
    double b = 2.0 * INV_PI * acos(fmin(1.0, cos_b));
    double towards = sin_a - (cos_phi < 0.0 ? b * b * b : 0.0);
    double half = (sin_a + sin_b) / (cos_a + cos_b); /* tan of (a + b)/2 */
    scattered[0] = term[0] + term[1] * cos_phi * towards * sin_b / cos_b +
                   term[2] * a * a * b * b * (1.0 - fabs(cos_phi)) * half;
    scattered[1] = term[3] * (1.0 - cos_phi * b * b);
}

static bool eval(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                 enum transport mode, struct bsdf_value *out)
{
    (void)mode;
    double cos_o = (double)wo.z, cos_i = (double)wi.z;
    if (!(cos_o * cos_i > 0.0) || bsdf->flags & BSDF_BLACK)
        return bsdf_kind_no_value(out);
    cos_o = fabs(cos_o);
    cos_i = fabs(cos_i);
    double along = (double)wo.x * (double)wi.x + (double)wo.y * (double)wi.y;
    double cos_a = fmin(cos_o, cos_i), cos_b = fmax(cos_o, cos_i);
    double scattered[2] = {0.0, 0.0};
    if (bsdf->param[FULL] > 0.5)
        full(bsdf->param + TERM, along, cos_a, cos_b, scattered);
    else
        scattered[0] = qualitative(bsdf->param + TERM, along, cos_b);
    struct rgb rho = bsdf_kind_rgb(bsdf, REFLECTANCE);
    out->f = rgb_add(rgb_scale(rho, fmax(0.0, scattered[0]) * INV_PI),
                     rgb_scale(rgb_mul(rho, rho), scattered[1] * INV_PI));
    out->pdf = cos_i * INV_PI; /* [Pharr16, section 13.6.3] */
    out->pdf_rev = cos_o * INV_PI;
    return rgb_is_black(out->f) ? bsdf_kind_no_value(out) : true;
}

static bool sample(const struct bsdf *bsdf, struct vec3 wo, const double u[3],
                   enum transport mode, struct bsdf_sample *out)
{
    struct vec3 wi = warp_cosine(u + 1);
    if (wo.z == 0.0f || bsdf->flags & BSDF_BLACK)
        return bsdf_kind_no_sample(out);
    return bsdf_kind_sampled(bsdf, wo, wi, eval, mode, out);
}

static bool invert(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi, bool delta,
                   double choice, double u[3])
{
    (void)bsdf, (void)choice;
    return !delta && wo.z * wi.z > 0.0f && bsdf_kind_invert_cosine(wi, u);
}

const struct bsdf_type bsdf_type_orennayar = {
    .name = "orennayar",
    .params = params,
    .places = 9,
    .prepare = prepare,
    .eval = eval,
    .sample = sample,
    .invert = invert,
};

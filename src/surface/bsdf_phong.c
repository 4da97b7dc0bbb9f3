/* Lambert's law and a power of the cosine about the mirror direction, normalised so that
 * nothing is gained [LafortuneWillems94]; both sides (Mitsuba's phong). */

#include "math/warp.h"
#include "surface/bsdf_kind.h"
#include "surface/direction.h"

enum { KD = 0, KS = 3, EXPONENT = 6, SPECULAR = 7 };

#define INV_PI (1.0 / MATH_PI)

static const struct bsdf_param params[] = {
    {"kd", KD, 3, {0.5, 0.5, 0.5}, 0.0, 1.0},
    {"ks", KS, 3, {0.2, 0.2, 0.2}, 0.0, 1.0},
    {"exponent", EXPONENT, 1, {30.0}, 0.0, 1e6},
    {.name = NULL},
};

static bool prepare(struct bsdf *bsdf, const struct place *at, struct err *err)
{
    (void)at, (void)err;
    double kd = rgb_luminance(bsdf_kind_rgb(bsdf, KD));
    double ks = rgb_luminance(bsdf_kind_rgb(bsdf, KS));
    if (kd + ks == 0.0) {
        bsdf->flags = BSDF_BLACK;
        return true;
    }
    bsdf->param[SPECULAR] = ks / (kd + ks);
    bsdf->flags = BSDF_REFLECTS | BSDF_U_DIRECTION;
    if (kd > 0.0 && ks > 0.0)
        bsdf->flags |= BSDF_U_LOBE;
    return true;
}

static bool eval(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                 enum transport mode, struct bsdf_value *out)
{
    (void)mode;
    if (!((double)wo.z * (double)wi.z > 0.0) || bsdf->flags & BSDF_BLACK)
        return bsdf_kind_no_value(out);
    struct direction o = direction_from(wo), i = direction_from(wi);
    double n = bsdf->param[EXPONENT], specular = bsdf->param[SPECULAR];
    /* f = kd / pi + ks (n+2) / (2 pi) cos^n [LafortuneWillems94]. */
    double cosine = o.z * i.z - o.x * i.x - o.y * i.y;
    double lobe = cosine > 0.0 ? pow(fmin(cosine, 1.0), n) / (2.0 * MATH_PI) : 0.0;
    out->f = rgb_add(rgb_scale(bsdf_kind_rgb(bsdf, KD), INV_PI),
                     rgb_scale(bsdf_kind_rgb(bsdf, KS), (n + 2.0) * lobe));
    /* Mixture of cos / pi and (n+1) / (2 pi) cos^n [LafortuneWillems94]. */
    double narrow = specular * (n + 1.0) * lobe, wide = (1.0 - specular) * INV_PI;
    out->pdf = narrow + wide * fabs(i.z);
    out->pdf_rev = narrow + wide * fabs(o.z);
    return out->pdf > 0.0 && !rgb_is_black(out->f) ? true : bsdf_kind_no_value(out);
}

/* A direction about the mirror direction of o, o.z >= 0, with density proportional to
 * cos^n [LafortuneWillems94]. */
static struct direction sample_lobe(struct direction o, double n, const double u[2])
{
    double cosine = pow(1.0 - u[0], 1.0 / (n + 1.0)), phi = 2.0 * MATH_PI * u[1];
    double sine = sqrt(fmax(0.0, 1.0 - cosine * cosine));
    double x = sine * cos(phi), y = sine * sin(phi);
    /* Axes across the mirror direction r = (-o.x, -o.y, o.z). */
    double across = sqrt(o.x * o.x + o.y * o.y);
    double cx = across > 0.0 ? -o.x / across : 1.0;
    double cy = across > 0.0 ? -o.y / across : 0.0;
    struct direction r = {-o.x, -o.y, o.z};
    struct direction a = {cx * o.z, cy * o.z, -across}, b = {-cy, cx, 0.0};
    return direction_mad(direction_mad(direction_scale(r, cosine), x, a), y, b);
}

static bool sample(const struct bsdf *bsdf, struct vec3 wo, const double u[3],
                   enum transport mode, struct bsdf_sample *out)
{
    if (wo.z == 0.0f || bsdf->flags & BSDF_BLACK)
        return bsdf_kind_no_sample(out);
    struct direction o = direction_from(wo);
    o.z = fabs(o.z);
    bool wide = !(bsdf->flags & BSDF_U_LOBE) ? bsdf->param[SPECULAR] == 0.0
                                             : u[0] >= bsdf->param[SPECULAR];
    struct vec3 wi = wide ? warp_cosine(u + 1)
                          : direction_to_vec3(
                                sample_lobe(o, bsdf->param[EXPONENT], u + 1));
    return bsdf_kind_sampled(bsdf, wo, wi, eval, mode, out);
}

/* u with which sample_lobe gives i: of cos^n about the mirror direction of o. */
static bool invert_lobe(struct direction o, struct direction i, double n, double u[2])
{
    double across = sqrt(o.x * o.x + o.y * o.y);
    double cx = across > 0.0 ? -o.x / across : 1.0;
    double cy = across > 0.0 ? -o.y / across : 0.0;
    struct direction r = {-o.x, -o.y, o.z}, d = direction_mad(i, -1.0, r);
    struct direction a = {cx * o.z, cy * o.z, -across}, b = {-cy, cx, 0.0};
    /* 1 - cos = |i - r|^2 / 2, which does not cancel. */
    double versine = 0.5 * direction_dot(d, d);
    double turn = atan2(direction_dot(i, b), direction_dot(i, a)) / (2.0 * MATH_PI);
    u[0] = -expm1((n + 1.0) * log1p(-versine)); /* 1 - cos^(n+1) [LafortuneWillems94] */
    u[1] = turn < 0.0 ? turn + 1.0 : turn;
    return versine < 1.0 && warp_in_square(u);
}

/* One of the two lobes by its share of the density at wi. */
static bool invert(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi, bool delta,
                   double choice, double u[3])
{
    struct bsdf_value v;
    int narrow;
    if (delta || !eval(bsdf, wo, wi, TRANSPORT_RADIANCE, &v))
        return false;
    struct direction o = direction_from(wo), i = direction_from(wi);
    o.z = fabs(o.z);
    i.z = fabs(i.z);
    double specular = bsdf->param[SPECULAR], wide = (1.0 - specular) * INV_PI * i.z;
    const double share[2] = {wide, specular > 0.0 ? fmax(0.0, v.pdf - wide) : 0.0};
    if (!bsdf_kind_choose(share, &choice, &narrow))
        return false;
    if (bsdf->flags & BSDF_U_LOBE &&
        !bsdf_kind_invert_lobe(narrow ? 0.0 : specular, narrow ? specular : 1.0, u))
        return false;
    return narrow ? invert_lobe(o, i, bsdf->param[EXPONENT], u + 1)
                  : bsdf_kind_invert_cosine(wi, u);
}

const struct bsdf_type bsdf_type_phong = {
    .name = "phong",
    .params = params,
    .places = 8,
    .prepare = prepare,
    .eval = eval,
    .sample = sample,
    .invert = invert,
};

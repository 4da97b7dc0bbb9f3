#include "surface/microfacet.h"

#include "math/warp.h"

#define TWO_SQRT_PI 3.54490770181103205460

double microfacet_d(const struct microfacet *mf, struct direction m)
{
    if (m.z <= 0.0)
        return 0.0;
    double au = mf->alpha_u, av = mf->alpha_v, auv = au * av;
    double x = m.x * av, y = m.y * au, z = m.z * auv;
    double xy = x * x + y * y;
    if (mf->distribution == MICROFACET_GGX) {
        double q = xy + z * z;
        return auv * auv * auv / (MATH_PI * q * q); /* [Walter07 Eq. 33], stretched */
    }
    double z2 = m.z * m.z; /* [Walter07 Eq. 25], stretched */
    return exp(-xy / (z * z)) / (MATH_PI * auv * z2 * z2);
}

/* Length of w's tangential part after the surface is stretched to roughness 1: alpha_w
 * sin of [Heitz14 Eq. 80]. */
static double stretched_sine(const struct microfacet *mf, struct direction w)
{
    double x = mf->alpha_u * w.x, y = mf->alpha_v * w.y;
    return sqrt(x * x + y * y);
}

/* Visible area of slopes > x along a view (sine, z) of a unit-rough Beckmann surface: the
 * integral of (z + sine t) exp(-t^2)/sqrt(pi) from x to infinity. */
static double beckmann_beyond(double sine, double z, double x)
{
    return 0.5 * z * erfc(x) + sine * exp(-x * x) / TWO_SQRT_PI;
}

double microfacet_area(const struct microfacet *mf, struct direction w)
{
    double sine = stretched_sine(mf, w);
    if (mf->distribution == MICROFACET_GGX)
        return 0.5 * (w.z + sqrt(w.z * w.z + sine * sine)); /* [Heitz14 Eq. 86] */
    /* Beyond cot = 6 the masked part is below 1e-17. */
    return w.z >= 6.0 * sine ? w.z : beckmann_beyond(sine, w.z, -w.z / sine);
}

double microfacet_g1(const struct microfacet *mf, struct direction w)
{
    return w.z <= 0.0 ? 0.0 : w.z / microfacet_area(mf, w);
}

double microfacet_pdf(const struct microfacet *mf, struct direction wo,
                      struct direction m)
{
    double cosine = direction_dot(wo, m);
    if (cosine <= 0.0)
        return 0.0;
    return microfacet_d(mf, m) * cosine / microfacet_area(mf, wo); /* [Heitz18 Eq. 3] */
}

/* The view v after the surface is stretched to roughness 1; t1 = (cx,cy,0) is across it,
 * t2 = v x t1. */
static inline struct direction stretched_view(const struct microfacet *mf,
                                              struct direction wo, double *cx, double *cy)
{
    double vx = mf->alpha_u * wo.x, vy = mf->alpha_v * wo.y;
    double tangent2 = vx * vx + vy * vy;
    double scale = 1.0 / sqrt(tangent2 + wo.z * wo.z);
    double tangent = sqrt(tangent2);
    *cx = 1.0;
    *cy = 0.0;
    if (tangent > 0.0) {
        *cx = -vy / tangent;
        *cy = vx / tangent;
    }
    return (struct direction){vx * scale, vy * scale, wo.z * scale};
}

static struct direction sample_ggx(const struct microfacet *mf, struct direction wo,
                                   const double u[2])
{
    double cx, cy;
    struct direction v = stretched_view(mf, wo, &cx, &cy);
    /* A uniform point of the projected half disks [Heitz18, section 3]; the concentric
     * map keeps small steps of a chain small. */
    struct vec2 disk = warp_disk(u);
    double s = 0.5 * (1.0 + v.z), a = disk.x;
    double b = (1.0 - s) * sqrt(fmax(0.0, 1.0 - a * a)) + s * disk.y;
    double c = sqrt(fmax(0.0, 1.0 - a * a - b * b));
    struct direction n = {a * cx - b * v.z * cy + c * v.x,
                          a * cy + b * v.z * cx + c * v.y,
                          b * (v.x * cy - v.y * cx) + c * v.z};
    struct direction m = {mf->alpha_u * n.x, mf->alpha_v * n.y, fmax(0.0, n.z)};
    return direction_scale(m, 1.0 / sqrt(direction_dot(m, m)));
}

/* The steps of sample_ggx backwards. */
static void invert_ggx(const struct microfacet *mf, struct direction wo,
                       struct direction m, double u[2])
{
    double cx, cy;
    struct direction v = stretched_view(mf, wo, &cx, &cy);
    struct direction n = {m.x / mf->alpha_u, m.y / mf->alpha_v, m.z};
    n = direction_scale(n, 1.0 / sqrt(direction_dot(n, n)));
    double a = n.x * cx + n.y * cy;
    double b = (n.y * cx - n.x * cy) * v.z + n.z * (v.x * cy - v.y * cx);
    double s = 0.5 * (1.0 + v.z);
    b = (b - (1.0 - s) * sqrt(fmax(0.0, 1.0 - a * a))) / s;
    warp_disk_inverse((struct vec2){a, b}, u);
}

/* The inverse error function within 2e-3: where to start from [Winitzki08]. */
static double erf_inverse_rough(double y)
{
    double l = log((1.0 - y) * (1.0 + y));
    double h = 2.0 / (MATH_PI * 0.147) + 0.5 * l;
    return copysign(sqrt(sqrt(h * h - l / 0.147) - h), y);
}

/* The slope x along the view (sine, z) below which lies the share u of what is visible.
 * Bracketed Halley on the exact distribution; grazing has sqrt(-log(1-u)) in closed form
 * and normal incidence an inverse erf, the start lies between. */
static double beckmann_visible_slope(double sine, double z, double u)
{
    const double far = 6.5; /* exp(-far^2) < 1e-18 */
    double lo = z >= far * sine ? -far : -z / sine, hi = far;
    double total = z >= far * sine ? z : beckmann_beyond(sine, z, lo);
    double rest = fmax(1.0 - u, 0x1p-53), target = rest * total;
    double share = z / total;
    double y = fmin(fmax(2.0 * u - 1.0, -1.0 + 0x1p-52), 1.0 - 0x1p-52);
    double x = share * erf_inverse_rough(y) + (1.0 - share) * sqrt(-log(rest));
    for (int i = 0; i < 60; i++) {
        if (!(x > lo && x < hi))
            x = 0.5 * (lo + hi);
        double error = beckmann_beyond(sine, z, x) - target;
        if (error > 0.0)
            lo = x;
        else
            hi = x;
        double weight = z + sine * x;
        double slope = -2.0 / TWO_SQRT_PI * weight * exp(-x * x);
        double newton = error / slope;
        double halley = newton / (1.0 - 0.5 * newton * (sine / weight - 2.0 * x));
        double next = x - halley;
        /* Cubic convergence: the step after this one would be below 1e-14. */
        if (fabs(halley) < 1e-5 && next >= lo && next <= hi)
            return next;
        if (hi - lo < 1e-14)
            return x;
        x = next;
    }
    return x;
}

static struct direction sample_beckmann(const struct microfacet *mf, struct direction wo,
                                        const double u[2])
{
    double sine = stretched_sine(mf, wo);
    double cx = 1.0, cy = 0.0;
    if (sine > 0.0) {
        cx = mf->alpha_u * wo.x / sine;
        cy = mf->alpha_v * wo.y / sine;
    }
    double along = beckmann_visible_slope(sine, wo.z, u[0]);
    double across = beckmann_visible_slope(0.0, 1.0, u[1]);
    struct direction m = {mf->alpha_u * (along * cx - across * cy),
                          mf->alpha_v * (along * cy + across * cx), 1.0};
    return direction_scale(m, 1.0 / sqrt(direction_dot(m, m)));
}

/* Visible share of slopes below x: the steps of beckmann_visible_slope backwards. */
static double beckmann_share(double sine, double z, double x)
{
    const double far = 6.5;
    double total = z >= far * sine ? z : beckmann_beyond(sine, z, -z / sine);
    return 1.0 - beckmann_beyond(sine, z, x) / total;
}

static void invert_beckmann(const struct microfacet *mf, struct direction wo,
                            struct direction m, double u[2])
{
    double sine = stretched_sine(mf, wo);
    double cx = sine > 0.0 ? mf->alpha_u * wo.x / sine : 1.0;
    double cy = sine > 0.0 ? mf->alpha_v * wo.y / sine : 0.0;
    double x = m.x / (m.z * mf->alpha_u), y = m.y / (m.z * mf->alpha_v);
    u[0] = beckmann_share(sine, wo.z, x * cx + y * cy);
    u[1] = beckmann_share(0.0, 1.0, y * cx - x * cy);
}

bool microfacet_invert(const struct microfacet *mf, struct direction wo,
                       struct direction m, double u[2])
{
    if (!(m.z > 0.0 && direction_dot(wo, m) > 0.0))
        return false;
    if (mf->distribution == MICROFACET_GGX)
        invert_ggx(mf, wo, m, u);
    else
        invert_beckmann(mf, wo, m, u);
    return warp_in_square(u);
}

struct direction microfacet_sample(const struct microfacet *mf, struct direction wo,
                                   const double u[2])
{
    return mf->distribution == MICROFACET_GGX ? sample_ggx(mf, wo, u)
                                              : sample_beckmann(mf, wo, u);
}

double microfacet_roughness_to_alpha(double roughness)
{
    double x = log(fmax(roughness, 1e-3));
    return 1.62142 + x * (0.819955 + x * (0.1734 + x * (0.0171201 + x * 0.000640711)));
}

#include "surface/fresnel.h"

double fresnel_dielectric_cosines(double cos_o, double cos_t, double eta)
{
    double s = cos_o + eta * cos_t, p = eta * cos_o + cos_t;
    if (s == 0.0 || p == 0.0)
        return 1.0;
    double rs = (cos_o - eta * cos_t) / s; /* [BornWolf99, section 1.5.2] */
    double rp = (eta * cos_o - cos_t) / p;
    return 0.5 * (rs * rs + rp * rp);
}

double fresnel_dielectric(double cos_o, double eta, double *cos_t)
{
    /* Snell's law [BornWolf99, section 1.5.1]. */
    double sin2_t = (1.0 - cos_o * cos_o) / (eta * eta);
    if (sin2_t >= 1.0) {
        *cos_t = 0.0;
        return 1.0;
    }
    /* At eta = 1 the result must be exact; 1 - (1 - c^2) would round. */
    *cos_t = eta == 1.0 ? cos_o : sqrt(1.0 - sin2_t);
    return fresnel_dielectric_cosines(cos_o, *cos_t, eta);
}

/* Midpoints in x with cos = x^2: the square root at grazing is smooth in x. */
double fresnel_dielectric_mean(double eta)
{
    const int n = 200;
    double sum = 0.0;
    for (int i = 0; i < n; i++) {
        double x = (i + 0.5) / n, cos_t;
        sum += 4.0 * x * x * x * fresnel_dielectric(x * x, eta, &cos_t);
    }
    return sum / n;
}

/* With a^2 + b^2 the squared modulus of sqrt(index^2 - sin^2) and a its real part
 * [BornWolf99, section 14.4]. */
static double conductor_channel(double cos_o, double eta, double k)
{
    double cos2 = cos_o * cos_o, sin2 = 1.0 - cos2;
    double real = eta * eta - k * k - sin2;
    double imaginary = 2.0 * eta * k;
    double a2b2 = sqrt(real * real + imaginary * imaginary);
    double a = sqrt(fmax(0.0, 0.5 * (a2b2 + real)));
    double s1 = a2b2 + cos2, s2 = 2.0 * a * cos_o;
    if (s1 + s2 == 0.0)
        return 1.0;
    double rs = (s1 - s2) / (s1 + s2);
    double p1 = cos2 * a2b2 + sin2 * sin2, p2 = s2 * sin2;
    /* p1 = p2 = 0 only at normal incidence, where both polarisations agree. */
    double ratio = p1 + p2 == 0.0 ? 1.0 : (p1 - p2) / (p1 + p2);
    return fmax(0.0, 0.5 * rs * (1.0 + ratio)); /* index 1: not -1e-16 */
}

struct rgb fresnel_conductor(double cos_o, struct rgb eta, struct rgb k)
{
    double c = fmin(cos_o, 1.0);
    return rgb(conductor_channel(c, eta.r, k.r), conductor_channel(c, eta.g, k.g),
               conductor_channel(c, eta.b, k.b));
}

struct rgb fresnel_schlick(double cos_o, struct rgb f0)
{
    double m = fmax(0.0, 1.0 - cos_o), m2 = m * m, m5 = m2 * m2 * m;
    /* [Schlick94] */
    return rgb(f0.r + (1.0 - f0.r) * m5, f0.g + (1.0 - f0.g) * m5,
               f0.b + (1.0 - f0.b) * m5);
}

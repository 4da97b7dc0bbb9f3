#ifndef ETALON_TESTS_SUPPORT_STABILITY_FACETS_H
#define ETALON_TESTS_SUPPORT_STABILITY_FACETS_H

/* The directional albedo of rough metal and glass, written from the papers: nothing of
 * the program's surfaces is called. Of the light that facets of slope (p, q) alpha meet
 * [Walter07 Eq. 20 and 21, over half vectors]
 *     integral of P22 F G2 (o.m) / (cos_o m_z) dp dq,  P22 = 1 / (pi (1 + p^2 + q^2)^2),
 * GGX of unit roughness [Walter07 Eq. 33], G2 = 1 / (1 + Lambda_o + Lambda_i) [Heitz14].
 * In p = r cos(phi), q = r sin(phi), 1 / (1 + r^2) = v^2 the integrand is bounded: P22
 * dp dq = v dv dphi / pi. */

#include "support/stability_view.h"

#define STABILITY_FACETS_V   512 /* nodes of Gauss */
#define STABILITY_FACETS_PHI 512 /* midpoints of half a circle */

static inline double facets_lambda(double alpha, const double w[3])
{
    double tangent2 = (w[0] * w[0] + w[1] * w[1]) / (w[2] * w[2]);
    return 0.5 * (sqrt(1.0 + alpha * alpha * tangent2) - 1.0);
}

/* Reflectance of a facet met at this cosine, luminance. */
typedef double (*facets_fresnel)(double cosine);

static inline double facets_glass_fresnel(double c)
{
    double eta = 1.5, t = sqrt(1.0 - (1.0 - c * c) / (eta * eta));
    double s = (c - eta * t) / (c + eta * t), p = (eta * c - t) / (eta * c + t);
    return 0.5 * (s * s + p * p);
}

/* What one facet m, unit and met at cosine c, sends on of o: reflected and, if it is of
 * glass, refracted [radiance from behind over eta^2]; masked from either side. */
static inline double facets_one(double alpha, const double o[3], const double m[3],
                                double c, facets_fresnel fresnel, bool glass)
{
    double r = fresnel(c), lambda = facets_lambda(alpha, o), sum = 0.0, i[3];
    for (int k = 0; k < 3; k++)
        i[k] = 2.0 * c * m[k] - o[k];
    if (i[2] > 0.0)
        sum += r / (1.0 + lambda + facets_lambda(alpha, i));
    double eta = 1.5, t = sqrt(1.0 - (1.0 - c * c) / (eta * eta));
    for (int k = 0; k < 3; k++)
        i[k] = (c * m[k] - o[k]) / eta - t * m[k];
    if (glass && i[2] < 0.0)
        sum += (1.0 - r) / (eta * eta) / (1.0 + lambda + facets_lambda(alpha, i));
    return sum;
}

/* Under a white sky, seen `tilt` rad from the normal. */
static inline double facets_albedo(double alpha, double tilt, facets_fresnel fresnel,
                                   bool glass)
{
    const double o[3] = {sin(tilt), 0.0, cos(tilt)};
    size_t nodes = STABILITY_FACETS_V;
    gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(nodes);
    double sum = 0.0;
    for (size_t k = 0; k < nodes * STABILITY_FACETS_PHI; k++) {
        double v, w;
        gsl_integration_glfixed_point(0.0, 1.0, k % nodes, &v, &w, table);
        double phi = MATH_PI * ((double)(k / nodes) + 0.5) / STABILITY_FACETS_PHI;
        double r = alpha * sqrt(1.0 - v * v) / v, z = 1.0 / sqrt(1.0 + r * r);
        const double m[3] = {r * cos(phi) * z, r * sin(phi) * z, z};
        double c = o[0] * m[0] + o[2] * m[2];
        if (c > 0.0)
            sum += w * 2.0 * v / STABILITY_FACETS_PHI * c / (o[2] * z) *
                   facets_one(alpha, o, m, fmin(c, 1.0), fresnel, glass);
    }
    gsl_integration_glfixed_table_free(table);
    return sum;
}

static inline void stability_facets(double alpha, double degrees, facets_fresnel fresnel,
                                    bool glass, double cells[STABILITY_CELLS])
{
    stability_same(facets_albedo(alpha, degrees * MATH_PI / 180.0, fresnel, glass),
                   cells);
}

static inline void exact_rough_metal(double x, double cells[STABILITY_CELLS])
{
    stability_facets(x, STABILITY_TILT, stability_copper_seen, false, cells);
}

static inline void exact_rough_glass(double x, double cells[STABILITY_CELLS])
{
    stability_facets(x, STABILITY_TILT, facets_glass_fresnel, true, cells);
}

static inline void exact_low_metal(double x, double cells[STABILITY_CELLS])
{
    stability_facets(x, STABILITY_LOW, stability_copper_seen, false, cells);
}

static inline void exact_low_glass(double x, double cells[STABILITY_CELLS])
{
    stability_facets(x, STABILITY_LOW, facets_glass_fresnel, true, cells);
}

#endif

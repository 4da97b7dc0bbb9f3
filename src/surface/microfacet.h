#ifndef ETALON_SURFACE_MICROFACET_H
#define ETALON_SURFACE_MICROFACET_H

/* Rough interfaces as fields of tiny mirrors. All is written with the visible area
 *     sigma(w) = integral of D(m) max(0, w.m) dm = cos(w) (1 + Lambda(w))
 * [Heitz14], which is finite where Lambda is not: masking is
 * G1 = cos/sigma, the density of visible normals D max(0, w.m)/sigma, and nothing is
 * divided by a cosine. Directions are unit, on the upper side (z >= 0). */

#include "surface/direction.h"

#include <stdbool.h>

enum microfacet_distribution { MICROFACET_GGX = 0, MICROFACET_BECKMANN = 1 };

struct microfacet {
    double alpha_u, alpha_v; /* roughness along x and y, > 0 */
    enum microfacet_distribution distribution;
};

#define MICROFACET_ALPHA_MIN 1e-5
#define MICROFACET_ALPHA_MAX 10.0

/* Area of facets with normal m, per area of surface and solid angle [Walter07 Eq. 25 and
 * 33]; 0 for m below. */
double microfacet_d(const struct microfacet *mf, struct direction m);

/* sigma(w): exact for both (Beckmann by erf, not by the usual rational fit). */
double microfacet_area(const struct microfacet *mf, struct direction w);

/* Smith's masking of one direction; 0 at grazing. */
double microfacet_g1(const struct microfacet *mf, struct direction w);

/* cos_o cos_i / G2 with the height-correlated G2 = 1/(1 + Lambda_o + Lambda_i)
 * [Heitz14 Eq. 99], from both cosines and areas. */
static inline double microfacet_cosines_over_g2(double cos_o, double area_o, double cos_i,
                                                double area_i)
{
    return cos_i * area_o + cos_o * (area_i - cos_i);
}

/* Density of m among the normals visible from wo, per solid angle. */
double microfacet_pdf(const struct microfacet *mf, struct direction wo,
                      struct direction m);

/* A visible normal; wo.z > 0. GGX after [Heitz18]; Beckmann by inverting the exact
 * distribution of visible slopes [HeitzDEon14]. */
struct direction microfacet_sample(const struct microfacet *mf, struct direction wo,
                                   const double u[2]);

/* u with which microfacet_sample gives the visible normal m, the numbers of which are its
 * own: the map is one-to-one. False if there are none. */
bool microfacet_invert(const struct microfacet *mf, struct direction wo,
                       struct direction m, double u[2]);

/* pbrt v3's remaproughness: roughness in [0,1] -> alpha [Pharr16, section 8.4.2]. */
double microfacet_roughness_to_alpha(double roughness);

#endif

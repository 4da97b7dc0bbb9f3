#ifndef ETALON_SURFACE_FRESNEL_H
#define ETALON_SURFACE_FRESNEL_H

/* Reflectance of an interface for unpolarised light. */

#include "math/rgb.h"

/* cos_o >= 0 on the side of the path, eta = index beyond over index here; *cos_t >= 0 is
 * the cosine beyond (Snell). Total internal reflection: 1 and *cos_t = 0. The
 * amplitudes are those of [BornWolf99, section 1.5.2]. */
double fresnel_dielectric(double cos_o, double eta, double *cos_t);

/* Cosine-weighted mean over the hemisphere of the reflectance for light from outside (eta
 * > 1: from the thinner medium): the diffuse reflectance of the interface. From inside it
 * is 1 - (1 - mean)/eta^2. */
double fresnel_dielectric_mean(double eta);

/* The same from both cosines, which must obey Snell's law: exactly symmetric in the two
 * sides. 1 if both are zero. */
double fresnel_dielectric_cosines(double cos_o, double cos_t, double eta);

/* Complex index eta + i k over that of the side of the path, exact, per channel. */
struct rgb fresnel_conductor(double cos_o, struct rgb eta, struct rgb k);

/* f0 + (1-f0)(1-cos)^5 [Schlick94]. */
struct rgb fresnel_schlick(double cos_o, struct rgb f0);

#endif

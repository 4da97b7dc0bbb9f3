#ifndef ETALON_IMPORT_SPECTRUM_H
#define ETALON_IMPORT_SPECTRUM_H

/* Spectra to linear Rec. 709 as pbrt v3's RGB mode does it: XYZ by the CIE 1931 observer,
 * divided by the integral of y (a constant 1 becomes (1.205, .948, .909)). The observer
 * is the multi-lobe fit of Wyman, Sloan and Shirley, Simple Analytic Approximations to
 * the CIE XYZ Color Matching Functions, JCGT 2013. */

#include "base/err.h"
#include "math/rgb.h"

#include <stddef.h>

struct rgb spectrum_from_xyz(double x, double y, double z);
/* Pairs (wavelength in nm, value), interpolated linearly, constant beyond the ends; the
 * wavelengths must increase. False if they do not. */
bool spectrum_from_pairs(const double *pairs, size_t count, struct rgb *out);
/* How a format weighs a spectrum; zero: as above. */
struct spectrum_rule {
    bool d65;     /* seen under illuminant D65: a constant 1 becomes (1, 1, 1) */
    bool cut_off; /* 0 beyond the ends */
};
bool spectrum_from_pairs_by(const double *pairs, size_t count,
                            const struct spectrum_rule *rule, struct rgb *out);
/* A black body of that many kelvin, scaled so that its largest value is 1. */
struct rgb spectrum_from_blackbody(double kelvin);
/* Its mean radiance over the observer, W/(m^2 sr nm). */
struct rgb spectrum_from_blackbody_radiance(double kelvin);
/* A text file of pairs with # comments. */
bool spectrum_from_file(const char *path, const struct place *at, struct rgb *out,
                        struct err *err);
bool spectrum_from_file_by(const char *path, const struct spectrum_rule *rule,
                           const struct place *at, struct rgb *out, struct err *err);

#endif

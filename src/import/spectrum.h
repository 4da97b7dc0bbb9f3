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
/* Of luminance 1. */
struct rgb spectrum_from_chromaticity(double x, double y);
/* Pairs (wavelength in nm, value), interpolated linearly, constant beyond the ends; the
 * wavelengths must increase. False if they do not. */
bool spectrum_from_pairs(const double *pairs, size_t count, struct rgb *out);
/* The same list as a reflectance under D65 (or an index, or any number that multiplies
 * light), as pbrt v4 and Mitsuba 3 have it: a constant is grey. */
bool spectrum_reflectance_from_pairs(const double *pairs, size_t count, struct rgb *out);
/* A black body of that many kelvin, scaled so that its largest value is 1. */
struct rgb spectrum_from_blackbody(double kelvin);
/* A text file of pairs with # comments: the numbers, to be freed, or NULL. */
double *spectrum_read_file(const char *path, const struct place *at, size_t *pair_count,
                           struct err *err);

#endif

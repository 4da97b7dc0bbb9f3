#ifndef ETALON_IMPORT_SPECTRUM_NAMED_H
#define ETALON_IMPORT_SPECTRUM_NAMED_H

/* Spectra that pbrt v4 has by name: metal-Cu-eta, glass-BK7, stdillum-D65, ... */

#include "math/rgb.h"

#include <stdbool.h>
#include <stddef.h>

/* A metal's eta or k, or a glass's index: pairs (nm, value) as spectrum_from_pairs wants
 * them. False if there is none of that name. */
bool spectrum_named(const char *name, const double **pairs, size_t *count);
/* A CIE standard illuminant in linear Rec. 709, of luminance 1. */
bool spectrum_named_illuminant(const char *name, struct rgb *value);

#endif

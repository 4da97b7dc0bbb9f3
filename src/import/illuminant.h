#ifndef ETALON_IMPORT_ILLUMINANT_H
#define ETALON_IMPORT_ILLUMINANT_H

/* The relative spectral power of CIE standard illuminant D65 at a wavelength in nm: 100
 * at 560 nm, 0 outside 300 to 830 nm. Its table is CIE S 014-2, every 10 nm, between
 * which it is linear by definition. */
double illuminant_d65(double lambda);

#endif

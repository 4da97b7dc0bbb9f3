#ifndef ETALON_SURFACE_PERLIN_H
#define ETALON_SURFACE_PERLIN_H

/* Gradient noise, with the lattice of [Pharr16, section 10.6.1], whose sixteen gradients
 * are not quite those of [Perlin02]. Finite for |x|, |y|, |z| < 1e9. */

/* In (-1.1, 1.1); 0 at integers. */
double perlin_noise(double x, double y, double z);

/* Sum of `octaves` noises, each at 1.99 times the frequency of the one before and with
 * `roughness` times its weight; of their absolute values [Pharr16, section 10.6.3]. */
#define PERLIN_OCTAVES_MAX 32
double perlin_fbm(const double p[3], double roughness, int octaves);
double perlin_turbulence(const double p[3], double roughness, int octaves);

#endif

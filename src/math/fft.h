#ifndef ETALON_MATH_FFT_H
#define ETALON_MATH_FFT_H

/* The discrete Fourier transform by radix 2 [CooleyTukey65], in double precision. */

#include <complex.h>

/* In place: X_k = sum over j of x_j exp(-2 pi i j k / n). n: a power of two. */
void fft(double complex *x, int n);
/* Of a square of n rows of n numbers, along rows and columns. */
void fft_square(double complex *x, int n);

#endif

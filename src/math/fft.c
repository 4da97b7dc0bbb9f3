#include "math/fft.h"

#include "math/warp.h"

#include <assert.h>
#include <math.h>

#define FFT_MOST 4096

static void reorder(double complex *x, int n)
{
    for (int i = 1, j = 0; i < n; i++) {
        int bit = n >> 1;
        for (; j & bit; bit >>= 1)
            j ^= bit;
        j ^= bit;
        if (i < j) {
            double complex swap = x[i];
            x[i] = x[j];
            x[j] = swap;
        }
    }
}

void fft(double complex *x, int n)
{
    assert(n > 0 && (n & (n - 1)) == 0);
    reorder(x, n);
    for (int half = 1; half < n; half *= 2)
        for (int j = 0; j < half; j++) {
            double angle = -MATH_PI * j / half;
            double complex turn = cos(angle) + sin(angle) * (double complex)I;
            for (int i = j; i < n; i += 2 * half) {
                double complex odd = turn * x[i + half];
                x[i + half] = x[i] - odd;
                x[i] += odd;
            }
        }
}

void fft_square(double complex *x, int n)
{
    double complex column[FFT_MOST];
    assert(n <= FFT_MOST);
    for (int y = 0; y < n; y++)
        fft(x + (long)y * n, n);
    for (int u = 0; u < n; u++) {
        for (int y = 0; y < n; y++)
            column[y] = x[(long)y * n + u];
        fft(column, n);
        for (int y = 0; y < n; y++)
            x[(long)y * n + u] = column[y];
    }
}

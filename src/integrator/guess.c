#include "integrator/guess.h"

#include "math/box_blur.h"

#include <math.h>

#define BLUR_SAMPLES 16.0
#define BLUR_LEAST   1 /* pixels, radius */

void guess_weigh(double *luminance, int width, int height, double samples, double floor,
                 float *scale)
{
    double n = (double)width * height;
    int most = width > height ? width : height;
    double radius = 0.5 * (sqrt(BLUR_SAMPLES * n / fmax(samples, 1.0)) - 1.0);
    radius = fmin(fmax(ceil(radius), BLUR_LEAST), most);
    box_blur(luminance, width, height, (int)radius);
    for (long j = 0; j < (long)n; j++)
        scale[j] = (float)sqrt(n * (1.0 / (luminance[j] * luminance[j] + floor)));
}

#include "integrator/guess.h"

#include "base/mem.h"

#include <math.h>

#define BLUR_SAMPLES 16.0
#define BLUR_LEAST   1 /* pixels, radius */

/* Mean over a window of 2 radius + 1 values, fewer at the ends; values lie `stride`
 * apart. line: scratch of `count` values. */
static void blur_line(double *values, int count, long stride, int radius, double *line)
{
    double sum = 0.0;
    int have = 0;
    for (int i = 0; i < count; i++)
        line[i] = values[i * stride];
    for (int i = -radius; i < count; i++) {
        if (i + radius < count)
            sum += line[i + radius], have++;
        if (i - radius - 1 >= 0)
            sum -= line[i - radius - 1], have--;
        if (i >= 0)
            values[i * stride] = fmax(sum, 0.0) / have;
    }
}

static void blur(double *luminance, int width, int height, int radius)
{
    double *line = mem_alloc((size_t)(width > height ? width : height), sizeof *line);
    for (int y = 0; y < height; y++)
        blur_line(luminance + (long)y * width, width, 1, radius, line);
    for (int x = 0; x < width; x++)
        blur_line(luminance + x, height, width, radius, line);
    mem_free(line);
}

void guess_weigh(double *luminance, int width, int height, double samples, double floor,
                 float *scale)
{
    double n = (double)width * height;
    int most = width > height ? width : height;
    double radius = 0.5 * (sqrt(BLUR_SAMPLES * n / fmax(samples, 1.0)) - 1.0);
    radius = fmin(fmax(ceil(radius), BLUR_LEAST), most);
    blur(luminance, width, height, (int)radius);
    for (long j = 0; j < (long)n; j++)
        scale[j] = (float)sqrt(n * (1.0 / (luminance[j] * luminance[j] + floor)));
}

#include "math/box_blur.h"

#include "base/mem.h"

#include <math.h>

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

void box_blur(double *values, int width, int height, int radius)
{
    double *line = mem_alloc((size_t)(width > height ? width : height), sizeof *line);
    for (int y = 0; y < height; y++)
        blur_line(values + (long)y * width, width, 1, radius, line);
    for (int x = 0; x < width; x++)
        blur_line(values + x, height, width, radius, line);
    mem_free(line);
}

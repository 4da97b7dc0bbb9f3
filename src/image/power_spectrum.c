#include "image/power_spectrum.h"

#include "base/mem.h"
#include "math/fft.h"
#include "math/warp.h"

#include <math.h>

#define SIDE_LEAST 16
#define SIDE_MOST  256
/* Of a square; the window's main lobe lets its mean into those below. */
#define FIRST_FREQUENCY 1.5

struct sums {
    int side;
    double *window;         /* [side] */
    double complex *square; /* [side][side] */
    double power[SPECTRUM_BINS];
    double terms[SPECTRUM_BINS];
};

int power_spectrum_side(int width, int height)
{
    int least = width < height ? width : height, side = SIDE_MOST;
    while (side > least)
        side /= 2;
    return side >= SIDE_LEAST ? side : 0;
}

/* The bin from the highest down: bin 0 ends at 0.5 cycles per pixel. -1: none. */
static int bin_of(const struct sums *sums, int u, int v)
{
    int n = sums->side;
    double f = hypot(u <= n / 2 ? u : n - u, v <= n / 2 ? v : n - v) / n;
    if (f > 0.5 || f * n < FIRST_FREQUENCY)
        return -1;
    int bin = (int)(2.0 * log2(0.5 / f));
    return bin < SPECTRUM_BINS ? bin : -1;
}

static void add_square(struct sums *sums, const double *field, int width)
{
    int n = sums->side;
    for (int y = 0; y < n; y++)
        for (int x = 0; x < n; x++)
            sums->square[y * n + x] = field[(long)y * width + x] * sums->window[x] *
                                      sums->window[y];
    fft_square(sums->square, n);
    for (int v = 0; v < n; v++)
        for (int u = 0; u < n; u++) {
            int bin = bin_of(sums, u, v);
            double complex value = sums->square[v * n + u];
            if (bin < 0)
                continue;
            sums->power[bin] += creal(value) * creal(value) + cimag(value) * cimag(value);
            sums->terms[bin] += 1.0;
        }
}

/* How many squares cover a length, and where the i-th of them begins. */
static int squares_along(int length, int side)
{
    return length > side ? (2 * (length - side) + side - 1) / side + 1 : 1;
}

static int begin_of(int i, int count, int length, int side)
{
    return count > 1 ? (int)((long)i * (length - side) / (count - 1)) : 0;
}

static void add_squares(struct sums *sums, const double *field, int width, int height)
{
    int across = squares_along(width, sums->side);
    int down = squares_along(height, sums->side);
    for (int j = 0; j < down; j++)
        for (int i = 0; i < across; i++) {
            int x = begin_of(i, across, width, sums->side);
            int y = begin_of(j, down, height, sums->side);
            add_square(sums, field + (long)y * width + x, width);
        }
}

/* Energy of the window of a square. */
static double make_window(struct sums *sums)
{
    double energy = 0.0;
    for (int i = 0; i < sums->side; i++) {
        sums->window[i] = 0.5 - 0.5 * cos(2.0 * MATH_PI * i / sums->side);
        energy += sums->window[i] * sums->window[i];
    }
    return energy * energy;
}

bool power_spectrum_make(const double *field, int width, int height,
                         struct power_spectrum *spectrum)
{
    struct sums sums = {.side = power_spectrum_side(width, height)};
    *spectrum = (struct power_spectrum){0};
    if (sums.side == 0)
        return false;
    size_t n = (size_t)sums.side;
    sums.window = mem_alloc(n, sizeof *sums.window);
    sums.square = mem_alloc(n * n, sizeof *sums.square);
    double energy = make_window(&sums);
    add_squares(&sums, field, width, height);
    for (int bin = SPECTRUM_BINS - 1; bin >= 0; bin--) {
        if (sums.terms[bin] == 0.0)
            continue;
        spectrum->frequency[spectrum->count] = 0.5 * exp2(-0.5 * bin - 0.25);
        spectrum->power[spectrum->count++] = sums.power[bin] / sums.terms[bin] / energy;
    }
    mem_free(sums.window);
    mem_free(sums.square);
    return true;
}

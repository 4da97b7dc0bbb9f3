#include "surface/perlin.h"

#include <math.h>

/* The published permutation of 0 .. 255 [Perlin02]. */
static const unsigned char permutation[256] = {
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225,
    140, 36,  103, 30,  69,  142, 8,   99,  37,  240, 21,  10,  23,  190, 6,   148,
    247, 120, 234, 75,  0,   26,  197, 62,  94,  252, 219, 203, 117, 35,  11,  32,
    57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136, 171, 168, 68,  175,
    74,  165, 71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122,
    60,  211, 133, 230, 220, 105, 92,  41,  55,  46,  245, 40,  244, 102, 143, 54,
    65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,  18,  169,
    200, 196, 135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,
    52,  217, 226, 250, 124, 123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212,
    207, 206, 59,  227, 47,  16,  58,  17,  182, 189, 28,  42,  223, 183, 170, 213,
    119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,
    129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104,
    218, 246, 97,  228, 251, 34,  242, 193, 238, 210, 144, 12,  191, 179, 162, 241,
    81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,  181, 199, 106, 157,
    184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,
    222, 114, 67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180,
};

static const signed char gradients[16][3] = {
    {1, 1, 0},  {-1, 1, 0},  {1, -1, 0}, {-1, -1, 0}, {1, 0, 1},  {-1, 0, 1},
    {1, 0, -1}, {-1, 0, -1}, {0, 1, 1},  {0, -1, 1},  {0, 1, -1}, {0, -1, -1},
    {1, 1, 0},  {-1, 1, 0},  {0, 1, -1}, {0, -1, -1},
};

/* The lattice point's gradient times the vector from there. */
static double corner(const long cell[3], const double d[3], int i, int j, int k)
{
    unsigned h = permutation[(cell[0] + i) & 255];
    h = permutation[(h + (unsigned long)(cell[1] + j)) & 255];
    h = permutation[(h + (unsigned long)(cell[2] + k)) & 255];
    const signed char *g = gradients[h & 15];
    return g[0] * (d[0] - i) + g[1] * (d[1] - j) + g[2] * (d[2] - k);
}

static double between(double share, double a, double b)
{
    return (1.0 - share) * a + share * b;
}

/* Of the fifth degree: its first and second derivatives are 0 at both ends. */
static double smooth(double t)
{
    return t * t * t * (10.0 + t * (6.0 * t - 15.0));
}

double perlin_noise(double x, double y, double z)
{
    const double low[3] = {floor(x), floor(y), floor(z)};
    const double d[3] = {x - low[0], y - low[1], z - low[2]};
    const long cell[3] = {(long)low[0], (long)low[1], (long)low[2]};
    double plane[2], share_x = smooth(d[0]), share_y = smooth(d[1]);
    for (int k = 0; k < 2; k++)
        plane[k] = between(
            share_y, between(share_x, corner(cell, d, 0, 0, k), corner(cell, d, 1, 0, k)),
            between(share_x, corner(cell, d, 0, 1, k), corner(cell, d, 1, 1, k)));
    return between(smooth(d[2]), plane[0], plane[1]);
}

double perlin_fbm(const double p[3], double roughness, int octaves)
{
    double sum = 0.0, weight = 1.0, frequency = 1.0;
    for (int i = 0; i < octaves; i++) {
        sum += weight *
               perlin_noise(frequency * p[0], frequency * p[1], frequency * p[2]);
        frequency *= 1.99;
        weight *= roughness;
    }
    return sum;
}

double perlin_turbulence(const double p[3], double roughness, int octaves)
{
    double sum = 0.0, weight = 1.0, frequency = 1.0;
    for (int i = 0; i < octaves; i++) {
        sum += weight *
               fabs(perlin_noise(frequency * p[0], frequency * p[1], frequency * p[2]));
        frequency *= 1.99;
        weight *= roughness;
    }
    return sum;
}

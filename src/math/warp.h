#ifndef ETALON_MATH_WARP_H
#define ETALON_MATH_WARP_H

/* Warps of the unit square, each with its density and its inverse. u in [0,1)^2. The
 * forward ones run at every vertex and are inline and branch-free. An inverse of a point
 * that no u gives, or of one that is not a number, is outside of [0,1)^2 or not a number
 * (warp_in_square); that of the octahedron takes the nearest point. */

#include "math/vec3.h"

#include <stdbool.h>

#define MATH_PI 3.14159265358979323846

struct vec2 {
    double x, y;
};

#define WARP_BELOW_ONE 0x1.fffffffffffffp-1

static inline bool warp_in_square(const double u[2])
{
    return u[0] >= 0.0 && u[0] < 1.0 && u[1] >= 0.0 && u[1] < 1.0;
}

/* The number of [lo,hi) at share u of it, which is in [0,1). */
static inline double warp_within(double lo, double hi, double u)
{
    double x = lo + (hi - lo) * u;
    return x < hi ? x : nextafter(hi, lo);
}

/* u rounded into [0,1). */
static inline double warp_unit(double u)
{
    return u > 0.0 ? (u < WARP_BELOW_ONE ? u : WARP_BELOW_ONE) : 0.0;
}

/* Sine and cosine for |x| <= pi/4, with an error below 1e-15 (Taylor). Four times as fast
 * as the library's functions; every vertex of a path needs them. */
static inline struct vec2 warp_sine_cosine(double x)
{
    /* Taylor series by Estrin's scheme: short dependency chains. */
    double y = x * x, y2 = y * y, y4 = y2 * y2;
    double s01 = fma(y, 1.0 / 120.0, -1.0 / 6.0);
    double s23 = fma(y, 1.0 / 362880.0, -1.0 / 5040.0);
    double s45 = fma(y, 1.0 / 6227020800.0, -1.0 / 39916800.0);
    double s = fma(y4, fma(y2, -1.0 / 1307674368000.0, s45), fma(y2, s23, s01));
    double c01 = fma(y, 1.0 / 24.0, -0.5);
    double c23 = fma(y, 1.0 / 40320.0, -1.0 / 720.0);
    double c45 = fma(y, 1.0 / 479001600.0, -1.0 / 3628800.0);
    double c67 = fma(y, 1.0 / 20922789888000.0, -1.0 / 87178291200.0);
    double c = fma(y4, fma(y2, c67, c45), fma(y2, c23, c01));
    return (struct vec2){fma(x * y, s, x), fma(y, c, 1.0)};
}

/* (cos, sin) of 2 pi u, u in [0,1]; quarter turns are exact. */
static inline struct vec2 warp_circle(double u)
{
    int quadrant = (int)(4.0 * u + 0.5);
    struct vec2 p = warp_sine_cosine((4.0 * u - quadrant) * (MATH_PI / 2.0));
    double x = quadrant & 1 ? p.x : p.y;
    double y = quadrant & 1 ? p.y : p.x;
    return (struct vec2){(quadrant + 1) & 2 ? -x : x, quadrant & 2 ? -y : y};
}

/* Inverse of warp_circle for any length of p but 0: the angle as a share of a turn, in
 * [0,1], with a relative error below 2e-15. Three times as fast as the library's. */
static inline double warp_circle_inverse(struct vec2 p)
{
    double x = fabs(p.x), y = fabs(p.y);
    double low = x < y ? x : y, high = x < y ? y : x;
    /* atan(t) = pi/4 - atan((1 - t) / (1 + t)): |t| <= tan(pi/8). */
    bool wide = low > 0.41421356237309503 * high;
    double t = wide ? (high - low) / (high + low) : low / high;
    /* atan(t) / (2 pi t), interpolated at Chebyshev points of t^2; Estrin's scheme. */
    double z = t * t, z2 = z * z, z4 = z2 * z2;
    double c01 = fma(z, -0.053051647697120202, 0.15915494309189518);
    double c23 = fma(z, -0.022736417855343603, 0.031830988583964784);
    double c45 = fma(z, -0.014466435276031494, 0.017683783427314994);
    double c67 = fma(z, -0.010354531718281785, 0.012212800869806499);
    double c89 = fma(z, -0.004028964369873992, 0.0079969537741542678);
    double c = fma(z4, fma(z4, c89, fma(z2, c67, c45)), fma(z2, c23, c01));
    double turn = wide ? 0.125 - t * c : t * c; /* of the first eighth */
    turn = x < y ? 0.25 - turn : turn;
    turn = p.x < 0.0 ? 0.5 - turn : turn;
    return p.y < 0.0 ? 1.0 - turn : turn;
}

/* Unit disk, concentric [ShirleyChiu97]; density 1/pi. */
static inline struct vec2 warp_disk(const double u[2])
{
    double a = 2.0 * u[0] - 1.0, b = 2.0 * u[1] - 1.0;
    bool wide = fabs(a) > fabs(b);
    double r = wide ? a : b, other = wide ? b : a;
    struct vec2 p = warp_sine_cosine(MATH_PI / 4.0 * (other / (r == 0.0 ? 1.0 : r)));
    /* (r, phi = pi/4 b/a) or its mirror image [ShirleyChiu97]. */
    return (struct vec2){r * (wide ? p.y : p.x), r * (wide ? p.x : p.y)};
}
void warp_disk_inverse(struct vec2 p, double u[2]);

/* Hemisphere z > 0, density z/pi per solid angle: Malley's method, the disk lifted to the
 * sphere [Pharr16, section 13.6.3]. */
static inline struct vec3 warp_cosine(const double u[2])
{
    struct vec2 p = warp_disk(u);
    double a = fabs(2.0 * u[0] - 1.0), b = fabs(2.0 * u[1] - 1.0);
    double r = a > b ? a : b;
    /* z stays above 0 at the rim (u = 0), where the density is zero. */
    double square = (1.0 - r) * (1.0 + r);
    double z = sqrt(square > 0x1p-53 ? square : 0x1p-53);
    return (struct vec3){(float)p.x, (float)p.y, (float)z};
}
/* 0 for cos_theta <= 0. */
static inline double warp_cosine_pdf(float cos_theta)
{
    /* cos / pi [Pharr16, section 13.6.3]. */
    return cos_theta > 0.0f ? (double)cos_theta * (1.0 / MATH_PI) : 0.0;
}
void warp_cosine_inverse(struct vec3 w, double u[2]);

/* Whole sphere, density 1/(4 pi): z is uniform [Pharr16, section 13.6.1]. */
static inline struct vec3 warp_sphere(const double u[2])
{
    /* z = 1 - 2 u_0 [Pharr16, section 13.6.1]. */
    double r = 2.0 * sqrt(u[0] * (1.0 - u[0]));
    struct vec2 p = warp_circle(u[1]);
    return (struct vec3){(float)(r * p.x), (float)(r * p.y), (float)(1.0 - 2.0 * u[0])};
}
void warp_sphere_inverse(struct vec3 w, double u[2]);

/* A cell of a grid over the square of warp_octahedron, at most the grid's size beyond it:
 * past an edge lies the same edge, the other way round. */
static inline void warp_octahedron_wrap(int width, int height, int *x, int *y)
{
    if (*x < 0 || *x >= width) {
        *x = *x < 0 ? -1 - *x : 2 * width - 1 - *x;
        *y = height - 1 - *y;
    }
    if (*y < 0 || *y >= height) {
        *y = *y < 0 ? -1 - *y : 2 * height - 1 - *y;
        *x = width - 1 - *x;
    }
}

/* The same density by the octahedron unfolded into the square: +z is in the middle, -z in
 * all corners, and neighbours stay neighbours [Clarberg08]. d is unit. */
static inline void warp_octahedron(const double u[2], double d[3])
{
    double x = 2.0 * u[0] - 1.0, y = 2.0 * u[1] - 1.0;
    double side = 1.0 - (fabs(x) + fabs(y)); /* from the fold, that is the equator */
    double r = 1.0 - fabs(side);
    double turn = r == 0.0 ? 0.0
                           : (fabs(y) - fabs(x)) / r; /* eighths from the diagonal */
    double sine = r * sqrt(2.0 - r * r);
    struct vec2 p = warp_sine_cosine(turn * (MATH_PI / 4.0));
    /* cos and sin of pi/4 + that angle. */
    d[0] = copysign(sine * M_SQRT1_2 * (p.y - p.x), x);
    d[1] = copysign(sine * M_SQRT1_2 * (p.y + p.x), y);
    d[2] = copysign(1.0 - r * r, side);
}
static inline void warp_octahedron_inverse(const double d[3], double u[2])
{
    double x = fabs(d[0]), y = fabs(d[1]);
    double r = sqrt((x * x + y * y) / (1.0 + fabs(d[2]))); /* sqrt(1 - |z|) */
    double share = r == 0.0 ? 0.0 : 4.0 * warp_circle_inverse((struct vec2){x, y});
    double v = share * r, w = r - v;
    bool below = d[2] < 0.0;
    double a = below ? 1.0 - v : w, b = below ? 1.0 - w : v;
    u[0] = warp_unit(0.5 * (copysign(a, d[0]) + 1.0));
    u[1] = warp_unit(0.5 * (copysign(b, d[1]) + 1.0));
}

/* Barycentric weights (b0,b1) of a triangle's first two corners, uniform in area:
 * continuous both ways and free of square roots [Heitz19]. */
static inline struct vec2 warp_triangle(const double u[2])
{
    /* [Heitz19] */
    double half = 0.5 * (u[0] < u[1] ? u[0] : u[1]);
    return (struct vec2){u[0] < u[1] ? half : u[0] - half,
                         u[0] < u[1] ? u[1] - half : half};
}
void warp_triangle_inverse(struct vec2 b, double u[2]);

#endif

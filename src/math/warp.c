#include "math/warp.h"

/* What rounding puts beyond an end of [0,1) is that end. More than that is not mended:
 * the caller sees that the point has no number. */
#define ROUNDING 0x1p-50

static double rounded(double u)
{
    if (u < 0.0 && u >= -ROUNDING)
        return 0.0;
    return u >= 1.0 && u <= 1.0 + ROUNDING ? WARP_BELOW_ONE : u;
}

void warp_disk_inverse(struct vec2 p, double u[2])
{
    bool wide = fabs(p.x) > fabs(p.y);
    double major = wide ? p.x : p.y, minor = wide ? p.y : p.x;
    double r = copysign(hypot(p.x, p.y), major);
    double other = major == 0.0 ? 0.0 : r * atan(minor / major) * (4.0 / MATH_PI);
    u[0] = rounded(0.5 * ((wide ? r : other) + 1.0));
    u[1] = rounded(0.5 * ((wide ? other : r) + 1.0));
}

/* Where the disk is far from its centre, z tells the radius better than x and y do. */
#define COSINE_LOW 0.7

void warp_cosine_inverse(struct vec3 w, double u[2])
{
    double x = (double)w.x, y = (double)w.y, z = (double)w.z, scale = 1.0;
    if (z < COSINE_LOW)
        scale = sqrt(fmax(0.0, (1.0 - z) * (1.0 + z)) / (x * x + y * y));
    warp_disk_inverse((struct vec2){scale * x, scale * y}, u);
}

/* Near a pole, x and y tell the distance 1 - |z| from it better than z does. */
void warp_sphere_inverse(struct vec3 w, double u[2])
{
    double x = (double)w.x, y = (double)w.y, z = (double)w.z;
    double turn = atan2(y, x) * (0.5 / MATH_PI);
    double low = 0.5 * (fabs(z) > COSINE_LOW ? (x * x + y * y) / (1.0 + fabs(z))
                                             : 1.0 - fabs(z));
    u[0] = rounded(z > 0.0 ? low : 1.0 - low);
    u[1] = rounded(turn < 0.0 ? turn + 1.0 : turn);
}

void warp_triangle_inverse(struct vec2 b, double u[2])
{
    double both = b.x + b.y;
    u[0] = rounded(b.x < b.y ? 2.0 * b.x : both);
    u[1] = rounded(b.x < b.y ? both : 2.0 * b.y);
}

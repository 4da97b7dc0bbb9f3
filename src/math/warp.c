#include "math/warp.h"

void warp_disk_inverse(struct vec2 p, double u[2])
{
    bool wide = fabs(p.x) > fabs(p.y);
    double major = wide ? p.x : p.y, minor = wide ? p.y : p.x;
    double r = copysign(hypot(p.x, p.y), major);
    double other = major == 0.0 ? 0.0 : r * atan(minor / major) * (4.0 / MATH_PI);
    u[0] = warp_unit(0.5 * ((wide ? r : other) + 1.0));
    u[1] = warp_unit(0.5 * ((wide ? other : r) + 1.0));
}

void warp_cosine_inverse(struct vec3 w, double u[2])
{
    warp_disk_inverse((struct vec2){(double)w.x, (double)w.y}, u);
}

void warp_sphere_inverse(struct vec3 w, double u[2])
{
    double turn = atan2((double)w.y, (double)w.x) * (0.5 / MATH_PI);
    u[0] = warp_unit(0.5 * (1.0 - (double)w.z));
    u[1] = warp_unit(turn < 0.0 ? turn + 1.0 : turn);
}

void warp_triangle_inverse(struct vec2 b, double u[2])
{
    double both = b.x + b.y;
    u[0] = warp_unit(b.x < b.y ? 2.0 * b.x : both);
    u[1] = warp_unit(b.x < b.y ? both : 2.0 * b.y);
}

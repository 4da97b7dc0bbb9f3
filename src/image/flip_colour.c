#include "image/flip_colour.h"

#include <math.h>

/* Linear Rec. 709 to XYZ over that of white (1, 1, 1). */
static const double to_xyz[3][3] = {
    {10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0},
    {2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0},
    {1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0},
};

static void xyz_of(const double rgb[3], double xyz[3])
{
    for (int i = 0; i < 3; i++) {
        const double *m = to_xyz[i];
        xyz[i] = (m[0] * rgb[0] + m[1] * rgb[1] + m[2] * rgb[2]) / (m[0] + m[1] + m[2]);
    }
}

/* The inverse, by Cramer's rule. */
static void invert_matrix(const double m[3][3], double inverse[3][3])
{
    double c[3][3], determinant = 0.0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            c[i][j] = m[(i + 1) % 3][(j + 1) % 3] * m[(i + 2) % 3][(j + 2) % 3] -
                      m[(i + 1) % 3][(j + 2) % 3] * m[(i + 2) % 3][(j + 1) % 3];
    for (int j = 0; j < 3; j++)
        determinant += m[0][j] * c[0][j];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            inverse[i][j] = c[j][i] / determinant;
}

void flip_opponent(const double rgb[3], double out[3])
{
    double xyz[3];
    xyz_of(rgb, xyz);
    out[0] = 116.0 * xyz[1] - 16.0;
    out[1] = 500.0 * (xyz[0] - xyz[1]);
    out[2] = 200.0 * (xyz[1] - xyz[2]);
}

void flip_screen_init(struct flip_screen *screen)
{
    invert_matrix(to_xyz, screen->from_xyz);
    for (int i = 0; i < 3; i++)
        screen->white[i] = to_xyz[i][0] + to_xyz[i][1] + to_xyz[i][2];
}

void flip_screen_rgb(const struct flip_screen *screen, const double opponent[3],
                     double rgb[3])
{
    const double *white = screen->white;
    double y = (opponent[0] + 16.0) / 116.0;
    double xyz[3] = {white[0] * (y + opponent[1] / 500.0), white[1] * y,
                     white[2] * (y - opponent[2] / 200.0)};
    for (int c = 0; c < 3; c++) {
        const double *from = screen->from_xyz[c];
        double value = from[0] * xyz[0] + from[1] * xyz[1] + from[2] * xyz[2];
        rgb[c] = fmin(fmax(value, 0.0), 1.0);
    }
}

/* CIE L*a*b*. */
static double lab_curve(double t)
{
    const double delta = 6.0 / 29.0;
    return t > delta * delta * delta ? cbrt(t) : t / (3.0 * delta * delta) + 4.0 / 29.0;
}

void flip_hunt(const double rgb[3], double out[3])
{
    double xyz[3];
    xyz_of(rgb, xyz);
    double x = lab_curve(xyz[0]), y = lab_curve(xyz[1]), z = lab_curve(xyz[2]);
    out[0] = 116.0 * y - 16.0;
    out[1] = 0.01 * out[0] * 500.0 * (x - y);
    out[2] = 0.01 * out[0] * 200.0 * (y - z);
}

double flip_distance(const double a[3], const double b[3])
{
    return fabs(a[0] - b[0]) + hypot(a[1] - b[1], a[2] - b[2]);
}

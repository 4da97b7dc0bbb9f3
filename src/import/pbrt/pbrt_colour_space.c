#include "import/pbrt/pbrt_colour_space.h"

#include "base/text.h"
#include "import/pbrt/pbrt_scene.h"
#include "import/spectrum.h"
#include "import/suggest.h"

/* Chromaticities of the primaries and of white: ITU-R BT.709, SMPTE RP 431-2 with D65,
 * ITU-R BT.2020, SMPTE ST 2065-1. */
static const struct {
    const char *name;
    double x[4], y[4];
} spaces[] = {
    {"srgb", {0.64, 0.30, 0.15, 0.3127}, {0.33, 0.60, 0.06, 0.3290}},
    {"dci-p3", {0.680, 0.265, 0.150, 0.3127}, {0.320, 0.690, 0.060, 0.3290}},
    {"rec2020", {0.708, 0.170, 0.131, 0.3127}, {0.292, 0.797, 0.046, 0.3290}},
    {"aces2065-1", {0.7347, 0.0, 0.0001, 0.32168}, {0.2653, 1.0, -0.0770, 0.33767}},
};

#define SPACES (sizeof spaces / sizeof spaces[0])

bool pbrt_colour_space(struct pbrt *p, struct err *err)
{
    const char *known[SPACES + 1] = {0}, *name = pbrt_params_head(&p->params, 0);
    p->version = PBRT_V4;
    for (size_t i = 0; i < SPACES; i++) {
        known[i] = spaces[i].name;
        if (text_equal(name, spaces[i].name)) {
            p->state.colour_space = (int)i;
            return true;
        }
    }
    return suggest_fail(err, &p->params.head_places[0], "colour space", name, known);
}

static double det(const double a[3], const double b[3], const double c[3])
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) +
           c[0] * (a[1] * b[2] - a[2] * b[1]);
}

/* XYZ of the primaries, scaled so that all three make a white of Y = 1 (Cramer's rule).
 */
static void primaries(int space, double xyz[3][3])
{
    double white[3], *const c[4] = {xyz[0], xyz[1], xyz[2], white}, scale[3];
    for (int i = 0; i < 4; i++) {
        double x = spaces[space].x[i], y = spaces[space].y[i];
        c[i][0] = x;
        c[i][1] = y;
        c[i][2] = 1.0 - x - y;
    }
    for (int i = 0; i < 3; i++)
        white[i] /= spaces[space].y[3];
    double all = det(xyz[0], xyz[1], xyz[2]);
    scale[0] = det(white, xyz[1], xyz[2]) / all;
    scale[1] = det(xyz[0], white, xyz[2]) / all;
    scale[2] = det(xyz[0], xyz[1], white) / all;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            xyz[i][j] *= scale[i];
}

struct rgb pbrt_colour_space_light(int space, struct rgb value)
{
    const double v[3] = {value.r, value.g, value.b};
    double p[3][3], xyz[3];
    if (space == 0)
        return value;
    primaries(space, p);
    for (int i = 0; i < 3; i++)
        xyz[i] = v[0] * p[0][i] + v[1] * p[1][i] + v[2] * p[2][i];
    return spectrum_from_xyz(xyz[0], xyz[1], xyz[2]);
}

struct rgb pbrt_colour_space_reflectance(int space, struct rgb value)
{
    if (space == 0)
        return value;
    struct rgb white = pbrt_colour_space_light(space, rgb_grey(1.0));
    struct rgb lit = pbrt_colour_space_light(space, value);
    return rgb(lit.r / white.r, lit.g / white.g, lit.b / white.b);
}

#include "import/sky.h"

#include "import/spectrum.h"
#include "math/warp.h"

#include <math.h>

#define WIDTH        1024
#define HEIGHT       512
#define SUN_DIAMETER 0.5358 /* degrees */
#define SUN_GRID     64     /* points of the disk, each way */
#define HORIZON      1e-3   /* radians above it, where the model ends */
/* cd/m^2 of 1 W/(m^2 sr nm) at all wavelengths: 683 lm/W times the integral of y. */
#define CANDELAS (683.0 * 106.856895)

/* --- the sky: luminance and chromaticity [Preetham99, A.2] ----------------------------
 */

/* One quantity over the sky: its value at the zenith times F(theta, gamma) / F(0,
 * theta_sun). */
struct perez {
    double a, b, c, d, e, zenith, norm;
};

static double perez_f(const struct perez *p, double theta, double gamma)
{
    double cosine = cos(gamma);
    return (1.0 + p->a * exp(p->b / cos(theta))) *
           (1.0 + p->c * exp(p->d * gamma) + p->e * cosine * cosine);
}

/* a to e are linear in the turbidity. */
static struct perez perez_make(const double rows[5][2], double turbidity, double zenith,
                               double theta_sun)
{
    double v[5];
    for (int i = 0; i < 5; i++)
        v[i] = rows[i][0] * turbidity + rows[i][1];
    struct perez p = {v[0], v[1], v[2], v[3], v[4], zenith, 1.0};
    p.norm = perez_f(&p, 0.0, theta_sun);
    return p;
}

static double perez_at(const struct perez *p, double theta, double gamma)
{
    return p->zenith * perez_f(p, theta, gamma) / p->norm;
}

/* (T^2 T 1) M (s^3 s^2 s 1)^T */
static double zenith_chromaticity(const double m[3][4], double t, double s)
{
    double sum = 0.0, powers[3] = {t * t, t, 1.0};
    for (int i = 0; i < 3; i++)
        sum += powers[i] * (((m[i][0] * s + m[i][1]) * s + m[i][2]) * s + m[i][3]);
    return sum;
}

struct sky {
    double sun[3], theta_sun;
    struct perez luminance, x, y; /* kcd/m^2, and chromaticities */
};

static struct sky sky_make(const struct sky_options *options)
{
    static const double of_luminance[5][2] = {{0.1787, -1.4630},
                                              {-0.3554, 0.4275},
                                              {-0.0227, 5.3251},
                                              {0.1206, -2.5771},
                                              {-0.0670, 0.3703}};
    static const double of_x[5][2] = {{-0.0193, -0.2592},
                                      {-0.0665, 0.0008},
                                      {-0.0004, 0.2125},
                                      {-0.0641, -0.8989},
                                      {-0.0033, 0.0452}};
    static const double of_y[5][2] = {{-0.0167, -0.2608},
                                      {-0.0950, 0.0092},
                                      {-0.0079, 0.2102},
                                      {-0.0441, -1.6537},
                                      {-0.0109, 0.0529}};
    static const double zenith_x[3][4] = {{0.00166, -0.00375, 0.00209, 0.0},
                                          {-0.02903, 0.06377, -0.03202, 0.00394},
                                          {0.11693, -0.21196, 0.06052, 0.25886}};
    static const double zenith_y[3][4] = {{0.00275, -0.00610, 0.00317, 0.0},
                                          {-0.04214, 0.08970, -0.04153, 0.00516},
                                          {0.15346, -0.26756, 0.06670, 0.26688}};
    double t = options->turbidity;
    const double *d = options->sun;
    double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    struct sky sky = {.sun = {d[0] / length, d[1] / length, d[2] / length}};
    double s = sky.theta_sun = acos(fmin(fmax(sky.sun[2], 0.0), 1.0));
    double chi = (4.0 / 9.0 - t / 120.0) * (MATH_PI - 2.0 * s);
    double zenith = (4.0453 * t - 4.9710) * tan(chi) - 0.2155 * t + 2.4192;
    sky.luminance = perez_make(of_luminance, t, fmax(zenith, 0.0), s);
    sky.x = perez_make(of_x, t, zenith_chromaticity(zenith_x, t, s), s);
    sky.y = perez_make(of_y, t, zenith_chromaticity(zenith_y, t, s), s);
    return sky;
}

static struct rgb positive(struct rgb v)
{
    return rgb(fmax(v.r, 0.0), fmax(v.g, 0.0), fmax(v.b, 0.0));
}

static struct rgb sky_radiance(const struct sky *sky, double theta, double phi)
{
    theta = fmin(theta, 0.5 * MATH_PI - HORIZON);
    double cosine = sin(theta) * (cos(phi) * sky->sun[0] + sin(phi) * sky->sun[1]) +
                    cos(theta) * sky->sun[2];
    double gamma = acos(fmin(fmax(cosine, -1.0), 1.0));
    double luminance = fmax(perez_at(&sky->luminance, theta, gamma), 0.0);
    double x = perez_at(&sky->x, theta, gamma), y = perez_at(&sky->y, theta, gamma);
    double value = 1000.0 * luminance / CANDELAS;
    return positive(spectrum_from_xyz(value * x / y, value, value * (1.0 - x - y) / y));
}

/* --- the sun [Preetham99, A.1] --------------------------------------------------------
 */

/* Outside the atmosphere, W/(m^2 sr nm), and the absorption of ozone and of water vapour,
 * 1/cm, every 10 nm from 380 nm. */
static const struct {
    double radiance, ozone, vapour;
} solar[] = {
    {16559.0, 0.00083, 0},    {16233.7, 0.00117, 0},   {21127.5, 0.0015, 0},
    {25888.2, 0.00183, 0},    {25829.1, 0.00217, 0},   {24232.3, 0.0025, 0},
    {26760.5, 0.00283, 0},    {29658.3, 0.003, 0},     {30545.4, 0.006, 0},
    {30057.5, 0.009, 0},      {30663.7, 0.014, 0},     {28830.4, 0.021, 0},
    {28712.1, 0.03, 0},       {27825.0, 0.04, 0},      {27100.6, 0.048, 0},
    {27233.6, 0.063, 0},      {26361.3, 0.075, 0},     {25503.8, 0.085, 0},
    {25060.2, 0.103, 0},      {25311.6, 0.12, 0},      {25355.9, 0.12, 0},
    {25134.2, 0.115, 0},      {24631.5, 0.125, 0},     {24173.2, 0.12, 0},
    {23685.3, 0.105, 0},      {23212.1, 0.09, 0},      {22827.7, 0.079, 0},
    {22339.8, 0.067, 0},      {21970.2, 0.057, 0},     {21526.7, 0.048, 0},
    {21097.9, 0.036, 0},      {20728.3, 0.028, 0.016}, {20240.4, 0.023, 0.024},
    {19870.8, 0.018, 0.0125}, {19427.2, 0.014, 1.0},   {19072.4, 0.011, 0.87},
    {18628.9, 0.01, 0.061},   {18259.2, 0.009, 0.001},
};

#define SOLAR (sizeof solar / sizeof solar[0])

/* Rayleigh scattering, aerosols, ozone and water vapour on the way through the air. */
static double transmittance(size_t i, double mass, double turbidity)
{
    double micrometres = 0.380 + 0.010 * (double)i;
    double beta = 0.04608365822050 * turbidity - 0.04586025928522;
    double vapour = solar[i].vapour * 2.0 * mass; /* of 2 cm of water */
    return exp(-mass * 0.008735 * pow(micrometres, -4.08)) *
           exp(-mass * beta * pow(micrometres, -1.3)) *
           exp(-mass * solar[i].ozone * 0.35) *
           exp(-0.2385 * vapour / pow(1.0 + 20.07 * vapour, 0.45));
}

struct rgb sky_sun_radiance(const struct sky_options *options)
{
    struct sky sky = sky_make(options);
    double degrees = sky.theta_sun * 180.0 / MATH_PI;
    double mass = 1.0 / (cos(sky.theta_sun) + 0.15 * pow(93.885 - degrees, -1.253));
    double pairs[2 * SOLAR];
    struct rgb value = rgb_grey(0.0);
    for (size_t i = 0; i < SOLAR; i++) {
        pairs[2 * i] = 380.0 + 10.0 * (double)i;
        pairs[2 * i + 1] = solar[i].radiance * transmittance(i, mass, options->turbidity);
    }
    spectrum_from_pairs(pairs, SOLAR, &value);
    return positive(value);
}

/* --- the picture ----------------------------------------------------------------------
 */

static void fill_sky(struct texture_image *image, const struct sky *sky,
                     const struct sky_options *options)
{
    for (int y = 0; y < HEIGHT; y++) {
        double theta = (y + 0.5) * MATH_PI / HEIGHT;
        if (theta > 0.5 * MATH_PI && !options->ground)
            break;
        for (int x = 0; x < WIDTH; x++) {
            struct rgb v = rgb_scale(
                sky_radiance(sky, theta, (x + 0.5) * 2 * MATH_PI / WIDTH),
                options->sky_scale);
            float *texel = image->floats + 3 * ((size_t)y * WIDTH + (size_t)x);
            texel[0] = (float)v.r;
            texel[1] = (float)v.g;
            texel[2] = (float)v.b;
        }
    }
}

/* Adds this irradiance, from one direction, as radiance of the texel there. */
static void add_beam(struct texture_image *image, const double d[3],
                     struct rgb irradiance)
{
    double phi = atan2(d[1], d[0]), theta = acos(fmin(fmax(d[2], -1.0), 1.0));
    int x = (int)((phi < 0.0 ? phi + 2.0 * MATH_PI : phi) * WIDTH / (2.0 * MATH_PI));
    int y = (int)(theta * HEIGHT / MATH_PI);
    x = x >= WIDTH ? WIDTH - 1 : x;
    y = y >= HEIGHT ? HEIGHT - 1 : y;
    double solid = 2.0 * MATH_PI / WIDTH *
                   (cos(y * MATH_PI / HEIGHT) - cos((y + 1) * MATH_PI / HEIGHT));
    float *texel = image->floats + 3 * ((size_t)y * WIDTH + (size_t)x);
    texel[0] += (float)(irradiance.r / solid);
    texel[1] += (float)(irradiance.g / solid);
    texel[2] += (float)(irradiance.b / solid);
}

/* Equal shares from points of the disk, by equal areas. */
static void add_sun(struct texture_image *image, const struct sky *sky,
                    const struct sky_options *options)
{
    const double *s = sky->sun;
    double half = 0.5 * SUN_DIAMETER * MATH_PI / 180.0;
    double share = options->sun_scale * 2.0 * MATH_PI * (1.0 - cos(half)) /
                   (SUN_GRID * SUN_GRID);
    struct rgb beam = rgb_scale(sky_sun_radiance(options), share);
    double side = fabs(s[2]) < 0.9 ? 0.0 : 1.0; /* an axis that is not near the sun */
    double u[3] = {-s[1] * (1.0 - side), s[0] * (1.0 - side) - s[2] * side, s[1] * side};
    double length = sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    for (int i = 0; i < 3; i++)
        u[i] /= length;
    double v[3] = {s[1] * u[2] - s[2] * u[1], s[2] * u[0] - s[0] * u[2],
                   s[0] * u[1] - s[1] * u[0]};
    for (int k = 0; k < SUN_GRID * SUN_GRID; k++) {
        int ring = k / SUN_GRID, spoke = k % SUN_GRID;
        double r = options->sun_radius_scale * half * sqrt((ring + 0.5) / SUN_GRID);
        double a = 2.0 * MATH_PI * (spoke + 0.5) / SUN_GRID, d[3];
        for (int i = 0; i < 3; i++)
            d[i] = cos(r) * s[i] + sin(r) * (cos(a) * u[i] + sin(a) * v[i]);
        add_beam(image, d, beam);
    }
}

static bool has_room(const struct scene_desc *desc, const struct place *at,
                     struct err *err)
{
    int skies = 0;
    for (size_t i = 0; i < desc->light_count; i++)
        skies += desc->lights[i].map && !*desc->lights[i].map->path;
    return skies < SKY_MAX || err_set(err, ERR_VALUE, at, "more than %d skies", SKY_MAX);
}

bool sky_check(const struct scene_desc *desc, const struct sky_options *options,
               const struct place *at, struct err *err)
{
    if (!has_room(desc, at, err))
        return false;
    const double *s = options->sun;
    if (!(s[0] * s[0] + s[1] * s[1] + s[2] * s[2] > 0.0))
        return err_set(err, ERR_VALUE, at, "the sun's direction is none");
    if (!(s[2] >= 0.0))
        return err_set(err, ERR_VALUE, at,
                       "the sun is below the horizon, where the sky's model ends");
    if (!(options->turbidity >= 1.0 && options->turbidity <= 30.0))
        return err_set(err, ERR_VALUE, at, "the turbidity %g is not within 1 and 30",
                       options->turbidity);
    return (options->sky_scale >= 0.0 && options->sun_scale >= 0.0 &&
            options->sun_radius_scale >= 0.0 && options->sun_radius_scale <= 100.0) ||
           err_set(err, ERR_VALUE, at, "a scale of sun or sky is negative or too large");
}

const struct texture_image *sky_picture(struct texture_set *set,
                                        const struct sky_options *options)
{
    struct texture_image *image = texture_image_create(set, WIDTH, HEIGHT);
    struct sky sky = sky_make(options);
    if (options->sky_scale > 0.0)
        fill_sky(image, &sky, options);
    if (options->sun_scale > 0.0)
        add_sun(image, &sky, options);
    return image;
}

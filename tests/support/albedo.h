#ifndef ETALON_TESTS_SUPPORT_ALBEDO_H
#define ETALON_TESTS_SUPPORT_ALBEDO_H

/* Integrals over directions that do not rely on any sampling: polar coordinates about
 * the centre of the lobe, with panels that shrink towards it by powers of two, cut
 * exactly at the horizon. Sees lobes down to 1e-6 rad. */

#include "math/rgb.h"
#include "math/warp.h"
#include "surface/bsdf.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#define ALBEDO_LEVELS 24 /* innermost panel: pi/2^24 */

/* Polar coordinates (t, phi) about c; a lies in the plane of c and the normal, b
 * across. side: +1 or -1, the half of the sphere that c belongs to. */
struct albedo_polar {
    double c[3], a[3], b[3];
    double side;
};

/* Summed into out[4] with the given weight; w is unit, on the side asked for. */
typedef void (*albedo_integrand)(const void *context, struct vec3 w, double weight,
                                 double out[4]);

static inline double albedo_param(const struct bsdf *bsdf, const char *name, double other)
{
    const struct bsdf_param *p = bsdf_param_find(bsdf->type, name);
    return p && p->count == 1 ? bsdf->param[p->offset] : other;
}

/* About the mirror direction, or the refracted one (the horizon if there is none). */
static inline struct albedo_polar albedo_polar_init(const struct bsdf *bsdf,
                                                    struct vec3 wo, bool transmission)
{
    double x = (double)wo.x, y = (double)wo.y, z = (double)wo.z;
    double sine = hypot(x, y), ux = sine > 0.0 ? -x / sine : 1.0;
    double uy = sine > 0.0 ? -y / sine : 0.0;
    if (transmission) {
        double eta = albedo_param(bsdf, "eta", 1.0);
        sine = fmin(1.0, sine / (z > 0.0 ? eta : 1.0 / eta));
    }
    double side = transmission == (z > 0.0) ? -1.0 : 1.0;
    double cosine = sqrt((1.0 - sine) * (1.0 + sine));
    if (!transmission)
        cosine = fabs(z);
    return (struct albedo_polar){{ux * sine, uy * sine, side * cosine},
                                 {ux * cosine, uy * cosine, -side * sine},
                                 {-uy, ux, 0.0},
                                 side};
}

static inline void albedo_polar_of(const struct albedo_polar *p, struct vec3 w, double *t,
                                   double *phi)
{
    double v[3] = {(double)w.x, (double)w.y, (double)w.z}, d2 = 0.0, a = 0.0, b = 0.0;
    for (int i = 0; i < 3; i++) {
        d2 += (v[i] - p->c[i]) * (v[i] - p->c[i]);
        a += v[i] * p->a[i];
        b += v[i] * p->b[i];
    }
    *t = 2.0 * asin(fmin(1.0, 0.5 * sqrt(d2)));
    *phi = atan2(b, a);
}

/* Gauss-Legendre on [-1,1], positive half: 8 nodes and 5 (the last is the middle). */
static const double albedo_nodes8[4][2] = {{0.1834346424956498, 0.3626837833783620},
                                           {0.5255324099163290, 0.3137066458778873},
                                           {0.7966664774136267, 0.2223810344533745},
                                           {0.9602898564975363, 0.1012285362903763}};
static const double albedo_nodes5[3][2] = {{0.5384693101056831, 0.4786286704993665},
                                           {0.9061798459386640, 0.2369268850561891},
                                           {0.0, 0.5688888888888889}};

/* The k-th node of a rule of n in [lo, hi]; returns its weight. */
static inline double albedo_node(int n, int k, double lo, double hi, double *x)
{
    const double *node = n == 8 ? albedo_nodes8[k / 2] : albedo_nodes5[k / 2];
    double half = 0.5 * (hi - lo);
    *x = 0.5 * (lo + hi) + (k % 2 ? -half : half) * node[0];
    return half * node[1];
}

/* What is integrated, and how well. tolerance: absolute, per panel. */
struct albedo_problem {
    const struct albedo_polar *polar;
    albedo_integrand integrand;
    const void *context;
    double tolerance;
};

/* A rectangle of (t, phi) by n x n nodes, cut at the horizon. */
static inline void albedo_rule(const struct albedo_problem *problem, int n,
                               const double t[2], const double phi[2], double out[4])
{
    const struct albedo_polar *p = problem->polar;
    for (int i = 0; i < n; i++) {
        double angle, angle_weight = albedo_node(n, i, phi[0], phi[1], &angle);
        double ca = cos(angle), cb = sin(angle);
        /* z = c_z cos t + a_z cos(phi) sin t changes sign once. */
        double horizon = atan2(fabs(p->c[2]), -p->side * p->a[2] * ca);
        double end = fmin(t[1], horizon);
        if (end <= t[0])
            continue;
        for (int j = 0; j < n; j++) {
            double at, weight = albedo_node(n, j, t[0], end, &at);
            double s = sin(at), c = cos(at), w[3];
            for (int k = 0; k < 3; k++)
                w[k] = p->c[k] * c + (p->a[k] * ca + p->b[k] * cb) * s;
            problem->integrand(problem->context,
                               vec3((float)w[0], (float)w[1], (float)w[2]),
                               angle_weight * weight * s, out);
        }
    }
}

/* Adds the integral to out and returns a bound of its error; halves both ways while two
 * rules differ, which kinks (horizon, back of facets, critical angle) make them do. */
static inline double albedo_panel(const struct albedo_problem *problem, const double t[2],
                                  const double phi[2], int depth, double out[4])
{
    double fine[4] = {0}, coarse[4] = {0}, error = 0.0;
    albedo_rule(problem, 8, t, phi, fine);
    albedo_rule(problem, 5, t, phi, coarse);
    for (int i = 0; i < 4; i++)
        error = fmax(error, fabs(fine[i] - coarse[i]));
    if (error <= problem->tolerance || depth == 0) {
        for (int i = 0; i < 4; i++)
            out[i] += fine[i];
        return error;
    }
    error = 0.0;
    for (int i = 0; i < 4; i++) {
        double mid_t = 0.5 * (t[0] + t[1]), mid_phi = 0.5 * (phi[0] + phi[1]);
        const double part_t[2] = {i & 1 ? mid_t : t[0], i & 1 ? t[1] : mid_t};
        const double part_phi[2] = {i & 2 ? mid_phi : phi[0], i & 2 ? phi[1] : mid_phi};
        error += albedo_panel(problem, part_t, part_phi, depth - 1, out);
    }
    return error;
}

/* An eighth of the circle, [octant-4, octant-3] pi/4: panels shrink towards the plane of
 * incidence or the one across, where lobes and horizons at grazing angles are thin.
 * Returns the error. */
static inline double albedo_octant(const struct albedo_problem *problem,
                                   const double t[2], int octant, double out[4])
{
    const int levels = 11;
    double error = 0.0, eighth = 0.25 * MATH_PI;
    double plane = eighth * (octant - 4 + octant % 2);
    double away = octant % 2 ? -eighth : eighth;
    for (int level = 0; level < levels; level++) {
        double near = plane + (level + 1 < levels ? away * exp2(-level - 1) : 0.0);
        double far = plane + away * exp2(-level);
        const double phi[2] = {fmin(near, far), fmax(near, far)};
        error += albedo_panel(problem, t, phi, 5, out);
    }
    return error;
}

static inline double albedo_ring(int level)
{
    return level >= ALBEDO_LEVELS ? 0.0 : MATH_PI * exp2(-level);
}

/* The whole half sphere on the side of the centre. Returns the error. */
static inline double albedo_half_sphere(const struct albedo_problem *problem,
                                        double out[4])
{
    double error = 0.0;
    for (int level = 0; level < ALBEDO_LEVELS; level++)
        for (int octant = 0; octant < 8; octant++) {
            const double t[2] = {albedo_ring(level + 1), albedo_ring(level)};
            error += albedo_octant(problem, t, octant, out);
        }
    return error;
}

struct albedo_query {
    const struct bsdf *bsdf;
    struct vec3 wo;
    enum transport mode;
};

/* f |cos| and the pdf. */
static inline void albedo_scattering(const void *context, struct vec3 w, double weight,
                                     double out[4])
{
    const struct albedo_query *q = context;
    struct bsdf_value value;
    if (!bsdf_eval(q->bsdf, q->wo, w, q->mode, &value))
        return;
    double scale = weight * fabs((double)w.z);
    out[0] += value.f.r * scale;
    out[1] += value.f.g * scale;
    out[2] += value.f.b * scale;
    out[3] += value.pdf * weight;
}

/* Float directions blur a lobe of width alpha by 6e-8/alpha of itself: asking for more
 * would refine noise. */
static inline double albedo_tolerance(const struct bsdf *bsdf)
{
    double alpha = albedo_param(bsdf, "alpha", 1.0);
    alpha = fmin(alpha, fmin(albedo_param(bsdf, "alpha_u", 1.0),
                             albedo_param(bsdf, "alpha_v", 1.0))); /* fmin skips NaN */
    return 1e-6 + 1e-9 / fmax(alpha, 1e-5);
}

/* Integrals over both sides: albedo, and total[3] that of the pdf. Returns the error. */
static inline double albedo_totals(const struct albedo_query *query, double total[4])
{
    double error = 0.0;
    for (int transmission = 0; transmission < 2; transmission++) {
        struct albedo_polar polar = albedo_polar_init(query->bsdf, query->wo,
                                                      transmission != 0);
        struct albedo_problem problem = {&polar, albedo_scattering, query,
                                         albedo_tolerance(query->bsdf)};
        if (query->bsdf->flags & (transmission ? BSDF_TRANSMITS : BSDF_REFLECTS))
            error += albedo_half_sphere(&problem, total);
    }
    return error;
}

/* What delta lobes scatter: those of different directions or probabilities that the
 * lobe number finds, from one end to the other. */
static inline struct rgb albedo_delta(const struct albedo_query *q)
{
    enum { STEPS = 512, LOBES = 8 };
    struct rgb sum = {0.0, 0.0, 0.0};
    struct bsdf_sample seen[LOBES];
    int count = 0;
    for (int k = 0; k <= STEPS; k++) {
        const double u[3] = {fmin((double)k / STEPS, 1.0 - 0x1p-53), 0.5, 0.5};
        struct bsdf_sample s;
        bool known = false;
        if (!bsdf_sample(q->bsdf, q->wo, u, q->mode, &s) || !s.delta)
            continue;
        for (int i = 0; i < count; i++)
            known = known || (seen[i].wi.z == s.wi.z && seen[i].wi.x == s.wi.x &&
                              seen[i].pdf == s.pdf);
        if (known || count == LOBES)
            continue;
        seen[count++] = s;
        sum = rgb_add(sum, rgb_scale(s.weight, s.pdf));
    }
    return sum;
}

/* Directional albedo of wo: integral of f |cos wi| over all wi; *error (may be NULL)
 * bounds what is wrong with it. */
static inline struct rgb albedo_quadrature_error(const struct bsdf *bsdf, struct vec3 wo,
                                                 enum transport mode, double *error)
{
    struct albedo_query query = {bsdf, wo, mode};
    double total[4] = {0}, bound = 0.0;
    if (!(bsdf->flags & BSDF_DELTA))
        bound = albedo_totals(&query, total);
    if (bsdf->flags & (BSDF_DELTA | BSDF_SOME_DELTA)) {
        struct rgb sum = albedo_delta(&query);
        total[0] += sum.r;
        total[1] += sum.g;
        total[2] += sum.b;
    }
    if (error)
        *error = bound;
    return rgb(total[0], total[1], total[2]);
}

static inline struct rgb albedo_quadrature(const struct bsdf *bsdf, struct vec3 wo,
                                           enum transport mode)
{
    return albedo_quadrature_error(bsdf, wo, mode, NULL);
}

#endif

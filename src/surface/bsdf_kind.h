#ifndef ETALON_SURFACE_BSDF_KIND_H
#define ETALON_SURFACE_BSDF_KIND_H

/* For the files bsdf_<kind>.c and the table in bsdf.c only: the kinds, and what several
 * of them share. */

#include "surface/bsdf.h"
#include "math/warp.h"
#include "surface/microfacet.h"

#include <stddef.h>

extern const struct bsdf_type bsdf_type_black, bsdf_type_blend, bsdf_type_conductor,
    bsdf_type_dielectric, bsdf_type_diffuse, bsdf_type_mirror, bsdf_type_null,
    bsdf_type_orennayar, bsdf_type_phong, bsdf_type_plastic, bsdf_type_principled,
    bsdf_type_roughconductor, bsdf_type_roughdielectric, bsdf_type_roughplastic,
    bsdf_type_sides, bsdf_type_substrate, bsdf_type_thindielectric, bsdf_type_translucent,
    bsdf_type_uber;

static inline struct rgb bsdf_kind_rgb(const struct bsdf *bsdf, int offset)
{
    const double *p = bsdf->param + offset;
    return rgb(p[0], p[1], p[2]);
}

/* eval and sample of what scatters nothing. */
static inline bool bsdf_kind_no_value(struct bsdf_value *out)
{
    *out = (struct bsdf_value){0};
    return false;
}

static inline bool bsdf_kind_no_sample(struct bsdf_sample *out)
{
    *out = (struct bsdf_sample){0};
    return false;
}

/* The sample of a kind whose lobes, none of them a delta, share one density: what its
 * eval says of the direction wi, which was sampled on the upper side, turned to wo's. */
static inline bool
bsdf_kind_sampled(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                  bool (*eval)(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                               enum transport mode, struct bsdf_value *out),
                  enum transport mode, struct bsdf_sample *out)
{
    struct bsdf_value v;
    if (wi.z <= 0.0f)
        return bsdf_kind_no_sample(out);
    wi.z = copysignf(wi.z, wo.z);
    if (!eval(bsdf, wo, wi, mode, &v))
        return bsdf_kind_no_sample(out);
    *out = (struct bsdf_sample){.wi = wi,
                                .weight = rgb_scale(v.f, fabs((double)wi.z) / v.pdf),
                                .pdf = v.pdf,
                                .pdf_rev = v.pdf_rev};
    return true;
}

/* BSDF_REFLECTS and BSDF_TRANSMITS as the colours at these offsets have it, 0 for none.
 */
static inline unsigned bsdf_kind_sides(const struct bsdf *bsdf, int reflectance,
                                       int transmittance)
{
    bool reflects = !rgb_is_black(bsdf_kind_rgb(bsdf, reflectance));
    bool transmits = !rgb_is_black(bsdf_kind_rgb(bsdf, transmittance));
    return (reflects ? BSDF_REFLECTS : 0u) | (transmits ? BSDF_TRANSMITS : 0u);
}

/* ---- inverses of samples: bsdf_type.invert ---- */

/* The lobe's number, which comes uniform, becomes one of those in [lo,hi). False if there
 * are none. */
static inline bool bsdf_kind_invert_lobe(double lo, double hi, double u[3])
{
    u[0] = warp_within(lo, hi, u[0]);
    return lo < hi;
}

/* The numbers of a direction that follows the cosine, on either side. */
static inline bool bsdf_kind_invert_cosine(struct vec3 wi, double u[3])
{
    warp_cosine_inverse(vec3(wi.x, wi.y, fabsf(wi.z)), u + 1);
    return wi.z != 0.0f && warp_in_square(u + 1);
}

/* The numbers of the visible facet that reflects wo to wi, both on the same side. */
bool bsdf_kind_invert_facet(const struct microfacet *mf, struct vec3 wo, struct vec3 wi,
                            double u[3]);

/* Draws one of two by their weights, and leaves in *choice a uniform number. False if
 * both are 0. */
static inline bool bsdf_kind_choose(const double weight[2], double *choice, int *chosen)
{
    double sum = weight[0] + weight[1], first = weight[0] / sum;
    if (!(sum > 0.0 && sum < HUGE_VAL))
        return false;
    *chosen = *choice >= first;
    *choice = *chosen ? (*choice - first) / (1.0 - first) : *choice / first;
    *choice = fmin(*choice, WARP_BELOW_ONE);
    return true;
}

/* Whether two directions agree as far as those of the same delta lobe do, seen from both
 * ends: rounding, and what a grazing angle makes of it. */
bool bsdf_kind_same(struct vec3 a, struct vec3 b);

/* Whether a delta sends wo to wi by reflection, or by refraction
 * (bsdf_kind_refract_sample).
 */
static inline bool bsdf_kind_is_mirror(struct vec3 wo, struct vec3 wi)
{
    return wo.z * wi.z > 0.0f && bsdf_kind_same(wi, vec3(-wo.x, -wo.y, wo.z));
}
bool bsdf_kind_is_refraction(struct vec3 wo, struct vec3 wi, double eta, double cos_t);

/* The inverse of a kind with one delta lobe, the mirror; of one without any lobe. */
bool bsdf_kind_invert_mirror(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                             bool delta, double choice, double u[3]);
bool bsdf_kind_invert_nothing(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                              bool delta, double choice, double u[3]);

/* The eval of delta and black kinds. */
bool bsdf_kind_eval_nothing(const struct bsdf *bsdf, struct vec3 wo, struct vec3 wi,
                            enum transport mode, struct bsdf_value *out);

/* A delta reflection into the mirror direction. pdf: probability of the lobe. */
bool bsdf_kind_mirror_sample(struct vec3 wo, struct rgb weight, double pdf,
                             struct bsdf_sample *out);

/* A delta that goes straight on, or refracts: eta is the index beyond over the one on
 * wo's side, cos_t the cosine beyond. weight: without the 1/eta^2 of radiance. */
bool bsdf_kind_refract_sample(struct vec3 wo, double eta, double cos_t, struct rgb weight,
                              double pdf, enum transport mode, struct bsdf_sample *out);

/* Whether a parameter is one of those that make a kind anisotropic. */
bool bsdf_kind_is_axis(const char *param);

/* The sample of the straight lobe. */
bool bsdf_kind_straight_sample(struct vec3 wo, const struct bsdf_straight *straight,
                               struct bsdf_sample *out);

/* Flags of kinds with children: DELTA, SOME_DELTA, ONLY_STRAIGHT and everything that the
 * children ask for. */
unsigned bsdf_kind_children_flags(const struct bsdf *bsdf);

/* The rows that every rough kind has: roughness of both axes at once, or one by one
 * (NaN, the default, is "as alpha"). o: offset of alpha; it takes three places. */
#define BSDF_KIND_ALPHA_ROWS(o, least)                                         \
    {"alpha", (o), 1, {0.1}, (least), MICROFACET_ALPHA_MAX},                   \
        {"alpha_u", (o) + 1, 1, {(double)NAN}, (least), MICROFACET_ALPHA_MAX}, \
    {                                                                          \
        "alpha_v", (o) + 2, 1, {(double)NAN}, (least), MICROFACET_ALPHA_MAX    \
    }
#define BSDF_KIND_DISTRIBUTION_ROW(o)                                                 \
    {                                                                                 \
        "distribution", (o), 1, {MICROFACET_GGX}, MICROFACET_GGX, MICROFACET_BECKMANN \
    }

/* The roughness that those rows give. */
static inline struct microfacet bsdf_kind_roughness(const double *alpha)
{
    return (struct microfacet){isnan(alpha[1]) ? alpha[0] : alpha[1],
                               isnan(alpha[2]) ? alpha[0] : alpha[2], MICROFACET_GGX};
}

/* For prepare: writes alpha_u, alpha_v, distribution to param[derived] on and adds
 * BSDF_ANISOTROPIC to the flags. Fails if distribution is not a whole number. */
bool bsdf_kind_prepare_microfacet(struct bsdf *bsdf, int alpha, int distribution,
                                  int derived, const struct place *at, struct err *err);

static inline struct microfacet bsdf_kind_microfacet(const struct bsdf *bsdf, int derived)
{
    const double *p = bsdf->param + derived;
    return (struct microfacet){p[0], p[1],
                               p[2] > 0.5 ? MICROFACET_BECKMANN : MICROFACET_GGX};
}

#endif

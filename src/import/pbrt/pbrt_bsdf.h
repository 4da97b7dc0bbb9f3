#ifndef ETALON_IMPORT_PBRT_BSDF_H
#define ETALON_IMPORT_PBRT_BSDF_H

/* Shared by the readers of materials: p->params become parameters of a BSDF. */

#include "import/pbrt/pbrt_colour.h"

/* Copper's measured spectra in linear Rec. 709: what metals are of by default. */
extern const struct rgb pbrt_bsdf_copper_eta, pbrt_bsdf_copper_k;

struct pbrt_roughness {
    double alpha_u, alpha_v; /* of a microfacet distribution */
    /* Those of textures, or NULL; then the alpha is that of the texture's middle. */
    const struct texture *texture_u, *texture_v;
    bool smooth; /* 0 was written for both */
};

/* Begins a BSDF of a kind in the table of BSDFs. */
bool pbrt_bsdf_start(struct bsdf *bsdf, const char *kind, const struct place *at,
                     struct err *err);
bool pbrt_bsdf_set_rgb(struct bsdf *bsdf, const char *name, struct rgb value,
                       const struct place *at, struct err *err);
bool pbrt_bsdf_set_value(struct bsdf *bsdf, const char *name,
                         const struct pbrt_value *value, const struct place *at,
                         struct err *err);
/* The same of a single number, or a texture's luminance. */
bool pbrt_bsdf_set_number(struct bsdf *bsdf, const char *name,
                          const struct pbrt_value *value, const struct place *at,
                          struct err *err);
/* Times a factor, and times another value. */
struct pbrt_value pbrt_bsdf_scaled(struct pbrt *p, const struct pbrt_value *value,
                                   double factor);
struct pbrt_value pbrt_bsdf_product(struct pbrt *p, const struct pbrt_value *a,
                                    const struct pbrt_value *b);
/* 1 minus it. */
struct pbrt_value pbrt_bsdf_complement(struct pbrt *p, const struct pbrt_value *value);
bool pbrt_bsdf_set_roughness(struct bsdf *bsdf, const struct pbrt_roughness *roughness,
                             const struct place *at, struct err *err);
/* Reads a colour or its texture, grey `fallback` if there is neither, into the BSDF's
 * parameter `to`. */
bool pbrt_bsdf_pass(struct pbrt *p, const char *name, double fallback, struct bsdf *bsdf,
                    const char *to, const struct place *at, struct err *err);
/* Reads eta, or index as older files have it; *eta is untouched without either. */
bool pbrt_bsdf_eta(struct pbrt *p, double *eta, struct err *err);
/* An index of that name, a number or the mean of a spectrum. */
bool pbrt_bsdf_named_eta(struct pbrt *p, const char *name, double *eta, struct err *err);
/* "metal-Cu": of the built-in spectra, by v4's rule. */
bool pbrt_bsdf_named_metal(const char *metal, struct rgb *eta, struct rgb *k);
/* Reads uroughness and vroughness; `both` is a name that stands for the two, or NULL; the
 * prefix stands before all three. to_alpha is the version's own map, unless the file says
 * that they are alphas. */
bool pbrt_bsdf_roughness(struct pbrt *p, const char *prefix, const char *both,
                         double fallback, double (*to_alpha)(double roughness),
                         struct pbrt_roughness *roughness, struct err *err);

#endif

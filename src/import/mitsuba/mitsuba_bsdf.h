#ifndef ETALON_IMPORT_MITSUBA_BSDF_H
#define ETALON_IMPORT_MITSUBA_BSDF_H

/* What the readers of materials have in common: properties become parameters of a BSDF.
 */

#include "import/mitsuba/mitsuba_texture.h"

/* Begins a BSDF of a kind in the table of BSDFs. */
void mitsuba_bsdf_start(struct bsdf *bsdf, const char *kind);
bool mitsuba_bsdf_set_rgb(struct bsdf *bsdf, const char *name, struct rgb value,
                          const struct mitsuba_node *object, struct err *err);
bool mitsuba_bsdf_set_number(struct bsdf *bsdf, const char *name, double value,
                             const struct mitsuba_node *object, struct err *err);
bool mitsuba_bsdf_set_value(struct bsdf *bsdf, const char *name,
                            const struct mitsuba_value *value,
                            const struct mitsuba_node *object, struct err *err);
/* Reads a colour or its texture, grey `fallback` if there is neither, into the BSDF's
 * parameter `to`. */
bool mitsuba_bsdf_pass(struct mitsuba *m, struct mitsuba_node *object, const char *name,
                       double fallback, struct bsdf *bsdf, const char *to,
                       struct err *err);
/* Reads the microfacets: alpha, or alpha_u and alpha_v, and their distribution. */
bool mitsuba_bsdf_roughness(struct mitsuba *m, struct mitsuba_node *object,
                            struct bsdf *bsdf, struct err *err);

/* To the scene; *index of the desc. */
bool mitsuba_bsdf_add(struct mitsuba *m, struct bsdf *bsdf,
                      const struct mitsuba_node *object, int *index, struct err *err);
/* An opaque material, which Mitsuba lights from its front alone unless "twosided" is
 * around it. */
bool mitsuba_bsdf_add_opaque(struct mitsuba *m, struct bsdf *bsdf,
                             const struct mitsuba_node *object, int *index,
                             struct err *err);

#endif

#ifndef ETALON_IMPORT_MITSUBA_BSDF_H
#define ETALON_IMPORT_MITSUBA_BSDF_H

/* Shared by the readers of materials: properties become parameters of a BSDF. */

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

/* Adds the BSDF to the scene; *index: in the desc. */
bool mitsuba_bsdf_add(struct mitsuba *m, struct bsdf *bsdf,
                      const struct mitsuba_node *object, int *index, struct err *err);
/* Adds an opaque material; as in Mitsuba its back is black unless it is within
 * "twosided". */
bool mitsuba_bsdf_add_opaque(struct mitsuba *m, struct bsdf *bsdf,
                             const struct mitsuba_node *object, int *index,
                             struct err *err);

#endif

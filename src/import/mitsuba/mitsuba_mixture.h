#ifndef ETALON_IMPORT_MITSUBA_MIXTURE_H
#define ETALON_IMPORT_MITSUBA_MIXTURE_H

/* Materials made of others, which were read before them. */

#include "import/mitsuba/mitsuba_object.h"

#define MITSUBA_PARTS_MAX     32
#define MITSUBA_MATERIAL_NONE (-2) /* light passes through */

/* At least one; indices in the desc, or MITSUBA_MATERIAL_NONE. */
struct mitsuba_parts {
    int index[MITSUBA_PARTS_MAX];
    size_t count;
};

/* The first alone. */
bool mitsuba_mixture_first(struct mitsuba *m, struct mitsuba_node *object,
                           const struct mitsuba_parts *parts, int *index,
                           struct err *err);
/* One for both sides, or one for each. */
bool mitsuba_mixture_sides(struct mitsuba *m, struct mitsuba_node *object,
                           const struct mitsuba_parts *parts, int *index,
                           struct err *err);
/* Two, by a weight that may be a texture. */
bool mitsuba_mixture_blend(struct mitsuba *m, struct mitsuba_node *object,
                           const struct mitsuba_parts *parts, int *index,
                           struct err *err);
/* Any number, by a weight for each. */
bool mitsuba_mixture_weighted(struct mitsuba *m, struct mitsuba_node *object,
                              const struct mitsuba_parts *parts, int *index,
                              struct err *err);
/* A normal map over one; and a bump map. */
bool mitsuba_mixture_normals(struct mitsuba *m, struct mitsuba_node *object,
                             const struct mitsuba_parts *parts, int *index,
                             struct err *err);
bool mitsuba_mixture_bump(struct mitsuba *m, struct mitsuba_node *object,
                          const struct mitsuba_parts *parts, int *index, struct err *err);
/* One material with an opacity. */
bool mitsuba_mixture_mask(struct mitsuba *m, struct mitsuba_node *object,
                          const struct mitsuba_parts *parts, int *index, struct err *err);

#endif

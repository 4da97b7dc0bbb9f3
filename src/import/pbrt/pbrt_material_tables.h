#ifndef ETALON_IMPORT_PBRT_MATERIAL_TABLES_H
#define ETALON_IMPORT_PBRT_MATERIAL_TABLES_H

/* The tables of materials by the names of each version, one file a table. */

#include "import/pbrt/pbrt_state.h"

struct pbrt_material_row {
    const char *name; /* NULL ends a table */
    /* Fills *bsdf from p->params. NULL: known, taken as diffuse. */
    bool (*read)(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                 struct err *err);
};

extern const struct pbrt_material_row pbrt_material_v3[];
extern const struct pbrt_material_row pbrt_material_v4[];
extern const struct pbrt_material_row pbrt_material_lux[]; /* LuxRender's own */

/* Rows that let light through diffusely: of v3, of v4 and of LuxRender. */
bool pbrt_material_translucent(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                               struct err *err);
bool pbrt_material_diffuse_transmission(struct pbrt *p, const struct place *at,
                                        struct bsdf *bsdf, struct err *err);
bool pbrt_material_matte_translucent(struct pbrt *p, const struct place *at,
                                     struct bsdf *bsdf, struct err *err);

/* v3's row of this name, which LuxRender has under another. */
bool pbrt_material_v3_substrate(struct pbrt *p, const struct place *at, struct bsdf *bsdf,
                                struct err *err);

#endif

#ifndef ETALON_SURFACE_TEXTURE_KIND_H
#define ETALON_SURFACE_TEXTURE_KIND_H

/* What the kinds of textures are made with. */

#include "surface/texture.h"

typedef struct rgb (*texture_evaluator)(const struct texture *texture,
                                        const struct texture_point *at);

/* A texture of one node with the identity for uv and space. */
struct texture *texture_add(struct texture_set *set, texture_evaluator eval);
/* texture->of[index] = part; counts its nodes. */
void texture_set_part(struct texture *texture, int index, const struct texture *part);

/* The texture's own (u, v); a value outside the range of integers becomes 0. */
static inline void texture_place_uv(const struct texture *t,
                                    const struct texture_point *at, double *s, double *r)
{
    *s = t->uv[0][0] * at->u + t->uv[0][1] * at->v + t->uv[0][2];
    *r = t->uv[1][0] * at->u + t->uv[1][1] * at->v + t->uv[1][2];
    if (!(fabs(*s) < 1e9 && fabs(*r) < 1e9))
        *s = *r = 0.0;
}

#endif

#ifndef ETALON_SCENE_SKY_MAP_H
#define ETALON_SCENE_SKY_MAP_H

/* A picture of the whole sphere for lookups of directions: over longitude and latitude,
 * or over the unfolded octahedron (pbrt v4's), interpolated between texel centres. The
 * texels lie in blocks of 4 x 2, in order of 2 x 2, so that the four of a lookup are in
 * few cache lines; as half floats, 64 bytes a block, where these hold all values exactly.
 * Directions d are unit vectors in the map's space. */

#include "math/rgb.h"
#include "surface/texture.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct sky_map {
    int width, height;
    bool octahedral; /* else longitude and latitude */
    int blocks;      /* in a row of blocks */
    uint16_t *half;  /* [blocks of a picture][8][4]: r, g, b, 0; or NULL */
    float *full;     /* the same; or NULL */
};

void sky_map_build(struct sky_map *map, const struct texture_image *image,
                   bool octahedral);
void sky_map_deinit(struct sky_map *map);
struct rgb sky_map_at(const struct sky_map *map, const double d[3]);
/* Texels up to one beyond an edge continue as the sphere does. */
struct rgb sky_map_texel(const struct sky_map *map, int x, int y);
/* The direction of a point of the picture, in texels from its upper left corner. */
void sky_map_direction(const struct sky_map *map, double x, double y, double d[3]);
size_t sky_map_bytes(const struct sky_map *map);

#endif

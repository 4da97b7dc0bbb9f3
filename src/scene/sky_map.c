#include "scene/sky_map.h"

#include "base/mem.h"
#include "math/warp.h"

#include <string.h>

#define BLOCK_WIDTH  4
#define BLOCK_HEIGHT 2
#define BLOCK        ((size_t)BLOCK_WIDTH * BLOCK_HEIGHT)

typedef uint16_t half4 __attribute__((vector_size(8)));
typedef uint32_t word4 __attribute__((vector_size(16)));
typedef float float4 __attribute__((vector_size(16)));
typedef double double4 __attribute__((vector_size(32)));

/* Place of a texel, in texels. */
static inline size_t texel_place(const struct sky_map *map, int x, int y)
{
    size_t block = (size_t)(y / BLOCK_HEIGHT) * (size_t)map->blocks +
                   (size_t)(x / BLOCK_WIDTH);
    return BLOCK * block + (size_t)((x & 2) << 1 | (y & 1) << 1 | (x & 1));
}

/* The normal half floats: no bit is lost, and flushed denormals play no part. */
static bool half_holds(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return value == 0.0f ||
           (value >= 0x1p-14f && value < 0x1p16f && (bits & 0x1fff) == 0);
}

static uint16_t half_from(float value)
{
    uint32_t bits;
    value *= 0x1p-112f;
    memcpy(&bits, &value, sizeof bits);
    return (uint16_t)(bits >> 13);
}

static inline float4 half_to_float(half4 half)
{
    float4 out;
    word4 bits = __builtin_convertvector(half, word4) << 13;
    memcpy(&out, &bits, sizeof out);
    return out * 0x1p112f;
}

/* By pointer, as to_rgb: 32 bytes by value need AVX in the calling convention. */
static inline void load_texel(const struct sky_map *map, size_t place, double4 *out)
{
    float4 texel;
    if (map->half) {
        half4 half;
        memcpy(&half, map->half + 4 * place, sizeof half);
        texel = half_to_float(half);
    } else {
        memcpy(&texel, map->full + 4 * place, sizeof texel);
    }
    *out = __builtin_convertvector(texel, double4);
}

static void store_texel(struct sky_map *map, size_t place, struct rgb value)
{
    const float v[3] = {(float)value.r, (float)value.g, (float)value.b};
    for (size_t k = 0; k < 3; k++)
        if (map->half)
            map->half[4 * place + k] = half_from(v[k]);
        else
            map->full[4 * place + k] = v[k];
}

static bool all_halves(const struct texture_image *image)
{
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++) {
            struct rgb c = texture_image_texel(image, x, y);
            if (!half_holds((float)c.r) || !half_holds((float)c.g) ||
                !half_holds((float)c.b))
                return false;
        }
    return true;
}

static size_t texel_count(const struct sky_map *map)
{
    size_t rows = (size_t)(map->height + BLOCK_HEIGHT - 1) / BLOCK_HEIGHT;
    return BLOCK * (size_t)map->blocks * rows;
}

void sky_map_build(struct sky_map *map, const struct texture_image *image,
                   bool octahedral)
{
    *map = (struct sky_map){.width = image->width,
                            .height = image->height,
                            .octahedral = octahedral,
                            .blocks = (image->width + BLOCK_WIDTH - 1) / BLOCK_WIDTH};
    size_t count = texel_count(map);
    if (all_halves(image))
        map->half = mem_aligned(64, 4 * count, sizeof *map->half);
    else
        map->full = mem_aligned(64, 4 * count, sizeof *map->full);
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++)
            store_texel(map, texel_place(map, x, y), texture_image_texel(image, x, y));
}

void sky_map_deinit(struct sky_map *map)
{
    mem_free(map->half);
    mem_free(map->full);
    *map = (struct sky_map){0};
}

size_t sky_map_bytes(const struct sky_map *map)
{
    size_t each = map->half ? sizeof *map->half : map->full ? sizeof *map->full : 0;
    return 4 * texel_count(map) * each;
}

/* With longitude and latitude the column wraps round, the row stops at the poles. */
static inline size_t wrapped_place(const struct sky_map *map, int x, int y)
{
    if (map->octahedral) {
        warp_octahedron_wrap(map->width, map->height, &x, &y);
    } else {
        x = x < 0 ? x + map->width : x >= map->width ? x - map->width : x;
        y = y < 0 ? 0 : y >= map->height ? map->height - 1 : y;
    }
    return texel_place(map, x, y);
}

static inline struct rgb to_rgb(const double4 *v)
{
    return rgb((*v)[0], (*v)[1], (*v)[2]);
}

struct rgb sky_map_texel(const struct sky_map *map, int x, int y)
{
    double4 texel;
    load_texel(map, wrapped_place(map, x, y), &texel);
    return to_rgb(&texel);
}

static inline void to_map(const struct sky_map *map, const double d[3], double point[2])
{
    if (map->octahedral) {
        warp_octahedron_inverse(d, point);
        return;
    }
    /* Longitude and latitude [Pharr16, section 14.2.4]. */
    double sine = sqrt(d[0] * d[0] + d[1] * d[1]);
    point[0] = sine > 0.0 ? warp_circle_inverse((struct vec2){d[0], d[1]}) : 0.0;
    point[1] = 2.0 * warp_circle_inverse((struct vec2){d[2], sine});
}

void sky_map_direction(const struct sky_map *map, double x, double y, double d[3])
{
    const double at[2] = {x / map->width, y / map->height};
    if (map->octahedral) {
        warp_octahedron(at, d);
        return;
    }
    struct vec2 phi = warp_circle(at[0]), theta = warp_circle(0.5 * at[1]);
    d[0] = theta.y * phi.x;
    d[1] = theta.y * phi.y;
    d[2] = theta.x;
}

struct rgb sky_map_at(const struct sky_map *map, const double d[3])
{
    double point[2];
    to_map(map, d, point);
    double x = point[0] * map->width - 0.5, y = point[1] * map->height - 0.5;
    int i = (int)(x + 1.0) - 1, j = (int)(y + 1.0) - 1; /* floor: x, y >= -.5 */
    double a = x - i, b = y - j;
    double4 texel[4];
    load_texel(map, wrapped_place(map, i, j), &texel[0]);
    load_texel(map, wrapped_place(map, i + 1, j), &texel[1]);
    load_texel(map, wrapped_place(map, i, j + 1), &texel[2]);
    load_texel(map, wrapped_place(map, i + 1, j + 1), &texel[3]);
    double4 top = texel[0] * (1.0 - a) + texel[1] * a;
    double4 low = texel[2] * (1.0 - a) + texel[3] * a;
    double4 value = top * (1.0 - b) + low * b;
    return to_rgb(&value);
}

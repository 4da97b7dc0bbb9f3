#ifndef ETALON_SURFACE_TEXTURE_H
#define ETALON_SURFACE_TEXTURE_H

/* Textures: colours over surface parameters. A small tree of nodes, made once by an
 * importer, then read-only; all of them, and the pictures that they share, belong to a
 * texture_set. A new kind is one function `eval` and one maker. */

#include "base/err.h"
#include "base/log.h"
#include "math/rgb.h"

#include <stddef.h>
#include <stdint.h>

enum texture_wrap { TEXTURE_REPEAT, TEXTURE_CLAMP, TEXTURE_BLACK, TEXTURE_MIRROR };

/* How numbers of a file become linear: 8 and 16 bits of sRGB, or linear as they are.
 * AUTO: sRGB for 8 and 16 bits, linear for floats. */
enum texture_encoding { TEXTURE_AUTO, TEXTURE_LINEAR, TEXTURE_SRGB };

/* Pixels of a file, linear once decoded; row 0 at the top. */
struct texture_image {
    char *path;
    enum texture_encoding encoding;
    int width, height;
    unsigned char *bytes; /* [height][width][3], through decode[]; or NULL */
    float *floats;        /* [height][width][3], linear; or NULL. Both once released */
    float decode[256];
    size_t size; /* bytes of memory */
};

/* Where a texture is evaluated: the surface's parameters, and the place in the scene's
 * space, also on an instance. */
struct texture_point {
    double u, v;
    double p[3];
};

/* Of textures of the place (surface/texture_solid.c). */
struct texture_noise {
    int octaves;
    double roughness; /* each octave's share of the one before */
    double scale, variation;
};

struct texture {
    /* Finite at any point. */
    struct rgb (*eval)(const struct texture *texture, const struct texture_point *at);
    double uv[2][3]; /* the texture's own (u,v) = uv . (u, v, 1); identity by default */
    const struct texture *of[3];
    const struct texture_image *image;
    enum texture_wrap wrap;
    struct rgb value;          /* of a constant; factor of a picture */
    double (*curve)(double x); /* of texture_curve */
    int nodes;                 /* of its tree, shared ones counted each time; saturates */
    double space[3][4];        /* the texture's own place = space . (p, 1); identity */
    struct texture_noise noise;
};

struct texture_set {
    struct texture **textures;
    size_t count, capacity;
    struct texture_image **images;
    size_t image_count, image_capacity;
    struct texture_image **prepared; /* decoded in advance, not loaded yet */
    size_t prepared_count, prepared_capacity;
};

void texture_set_deinit(struct texture_set *set);
size_t texture_set_bytes(const struct texture_set *set);
/* Frees the pixels of a picture that is no longer read, unless a texture reads it: the
 * picture remains, with its path and size, without texels. */
void texture_set_release(struct texture_set *set, const struct texture_image *image);

static inline struct rgb texture_eval(const struct texture *texture,
                                      const struct texture_point *at)
{
    /* cppcheck-suppress returnDanglingLifetime; a colour holds no pointer */
    return texture->eval(texture, at);
}

/* By the parameters alone, at the origin. */
static inline struct rgb texture_eval_uv(const struct texture *texture, double u,
                                         double v)
{
    const struct texture_point at = {.u = u, .v = v};
    /* cppcheck-suppress returnDanglingLifetime; a colour holds no pointer */
    return texture->eval(texture, &at);
}

/* Limit of nodes. Textures can share others, so a few lines can describe a tree of 2^30
 * nodes, each of which would be evaluated. */
#define TEXTURE_NODES_MAX 4096
bool texture_check(const struct texture *texture, const struct place *at,
                   struct err *err);

/* Constructors; the set owns the result, whose uv and space may still be changed. */
struct texture *texture_constant(struct texture_set *set, struct rgb value);
/* a where floor(u) + floor(v) is even, else b. */
struct texture *texture_checkerboard(struct texture_set *set, const struct texture *a,
                                     const struct texture *b);
struct texture *texture_product(struct texture_set *set, const struct texture *a,
                                const struct texture *b);
/* curve(x), channel by channel; finite for all that is. */
struct texture *texture_curve(struct texture_set *set, const struct texture *of,
                              double (*curve)(double x));
/* (1 - amount) a + amount b, channel by channel. */
struct texture *texture_mix(struct texture_set *set, const struct texture *a,
                            const struct texture *b, const struct texture *amount);
/* Of the place: a where the sum of the three floors is even, else b. */
struct texture *texture_checkerboard_3d(struct texture_set *set, const struct texture *a,
                                        const struct texture *b);
/* Dots of radius .35 in about half of the unit squares around integer (u, v), moved by up
 * to .15 [Pharr16, section 10.6.2]. */
struct texture *texture_dots(struct texture_set *set, const struct texture *inside,
                             const struct texture *outside);
/* Noise of the place, grey [Pharr16, section 10.6]. Rays have no differentials, so the
 * octaves finer than a pixel are not left out. Fbm and windy are negative in places. */
struct texture *texture_fbm(struct texture_set *set, int octaves, double roughness);
struct texture *texture_wrinkled(struct texture_set *set, int octaves, double roughness);
struct texture *texture_windy(struct texture_set *set);
struct texture *texture_marble(struct texture_set *set,
                               const struct texture_noise *noise);
/* Bilinear between texel centres; v = 0 is the lower edge of the picture. */
struct texture *texture_picture(struct texture_set *set,
                                const struct texture_image *image,
                                enum texture_wrap wrap);

/* Loads png, jpg, tga, hdr or exr, each file once. NULL with *err set if a file is
 * invalid; NULL with a counted note and no error if it does not exist: the caller uses a
 * constant instead. Negative and non-finite texels are clamped to 0 and counted. */
const struct texture_image *texture_image_load(struct texture_set *set, const char *path,
                                               enum texture_encoding encoding,
                                               const struct place *at, struct log *log,
                                               struct err *err);

/* Decodes a picture for texture_set_prepare if it has no defects, else NULL:
 * texture_image_load then reports them. Thread-safe. */
struct texture_image *texture_image_prepare(const char *path);
/* Hands over a decoded picture to texture_image_load; takes ownership. */
void texture_set_prepare(struct texture_set *set, struct texture_image *image);
/* Frees the prepared pictures that were never loaded. */
void texture_set_drop_prepared(struct texture_set *set);

/* A picture made in memory, black; for its maker to fill `floats`. */
struct texture_image *texture_image_create(struct texture_set *set, int width,
                                           int height);

void texture_image_destroy(struct texture_image *image);

/* Linear value of one texel. */
static inline struct rgb texture_image_texel(const struct texture_image *image, int x,
                                             int y)
{
    size_t at = 3 * ((size_t)y * (size_t)image->width + (size_t)x);
    if (image->bytes) {
        const unsigned char *b = image->bytes + at;
        return rgb((double)image->decode[b[0]], (double)image->decode[b[1]],
                   (double)image->decode[b[2]]);
    }
    const float *f = image->floats + at;
    return rgb((double)f[0], (double)f[1], (double)f[2]);
}

#endif

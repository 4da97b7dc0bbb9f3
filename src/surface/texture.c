#include "surface/texture.h"

#include "base/mem.h"
#include "surface/texture_kind.h"

struct texture *texture_add(struct texture_set *set, texture_evaluator eval)
{
    struct texture *texture = mem_alloc(1, sizeof *texture);
    *texture = (struct texture){.eval = eval,
                                .uv = {{1, 0, 0}, {0, 1, 0}},
                                .space = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}},
                                .nodes = 1};
    set->textures = mem_grow(set->textures, &set->capacity, set->count + 1,
                             sizeof(struct texture *));
    set->textures[set->count++] = texture;
    return texture;
}

void texture_set_part(struct texture *t, int index, const struct texture *part)
{
    t->of[index] = part;
    t->nodes += part->nodes;
    if (t->nodes > TEXTURE_NODES_MAX + 1)
        t->nodes = TEXTURE_NODES_MAX + 1;
}

bool texture_check(const struct texture *texture, const struct place *at, struct err *err)
{
    return texture->nodes <= TEXTURE_NODES_MAX ||
           err_set(err, ERR_VALUE, at, "a texture made of more than %d textures",
                   TEXTURE_NODES_MAX);
}

static struct rgb eval_constant(const struct texture *t, const struct texture_point *at)
{
    (void)at;
    return t->value;
}

static struct rgb eval_checkerboard(const struct texture *t,
                                    const struct texture_point *at)
{
    double s, r;
    texture_place_uv(t, at, &s, &r);
    bool odd = ((long)floor(s) + (long)floor(r)) % 2 != 0;
    return texture_eval(t->of[odd], at);
}

static struct rgb eval_product(const struct texture *t, const struct texture_point *at)
{
    return rgb_mul(texture_eval(t->of[0], at), texture_eval(t->of[1], at));
}

static struct rgb eval_curve(const struct texture *t, const struct texture_point *at)
{
    struct rgb x = texture_eval(t->of[0], at);
    return rgb(t->curve(x.r), t->curve(x.g), t->curve(x.b));
}

static struct rgb eval_mix(const struct texture *t, const struct texture_point *at)
{
    struct rgb a = texture_eval(t->of[2], at);
    struct rgb rest = rgb(fmax(0.0, 1.0 - a.r), fmax(0.0, 1.0 - a.g),
                          fmax(0.0, 1.0 - a.b));
    return rgb_add(rgb_mul(rest, texture_eval(t->of[0], at)),
                   rgb_mul(a, texture_eval(t->of[1], at)));
}

/* One coordinate: the two texels around it, -1 for black, and the share of the second. */
struct taps {
    int at[2];
    double share;
};

static int wrap_index(long i, int count, enum texture_wrap wrap)
{
    if (i >= 0 && i < count)
        return (int)i;
    switch (wrap) {
    case TEXTURE_CLAMP:
        return i < 0 ? 0 : count - 1;
    case TEXTURE_BLACK:
        return -1;
    case TEXTURE_MIRROR:
        i = (i % (2L * count) + 2L * count) % (2L * count);
        return (int)(i < count ? i : 2L * count - 1 - i);
    default:
        return (int)((i % count + count) % count);
    }
}

static struct taps taps_at(double x, int count, enum texture_wrap wrap)
{
    double texel = x * count - 0.5, low = floor(texel);
    struct taps taps = {.share = texel - low};
    for (int k = 0; k < 2; k++)
        taps.at[k] = wrap_index((long)low + k, count, wrap);
    return taps;
}

static struct rgb eval_picture(const struct texture *t, const struct texture_point *at)
{
    double s, r;
    texture_place_uv(t, at, &s, &r);
    struct taps x = taps_at(s, t->image->width, t->wrap);
    struct taps y = taps_at(1.0 - r, t->image->height, t->wrap);
    struct rgb sum = {0.0, 0.0, 0.0};
    for (int j = 0; j < 2; j++)
        for (int i = 0; i < 2; i++) {
            double share = (i ? x.share : 1.0 - x.share) * (j ? y.share : 1.0 - y.share);
            if (x.at[i] >= 0 && y.at[j] >= 0)
                sum = rgb_add(
                    sum,
                    rgb_scale(texture_image_texel(t->image, x.at[i], y.at[j]), share));
        }
    return rgb_mul(sum, t->value);
}

struct texture *texture_constant(struct texture_set *set, struct rgb value)
{
    struct texture *t = texture_add(set, eval_constant);
    t->value = value;
    return t;
}

struct texture *texture_checkerboard(struct texture_set *set, const struct texture *a,
                                     const struct texture *b)
{
    struct texture *t = texture_add(set, eval_checkerboard);
    texture_set_part(t, 0, a);
    texture_set_part(t, 1, b);
    return t;
}

struct texture *texture_product(struct texture_set *set, const struct texture *a,
                                const struct texture *b)
{
    struct texture *t = texture_add(set, eval_product);
    texture_set_part(t, 0, a);
    texture_set_part(t, 1, b);
    return t;
}

struct texture *texture_curve(struct texture_set *set, const struct texture *of,
                              double (*curve)(double x))
{
    struct texture *t = texture_add(set, eval_curve);
    texture_set_part(t, 0, of);
    t->curve = curve;
    return t;
}

struct texture *texture_mix(struct texture_set *set, const struct texture *a,
                            const struct texture *b, const struct texture *amount)
{
    struct texture *t = texture_add(set, eval_mix);
    texture_set_part(t, 0, a);
    texture_set_part(t, 1, b);
    texture_set_part(t, 2, amount);
    return t;
}

struct texture *texture_picture(struct texture_set *set,
                                const struct texture_image *image, enum texture_wrap wrap)
{
    struct texture *t = texture_add(set, eval_picture);
    t->image = image;
    t->wrap = wrap;
    t->value = rgb_grey(1.0);
    return t;
}

void texture_set_deinit(struct texture_set *set)
{
    texture_set_drop_prepared(set);
    for (size_t i = 0; i < set->count; i++)
        mem_free(set->textures[i]);
    for (size_t i = 0; i < set->image_count; i++)
        texture_image_destroy(set->images[i]);
    mem_free(set->textures);
    mem_free(set->images);
    *set = (struct texture_set){0};
}

size_t texture_set_bytes(const struct texture_set *set)
{
    size_t sum = set->count * sizeof(struct texture);
    for (size_t i = 0; i < set->image_count; i++)
        sum += set->images[i]->size;
    return sum;
}

static bool is_read(const struct texture_set *set, const struct texture_image *image)
{
    for (size_t i = 0; i < set->count; i++)
        if (set->textures[i]->image == image)
            return true;
    return false;
}

void texture_set_release(struct texture_set *set, const struct texture_image *image)
{
    for (size_t i = 0; i < set->image_count; i++)
        if (set->images[i] == image && !is_read(set, image)) {
            mem_free(set->images[i]->bytes);
            mem_free(set->images[i]->floats);
            set->images[i]->bytes = NULL;
            set->images[i]->floats = NULL;
            set->images[i]->size = 0;
        }
}

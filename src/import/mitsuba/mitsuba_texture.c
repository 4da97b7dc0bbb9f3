#include "import/mitsuba/mitsuba_texture.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/mitsuba/mitsuba_property.h"
#include "import/mitsuba/mitsuba_spectrum.h"
#include "import/mitsuba/mitsuba_transform.h"

#define MEAN_GRID 64

/* v of Mitsuba goes down a picture from its upper edge, ours up from the lower one. */
static void turn_v(struct texture *texture)
{
    texture->uv[1][0] = -texture->uv[1][0];
    texture->uv[1][1] = -texture->uv[1][1];
    texture->uv[1][2] = 1.0 - texture->uv[1][2];
}

/* Mitsuba 3 has to_uv, 0.x scales and offsets. */
static bool read_uv(struct mitsuba_node *object, struct texture *texture, double factor,
                    struct err *err)
{
    struct xform to_uv = xform_identity();
    double scale[2] = {1.0, 1.0}, offset[2] = {0.0, 0.0}, both = 1.0;
    if (!mitsuba_transform(object, "to_uv", &to_uv, err) ||
        !mitsuba_float(object, "uvscale", &both, err) ||
        !mitsuba_float(object, "uoffset", &offset[0], err) ||
        !mitsuba_float(object, "voffset", &offset[1], err))
        return false;
    scale[0] = scale[1] = both;
    if (!mitsuba_float(object, "uscale", &scale[0], err) ||
        !mitsuba_float(object, "vscale", &scale[1], err))
        return false;
    for (int i = 0; i < 2; i++) {
        texture->uv[i][0] = factor * scale[i] * to_uv.m[i][0];
        texture->uv[i][1] = factor * scale[i] * to_uv.m[i][1];
        texture->uv[i][2] = factor * (scale[i] * to_uv.m[i][3] + offset[i]);
    }
    return true;
}

static bool read_wrap(struct mitsuba *m, struct mitsuba_node *object,
                      enum texture_wrap *wrap, struct err *err)
{
    static const struct {
        const char *name;
        enum texture_wrap wrap;
    } rows[] = {{"repeat", TEXTURE_REPEAT},
                {"clamp", TEXTURE_CLAMP},
                {"mirror", TEXTURE_MIRROR},
                {"zero", TEXTURE_BLACK}};
    const char *name = "repeat";
    if (!mitsuba_string(object, "wrap_mode", &name, err))
        return false;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        if (text_equal(name, rows[i].name)) {
            *wrap = rows[i].wrap;
            return true;
        }
    }
    log_note(&m->desc->log, &object->place, "wrap_mode \"%s\" is taken as \"repeat\"",
             name);
    *wrap = TEXTURE_REPEAT;
    return true;
}

/* raw (Mitsuba 3) or a gamma of 1 (0.x) is linear, else the kind of file decides. */
static bool read_encoding(struct mitsuba *m, struct mitsuba_node *object,
                          enum texture_encoding *encoding, struct err *err)
{
    bool raw = false;
    double gamma = -1.0;
    if (!mitsuba_boolean(object, "raw", &raw, err) ||
        !mitsuba_float(object, "gamma", &gamma, err))
        return false;
    if (gamma > 0.0 && gamma != 1.0)
        log_note(&m->desc->log, &object->place, "a gamma of %g is taken as sRGB", gamma);
    *encoding = raw || gamma == 1.0 ? TEXTURE_LINEAR : TEXTURE_AUTO;
    return true;
}

const struct texture_image *mitsuba_picture(struct mitsuba *m,
                                            struct mitsuba_node *object, struct err *err)
{
    enum texture_encoding encoding;
    const char *name = NULL;
    if (!read_encoding(m, object, &encoding, err) ||
        !mitsuba_string(object, "filename", &name, err))
        return NULL;
    if (!name) {
        err_set(err, ERR_VALUE, &object->place, "%s \"%s\" wants a string \"filename\"",
                object->name, mitsuba_type(object));
        return NULL;
    }
    char *path = text_join(m->directory, name);
    const struct texture_image *image = texture_image_load(
        &m->desc->textures, path, encoding, &mitsuba_property(object, "filename")->place,
        &m->desc->log, err);
    mem_free(path);
    return image;
}

static bool bitmap(struct mitsuba *m, struct mitsuba_node *object,
                   const struct texture **out, struct err *err)
{
    static const char *const ignored[] = {"filter_type", "max_anisotropy", "cache",
                                          "format",      "accel",          NULL};
    enum texture_wrap wrap;
    struct err failure = {0};
    const struct texture_image *image = mitsuba_picture(m, object, &failure);
    if (failure.code != ERR_NONE) {
        *err = failure;
        return false;
    }
    mitsuba_ignore(object, ignored); /* all is bilinear here */
    if (!read_wrap(m, object, &wrap, err))
        return false;
    struct texture *texture = image ? texture_picture(&m->desc->textures, image, wrap)
                                    : texture_constant(&m->desc->textures, rgb_grey(0.5));
    *out = texture;
    if (!read_uv(object, texture, 1.0, err))
        return false;
    turn_v(texture);
    return true;
}

static bool part(struct mitsuba *m, struct mitsuba_node *object, const char *name,
                 double fallback, const struct texture **out, struct err *err)
{
    struct mitsuba_value value = {.value = rgb_grey(fallback)};
    if (!mitsuba_value(m, object, name, &value, err))
        return false;
    *out = value.texture ? value.texture
                         : texture_constant(&m->desc->textures, value.value);
    return true;
}

/* Two by two fields in the unit square. */
static bool checkerboard(struct mitsuba *m, struct mitsuba_node *object,
                         const struct texture **out, struct err *err)
{
    const struct texture *a, *b;
    if (!part(m, object, "color0", 0.4, &a, err) ||
        !part(m, object, "color1", 0.2, &b, err))
        return false;
    struct texture *texture = texture_checkerboard(&m->desc->textures, a, b);
    *out = texture;
    return read_uv(object, texture, 2.0, err);
}

/* Another texture times a number or a colour. */
static bool scaled(struct mitsuba *m, struct mitsuba_node *object,
                   const struct texture **out, struct err *err)
{
    struct rgb factor = rgb_grey(1.0);
    struct mitsuba_node *inner;
    if (!mitsuba_colour(m, object, "scale", &factor, err) ||
        !mitsuba_child(m, object, "texture", &inner, err))
        return false;
    if (!inner)
        return err_set(err, ERR_VALUE, &object->place,
                       "texture \"scale\" wants a <texture> in it");
    if (!mitsuba_texture(m, inner, out, err))
        return false;
    *out = texture_product(&m->desc->textures, *out,
                           texture_constant(&m->desc->textures, factor));
    return true;
}

/* A spectrum where a texture is wanted. */
static bool constant(struct mitsuba *m, struct mitsuba_node *object,
                     const struct texture **out, struct err *err)
{
    struct rgb value;
    if (!mitsuba_spectrum_read(m, object, MITSUBA_REFLECTANCE, &value, err))
        return false;
    value = scene_desc_clamp(m->desc, value, &object->place);
    *out = object->texture = texture_constant(&m->desc->textures, value);
    return true;
}

static const struct {
    const char *type;
    bool (*read)(struct mitsuba *m, struct mitsuba_node *object,
                 const struct texture **out, struct err *err);
} rows[] = {{"bitmap", bitmap}, {"checkerboard", checkerboard}, {"scale", scaled}};

#define ROWS (sizeof rows / sizeof rows[0])

static bool is_left_out(const struct mitsuba_node *object)
{
    static const char *const types[] = {"gridtexture", "vertexcolors", "mesh_attribute",
                                        "wireframe",   "curvature",    "volume"};
    for (size_t i = 0; i < sizeof types / sizeof types[0]; i++)
        if (text_equal(mitsuba_type(object), types[i]))
            return true;
    return false;
}

bool mitsuba_texture(struct mitsuba *m, struct mitsuba_node *object,
                     const struct texture **out, struct err *err)
{
    const char *known[ROWS + 1] = {0};
    *out = object->texture;
    if (!*out && mitsuba_spectrum_is(object))
        return constant(m, object, out, err);
    for (size_t i = 0; i < ROWS && !*out; i++) {
        known[i] = rows[i].type;
        if (!text_equal(mitsuba_type(object), rows[i].type))
            continue;
        if (!mitsuba_enter(m, object, err))
            return false;
        bool read = rows[i].read(m, object, out, err);
        mitsuba_leave(m, object);
        if (!read || !texture_check(*out, &object->place, err))
            return false;
        mitsuba_report(m, object);
        object->texture = *out;
        return true;
    }
    if (*out)
        return true;
    if (is_left_out(object))
        log_note(&m->desc->log, &object->place,
                 "texture \"%s\" is not read yet: a grey of .5 takes its place",
                 mitsuba_type(object));
    else
        mitsuba_unknown(m, object, known, "grey");
    *out = texture_constant(&m->desc->textures, rgb_grey(0.5));
    return true;
}

struct rgb mitsuba_texture_mean(struct mitsuba *m, const struct mitsuba_node *object,
                                const struct texture *texture)
{
    struct rgb sum = rgb_grey(0.0);
    log_note(&m->desc->log, &object->place, "no texture is read here, only its mean");
    for (int j = 0; j < MEAN_GRID; j++)
        for (int i = 0; i < MEAN_GRID; i++)
            sum = rgb_add(sum, texture_eval_uv(texture, (i + 0.5) / MEAN_GRID,
                                               (j + 0.5) / MEAN_GRID));
    return rgb_scale(sum, 1.0 / (MEAN_GRID * MEAN_GRID));
}

static enum mitsuba_quantity quantity_of(const struct mitsuba_node *object,
                                         const char *name)
{
    static const char *const indices[] = {"eta",     "k",       "int_ior",
                                          "ext_ior", "sigma_t", NULL};
    if (mitsuba_one_of(name, indices))
        return MITSUBA_INDEX;
    return text_equal(object->name, "emitter") ? MITSUBA_EMISSION : MITSUBA_REFLECTANCE;
}

bool mitsuba_value(struct mitsuba *m, struct mitsuba_node *object, const char *name,
                   struct mitsuba_value *value, struct err *err)
{
    struct mitsuba_node *node = mitsuba_property(object, name);
    if (!node)
        return true;
    node = mitsuba_resolve(m, node, err);
    if (!node)
        return false;
    enum mitsuba_quantity quantity = quantity_of(object, name);
    if (mitsuba_rgb_is(node))
        return mitsuba_rgb_read(m, node, quantity, &value->value, err);
    if (mitsuba_spectrum_is(node)) {
        if (!mitsuba_spectrum_read(m, node, quantity, &value->value, err))
            return false;
        value->value = scene_desc_clamp(m->desc, value->value, &node->place);
        return true;
    }
    if (text_equal(node->name, "texture"))
        return mitsuba_texture(m, node, &value->texture, err);
    log_note(&m->desc->log, &node->place,
             "<%s> is no colour that is read; \"%s\" keeps its default", node->name,
             name);
    return true;
}

bool mitsuba_colour(struct mitsuba *m, struct mitsuba_node *object, const char *name,
                    struct rgb *value, struct err *err)
{
    struct mitsuba_value read = {.value = *value};
    if (!mitsuba_value(m, object, name, &read, err))
        return false;
    *value = read.texture
                 ? mitsuba_texture_mean(m, mitsuba_property(object, name), read.texture)
                 : read.value;
    return true;
}

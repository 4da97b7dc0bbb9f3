#include "import/pbrt/pbrt_texture.h"
#include "import/pbrt/pbrt_scene.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/suggest.h"

bool pbrt_texture_part(struct pbrt *p, const char *name, bool is_float, double fallback,
                       struct pbrt_value *value, struct err *err)
{
    *value = (struct pbrt_value){.value = rgb_grey(fallback)};
    return is_float ? pbrt_colour_float_value(p, name, value, err)
                    : pbrt_colour_value(p, name, value, err);
}

bool pbrt_texture_mapping(struct pbrt *p, struct texture *texture, struct err *err)
{
    double su = 1.0, sv = 1.0, du = 0.0, dv = 0.0;
    const struct pbrt_param *kind = pbrt_params_find(&p->params, "mapping", PBRT_STRING);
    if (kind && !text_equal(pbrt_params_text(&p->params, kind), "uv"))
        log_note(&p->desc->log, &kind->place,
                 "the mapping \"%s\" is taken as \"uv\": the surface's own parameters",
                 pbrt_params_text(&p->params, kind));
    if (!pbrt_params_float(&p->params, "uscale", &su, err) ||
        !pbrt_params_float(&p->params, "vscale", &sv, err) ||
        !pbrt_params_float(&p->params, "udelta", &du, err) ||
        !pbrt_params_float(&p->params, "vdelta", &dv, err))
        return false;
    texture->uv[0][0] = su;
    texture->uv[0][2] = du;
    texture->uv[1][1] = p->lux ? -sv : sv; /* LuxRender's pictures hang from v = 0 */
    texture->uv[1][2] = p->lux ? 1.0 - dv : dv;
    return true;
}

static bool constant(struct pbrt *p, bool is_float, struct pbrt_value *out,
                     struct err *err)
{
    return pbrt_texture_part(p, "value", is_float, 1.0, out, err);
}

static bool product(struct pbrt *p, bool is_float, struct pbrt_value *out,
                    struct err *err)
{
    struct pbrt_value a, b;
    /* v4 calls them tex and scale, and its scale is a number. */
    bool v4 = pbrt_params_find(&p->params, "tex", 0xffffu) != NULL;
    if (!pbrt_texture_part(p, v4 ? "tex" : "tex1", is_float, 1.0, &a, err) ||
        !pbrt_texture_part(p, v4 ? "scale" : "tex2", is_float || v4, 1.0, &b, err))
        return false;
    *out = (struct pbrt_value){.value = rgb_mul(a.value, b.value)};
    if (a.texture || b.texture)
        out->texture = texture_product(&p->desc->textures, pbrt_colour_node(p, &a),
                                       pbrt_colour_node(p, &b));
    return true;
}

static bool mix(struct pbrt *p, bool is_float, struct pbrt_value *out, struct err *err)
{
    struct pbrt_value a, b, amount = {.value = rgb_grey(0.5)};
    if (!pbrt_texture_part(p, "tex1", is_float, 0.0, &a, err) ||
        !pbrt_texture_part(p, "tex2", is_float, 1.0, &b, err) ||
        !pbrt_colour_float_value(p, "amount", &amount, err))
        return false;
    out->texture = texture_mix(&p->desc->textures, pbrt_colour_node(p, &a),
                               pbrt_colour_node(p, &b), pbrt_colour_node(p, &amount));
    return true;
}

static bool checkerboard(struct pbrt *p, bool is_float, struct pbrt_value *out,
                         struct err *err)
{
    static const char *const ignored[] = {"aamode", NULL};
    struct pbrt_value a, b;
    int dimension = 2;
    pbrt_params_ignore(&p->params, ignored);
    if (!pbrt_texture_part(p, "tex1", is_float, 1.0, &a, err) ||
        !pbrt_texture_part(p, "tex2", is_float, 0.0, &b, err) ||
        !pbrt_params_int(&p->params, "dimension", &dimension, err))
        return false;
    struct texture_set *set = &p->desc->textures;
    const struct texture *even = pbrt_colour_node(p, &a), *odd = pbrt_colour_node(p, &b);
    bool solid = dimension == 3;
    if (dimension != 2 && !solid)
        log_note(&p->desc->log, &p->params.place,
                 "a checkerboard of dimension %d is taken as one of 2", dimension);
    struct texture *made = solid ? texture_checkerboard_3d(set, even, odd)
                                 : texture_checkerboard(set, even, odd);
    out->texture = made;
    return solid ? pbrt_texture_space(p, made, err) : pbrt_texture_mapping(p, made, err);
}

static bool read_wrap(struct pbrt *p, enum texture_wrap *wrap, struct err *err)
{
    static const char *const names[] = {"repeat", "clamp", "black", "mirror", NULL};
    static const enum texture_wrap wraps[] = {TEXTURE_REPEAT, TEXTURE_CLAMP,
                                              TEXTURE_BLACK, TEXTURE_MIRROR};
    const struct pbrt_param *param = pbrt_params_find(&p->params, "wrap", PBRT_STRING);
    *wrap = TEXTURE_REPEAT;
    if (!param)
        return true;
    const char *name = pbrt_params_text(&p->params, param);
    for (int i = 0; names[i]; i++)
        if (text_equal(name, names[i])) {
            *wrap = wraps[i];
            return true;
        }
    return suggest_fail(err, &param->place, "wrap", name, names);
}

/* v3's gamma, v4's encoding; by default what holds 8 bits is sRGB. */
static bool read_encoding(struct pbrt *p, enum texture_encoding *encoding,
                          struct err *err)
{
    bool gamma = true;
    *encoding = TEXTURE_AUTO;
    const struct pbrt_param *word = pbrt_params_find(&p->params, "encoding", PBRT_STRING);
    const char *name = word ? pbrt_params_text(&p->params, word) : "sRGB";
    if (text_equal(name, "linear"))
        *encoding = TEXTURE_LINEAR;
    else if (!text_equal(name, "sRGB"))
        log_note(&p->desc->log, &word->place,
                 "the encoding \"%s\" of a picture is taken as sRGB", name);
    const struct pbrt_param *exponent = pbrt_params_find(&p->params, "gamma", PBRT_FLOAT);
    if (exponent && exponent->count == 1) /* LuxRender's */
        *encoding = pbrt_params_numbers(&p->params, exponent)[0] == 1.0 ? TEXTURE_LINEAR
                                                                        : TEXTURE_SRGB;
    if (!pbrt_params_find(&p->params, "gamma", PBRT_BOOL))
        return true;
    if (!pbrt_params_bool(&p->params, "gamma", &gamma, err))
        return false;
    *encoding = gamma ? TEXTURE_SRGB : TEXTURE_LINEAR;
    return true;
}

/* 1 - value; below 0 where a picture is brighter than 1, which whoever uses it clamps. */
static void invert_value(struct pbrt *p, struct pbrt_value *value)
{
    struct texture_set *set = &p->desc->textures;
    if (value->texture)
        value->texture = texture_mix(set, texture_constant(set, rgb_grey(1.0)),
                                     texture_constant(set, rgb_grey(0.0)),
                                     value->texture);
    value->value = rgb(1.0 - value->value.r, 1.0 - value->value.g, 1.0 - value->value.b);
}

static bool imagemap(struct pbrt *p, bool is_float, struct pbrt_value *out,
                     struct err *err)
{
    static const char *const ignored[] = {"trilinear",  "maxanisotropy",  "filter",
                                          "filtertype", "discardmipmaps", "channel",
                                          NULL};
    (void)is_float;
    bool invert = false;
    double scale = 1.0;
    enum texture_wrap wrap;
    enum texture_encoding encoding;
    pbrt_params_ignore(&p->params, ignored);
    const struct pbrt_param *name = pbrt_params_find(&p->params, "filename", PBRT_STRING);
    if (!name)
        return err_set(err, ERR_VALUE, &p->params.place,
                       "Texture \"imagemap\" wants \"string filename\"");
    if (!pbrt_params_float(&p->params, "scale", &scale, err) ||
        !pbrt_params_float(&p->params, "gain", &scale, err) ||
        !read_wrap(p, &wrap, err) || !read_encoding(p, &encoding, err))
        return false;
    char *path = pbrt_path(p, pbrt_params_text(&p->params, name));
    struct err failure = {0};
    const struct texture_image *image = texture_image_load(
        &p->desc->textures, path, encoding, &name->place, &p->desc->log, &failure);
    mem_free(path);
    if (!image && failure.code != ERR_NONE) {
        *err = failure;
        return false;
    }
    struct texture *made = image ? texture_picture(&p->desc->textures, image, wrap)
                                 : texture_constant(&p->desc->textures, rgb_grey(0.5));
    made->value = rgb_scale(made->value, fmax(scale, 0.0));
    if (scale < 0.0)
        log_note(&p->desc->log, &p->params.place, "a texture of negative scale is black");
    out->texture = image ? made : NULL;
    out->value = made->value;
    if (!pbrt_texture_mapping(p, made, err) ||
        !pbrt_params_bool(&p->params, "invert", &invert, err))
        return false;
    if (invert)
        invert_value(p, out);
    return true;
}

static const struct texture_row {
    const char *name;
    bool (*read)(struct pbrt *p, bool is_float, struct pbrt_value *out, struct err *err);
} rows[] = {
    {"constant", constant},
    {"imagemap", imagemap},
    {"scale", product},
    {"mix", mix},
    {"checkerboard", checkerboard},
    {"fbm", pbrt_texture_fbm},
    {"marble", pbrt_texture_marble},
    {"wrinkled", pbrt_texture_wrinkled},
    {"windy", pbrt_texture_windy},
    {"dots", pbrt_texture_dots},
    {"bilerp", NULL},
    {"uv", NULL},
    {"directionmix", NULL},
    {"ptex", NULL},
};

#define ROWS (sizeof rows / sizeof rows[0])

static bool read_class(struct pbrt *p, const char *class, bool is_float,
                       struct pbrt_value *out, struct err *err)
{
    const char *known[ROWS + 1] = {0};
    const struct place *at = &p->params.head_places[2];
    for (size_t i = 0; i < ROWS; i++) {
        known[i] = rows[i].name;
        if (!text_equal(class, rows[i].name))
            continue;
        if (rows[i].read)
            return rows[i].read(p, is_float, out, err);
        log_note(&p->desc->log, at, "a texture \"%s\" is replaced by a constant 0.5",
                 class);
        pbrt_ignored(p, err);
        out->value = rgb_grey(0.5);
        return true;
    }
    if (p->lux) {
        log_note(&p->desc->log, at, "a texture \"%s\" is replaced by a constant 0.5",
                 class);
        out->value = rgb_grey(0.5);
        return pbrt_ignored(p, err);
    }
    return suggest_fail(err, at, "texture", class, known);
}

bool pbrt_colour_texture(struct pbrt *p, struct err *err)
{
    static const char *const kinds[] = {"float", "spectrum", "color", NULL};
    const char *kind = pbrt_params_head(&p->params, 1);
    bool is_float = text_equal(kind, "float");
    if (!is_float && !text_equal(kind, "spectrum") && !text_equal(kind, "color"))
        return suggest_fail(err, &p->params.head_places[1], "kind of texture", kind,
                            kinds);
    struct pbrt_value value = {0};
    if (!read_class(p, pbrt_params_head(&p->params, 2), is_float, &value, err) ||
        (value.texture && !texture_check(value.texture, &p->params.place, err)))
        return false;
    struct pbrt_named *texture = pbrt_names_add(&p->textures,
                                                pbrt_params_head(&p->params, 0));
    texture->is_colour = !is_float;
    texture->value = value.value;
    texture->texture = value.texture;
    return true;
}

#include "import/pbrt/pbrt_colour.h"

#include "base/mem.h"
#include "import/pbrt/pbrt_colour_space.h"
#include "import/spectrum.h"
#include "import/spectrum_named.h"

static bool one_value(const struct pbrt_param *param, const char *name, size_t numbers,
                      struct err *err)
{
    if (param->count == numbers)
        return true;
    return err_set(err, ERR_VALUE, &param->place,
                   "\"%s %s\" holds %zu numbers, %zu are wanted", param->type_name, name,
                   param->count, numbers);
}

/* What a colour is for: v4 takes spectra of the two kinds to Rec. 709 by different rules.
 */
enum use { REFLECTS, SHINES };

/* v4 scales the spectrum of a light to luminance 1; "scale", "power" give the rest. */
static struct rgb of_luminance_1(struct rgb value)
{
    double y = rgb_luminance(value);
    return y > 1e-290 ? rgb_scale(value, 1.0 / y) : value; /* 1 / y is finite */
}

/* v3: integrated with the observer, so that a constant is the white of equal energy. v4:
 * a constant reflectance or index is grey, for it multiplies light like D65. */
static bool from_pairs(const struct pbrt *p, enum use use, const double *pairs,
                       size_t count, struct rgb *value)
{
    if (pbrt_is_v4(p) && use == REFLECTS)
        return spectrum_reflectance_from_pairs(pairs, count, value);
    if (!spectrum_from_pairs(pairs, count, value))
        return false;
    if (pbrt_is_v4(p))
        *value = of_luminance_1(*value);
    return true;
}

static bool from_spectrum_file(struct pbrt *p, const struct pbrt_param *param,
                               enum use use, struct rgb *value, struct err *err)
{
    size_t count;
    char *path = pbrt_path(p, pbrt_params_text(&p->params, param));
    double *pairs = spectrum_read_file(path, &param->place, &count, err);
    bool read = pairs && from_pairs(p, use, pairs, count, value);
    mem_free(pairs);
    mem_free(path);
    return read;
}

/* A string is a built-in spectrum or else a file, as in v4. */
static bool from_spectrum(struct pbrt *p, const struct pbrt_param *param, enum use use,
                          const char *name, struct rgb *value, struct err *err)
{
    const char *text = pbrt_params_text(&p->params, param);
    const double *pairs = pbrt_params_numbers(&p->params, param);
    size_t count = param->count / 2;
    if (param->is_string && spectrum_named_illuminant(text, value))
        return true;
    if (param->is_string && !spectrum_named(text, &pairs, &count))
        return from_spectrum_file(p, param, use, value, err);
    if (from_pairs(p, use, pairs, count, value))
        return true;
    return err_set(err, ERR_VALUE, &param->place,
                   "\"spectrum %s\" wants pairs of a rising wavelength and a value",
                   name);
}

/* v3 gives a temperature and a scale, v4 a temperature alone. */
static bool from_blackbody(const struct pbrt *p, const struct pbrt_param *param,
                           const char *name, struct rgb *value, struct err *err)
{
    const double *n = pbrt_params_numbers(&p->params, param);
    bool alone = param->count == 1;
    if (!alone && !one_value(param, name, 2, err))
        return false;
    *value = spectrum_from_blackbody(n[0]);
    if (alone || pbrt_is_v4(p))
        *value = of_luminance_1(*value);
    *value = rgb_scale(*value, alone ? 1.0 : n[1]);
    return true;
}

static bool from_param(struct pbrt *p, const struct pbrt_param *param, enum use use,
                       const char *name, struct rgb *value, struct err *err)
{
    if (param->type == PBRT_SPECTRUM)
        return from_spectrum(p, param, use, name, value, err);
    if (param->type == PBRT_BLACKBODY)
        return from_blackbody(p, param, name, value, err);
    const double *n = pbrt_params_numbers(&p->params, param);
    if (!one_value(param, name, 3, err))
        return false;
    struct rgb read = rgb(n[0], n[1], n[2]);
    if (param->type == PBRT_XYZ)
        *value = spectrum_from_xyz(n[0], n[1], n[2]);
    else if (use == SHINES)
        *value = pbrt_colour_space_light(p->state.colour_space, read);
    else
        *value = pbrt_colour_space_reflectance(p->state.colour_space, read);
    return true;
}

static bool from_texture(struct pbrt *p, const struct pbrt_param *param, bool colour,
                         struct pbrt_value *value, struct err *err)
{
    const char *name = pbrt_params_text(&p->params, param);
    const struct pbrt_named *texture = pbrt_names_find(&p->textures, "texture", name,
                                                       &param->place, err);
    if (!texture)
        return false;
    if (texture->is_colour != colour)
        return err_set(err, ERR_VALUE, &param->place, "texture \"%s\" holds %s", name,
                       colour ? "numbers, a colour is wanted"
                              : "colours, a number is wanted");
    *value = (struct pbrt_value){texture->value, texture->texture};
    return true;
}

static bool read_value(struct pbrt *p, const char *name, enum use use,
                       struct pbrt_value *value, struct err *err)
{
    const struct pbrt_param *param = pbrt_params_find(&p->params, name,
                                                      PBRT_COLOUR | PBRT_TEXTURE);
    if (!param)
        return true;
    struct pbrt_value read = {0};
    if (param->type == PBRT_TEXTURE ? !from_texture(p, param, true, &read, err)
                                    : !from_param(p, param, use, name, &read.value, err))
        return false;
    read.value = scene_desc_clamp(p->desc, read.value, &param->place);
    *value = read;
    return true;
}

bool pbrt_colour_value(struct pbrt *p, const char *name, struct pbrt_value *value,
                       struct err *err)
{
    return read_value(p, name, REFLECTS, value, err);
}

bool pbrt_colour_float_value(struct pbrt *p, const char *name, struct pbrt_value *value,
                             struct err *err)
{
    const struct pbrt_param *param = pbrt_params_find(&p->params, name,
                                                      PBRT_FLOAT | PBRT_TEXTURE);
    if (!param)
        return true;
    if (param->type == PBRT_TEXTURE)
        return from_texture(p, param, false, value, err);
    double number = 0.0;
    if (!pbrt_params_float(&p->params, name, &number, err))
        return false;
    *value = (struct pbrt_value){.value = rgb_grey(number)};
    return true;
}

static struct rgb one_for_all(struct pbrt *p, const char *name,
                              const struct pbrt_value *value)
{
    if (!value->texture)
        return value->value;
    log_note(&p->desc->log, &p->params.place,
             "%s takes no texture here; the value of its middle is used", name);
    return texture_eval_uv(value->texture, 0.5, 0.5);
}

static bool read_one(struct pbrt *p, const char *name, enum use use, struct rgb *value,
                     struct err *err)
{
    struct pbrt_value read = {.value = *value};
    if (!read_value(p, name, use, &read, err))
        return false;
    *value = one_for_all(p, name, &read);
    return true;
}

bool pbrt_colour(struct pbrt *p, const char *name, struct rgb *value, struct err *err)
{
    return read_one(p, name, REFLECTS, value, err);
}

bool pbrt_colour_light(struct pbrt *p, const char *name, struct rgb *value,
                       struct err *err)
{
    return read_one(p, name, SHINES, value, err);
}

bool pbrt_colour_float(struct pbrt *p, const char *name, double *value, bool *found,
                       struct err *err)
{
    struct pbrt_value read = {.value = rgb_grey(*value)};
    if (found)
        *found = pbrt_params_find(&p->params, name, PBRT_FLOAT | PBRT_TEXTURE) != NULL;
    if (!pbrt_colour_float_value(p, name, &read, err))
        return false;
    *value = one_for_all(p, name, &read).g;
    return true;
}

const struct texture *pbrt_colour_node(struct pbrt *p, const struct pbrt_value *value)
{
    if (value->texture)
        return value->texture;
    return texture_constant(&p->desc->textures, value->value);
}

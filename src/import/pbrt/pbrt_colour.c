#include "import/pbrt/pbrt_colour.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/spectrum.h"

static bool one_value(const struct pbrt_param *param, const char *name, size_t numbers,
                      struct err *err)
{
    if (param->count == numbers)
        return true;
    return err_set(err, ERR_VALUE, &param->place,
                   "\"%s %s\" holds %zu numbers, %zu are wanted", param->type_name, name,
                   param->count, numbers);
}

static bool from_spectrum(struct pbrt *p, const struct pbrt_param *param,
                          const char *name, struct rgb *value, struct err *err)
{
    if (param->is_string) {
        char *path = text_join(p->directory, pbrt_params_text(&p->params, param));
        bool read = spectrum_from_file(path, &param->place, value, err);
        mem_free(path);
        return read;
    }
    if (spectrum_from_pairs(pbrt_params_numbers(&p->params, param), param->count / 2,
                            value))
        return true;
    return err_set(err, ERR_VALUE, &param->place,
                   "\"spectrum %s\" wants pairs of a rising wavelength and a value",
                   name);
}

static bool from_param(struct pbrt *p, const struct pbrt_param *param, const char *name,
                       struct rgb *value, struct err *err)
{
    if (param->type == PBRT_SPECTRUM)
        return from_spectrum(p, param, name, value, err);
    const double *n = pbrt_params_numbers(&p->params, param);
    if (!one_value(param, name, param->type == PBRT_BLACKBODY ? 2 : 3, err))
        return false;
    if (param->type == PBRT_BLACKBODY)
        *value = rgb_scale(spectrum_from_blackbody(n[0]), n[1]);
    else if (param->type == PBRT_XYZ)
        *value = spectrum_from_xyz(n[0], n[1], n[2]);
    else
        *value = rgb(n[0], n[1], n[2]);
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

bool pbrt_colour_value(struct pbrt *p, const char *name, struct pbrt_value *value,
                       struct err *err)
{
    const struct pbrt_param *param = pbrt_params_find(&p->params, name,
                                                      PBRT_COLOUR | PBRT_TEXTURE);
    if (!param)
        return true;
    struct pbrt_value read = {0};
    if (param->type == PBRT_TEXTURE ? !from_texture(p, param, true, &read, err)
                                    : !from_param(p, param, name, &read.value, err))
        return false;
    read.value = scene_desc_clamp(p->desc, read.value, &param->place);
    *value = read;
    return true;
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
    return texture_eval(value->texture, 0.5, 0.5);
}

bool pbrt_colour(struct pbrt *p, const char *name, struct rgb *value, struct err *err)
{
    struct pbrt_value read = {.value = *value};
    if (!pbrt_colour_value(p, name, &read, err))
        return false;
    *value = one_for_all(p, name, &read);
    return true;
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

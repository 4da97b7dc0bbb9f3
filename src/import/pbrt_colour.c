#include "import/pbrt_colour.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/spectrum.h"
#include "import/suggest.h"

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
                         struct rgb *value, struct err *err)
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
    *value = texture->value;
    return true;
}

bool pbrt_colour(struct pbrt *p, const char *name, struct rgb *value, struct err *err)
{
    const struct pbrt_param *param = pbrt_params_find(&p->params, name,
                                                      PBRT_COLOUR | PBRT_TEXTURE);
    if (!param)
        return true;
    struct rgb read = {0};
    if (param->type == PBRT_TEXTURE ? !from_texture(p, param, true, &read, err)
                                    : !from_param(p, param, name, &read, err))
        return false;
    *value = scene_desc_clamp(p->desc, read, &param->place);
    return true;
}

bool pbrt_colour_float(struct pbrt *p, const char *name, double *value, bool *found,
                       struct err *err)
{
    const struct pbrt_param *param = pbrt_params_find(&p->params, name,
                                                      PBRT_FLOAT | PBRT_TEXTURE);
    if (found)
        *found = param != NULL;
    if (!param)
        return true;
    if (param->type == PBRT_FLOAT)
        return pbrt_params_float(&p->params, name, value, err);
    struct rgb read = {0};
    if (!from_texture(p, param, false, &read, err))
        return false;
    *value = read.r;
    return true;
}

bool pbrt_colour_texture(struct pbrt *p, struct err *err)
{
    static const char *const kinds[] = {"float", "spectrum", "color", NULL};
    const struct pbrt_params *params = &p->params;
    const char *kind = pbrt_params_head(params, 1);
    const char *class = pbrt_params_head(params, 2);
    bool is_float = text_equal(kind, "float");
    if (!is_float && !text_equal(kind, "spectrum") && !text_equal(kind, "color"))
        return suggest_fail(err, &params->head_places[1], "kind of texture", kind, kinds);
    if (!text_equal(class, "constant"))
        return err_set(err, ERR_UNSUPPORTED, &params->head_places[2],
                       "texture \"%s\" is not read yet, only \"constant\" is", class);
    struct rgb value = rgb_grey(1.0);
    if (is_float ? !pbrt_colour_float(p, "value", &value.r, NULL, err)
                 : !pbrt_colour(p, "value", &value, err))
        return false;
    struct pbrt_named *texture = pbrt_names_add(&p->textures,
                                                pbrt_params_head(params, 0));
    texture->is_colour = !is_float;
    texture->value = value;
    return true;
}

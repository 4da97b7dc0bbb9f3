#include "import/pbrt/pbrt_scene.h"
#include "import/pbrt/pbrt_texture.h"

#include "base/text.h"
#include "surface/perlin.h"

#include <math.h>

/* One of LuxRender's vectors; fallback in all three if it is absent. */
static bool vector(struct pbrt *p, const char *name, double fallback, double out[3],
                   struct err *err)
{
    const struct pbrt_param *param = pbrt_params_find(&p->params, name, PBRT_VECTOR);
    for (int i = 0; i < 3; i++)
        out[i] = fallback;
    if (!param)
        return true;
    if (param->count != 3)
        return err_set(err, ERR_VALUE, &param->place, "\"vector %s\" wants 3 numbers",
                       name);
    for (int i = 0; i < 3; i++)
        out[i] = pbrt_params_numbers(&p->params, param)[i];
    return true;
}

/* to_texture = to_texture (1 / scale) rotate_x rotate_y rotate_z (-translate). */
static bool lux_space(struct pbrt *p, struct xform *to_texture, struct err *err)
{
    double scale[3], turn[3], move[3];
    const struct pbrt_param *kind = pbrt_params_find(&p->params, "coordinates",
                                                     PBRT_STRING);
    if (kind && !text_equal(pbrt_params_text(&p->params, kind), "global"))
        log_note(&p->desc->log, &kind->place,
                 "the coordinates \"%s\" are taken as \"global\": the scene's space",
                 pbrt_params_text(&p->params, kind));
    if (!vector(p, "scale", 1.0, scale, err) || !vector(p, "rotate", 0.0, turn, err) ||
        !vector(p, "translate", 0.0, move, err))
        return false;
    if (scale[0] == 0.0 || scale[1] == 0.0 || scale[2] == 0.0)
        return err_set(err, ERR_VALUE, &p->params.place, "a texture of scale 0");
    const struct xform steps[] = {
        xform_scale(1.0 / scale[0], 1.0 / scale[1], 1.0 / scale[2]),
        xform_rotate(turn[0], 1.0, 0.0, 0.0),
        xform_rotate(turn[1], 0.0, 1.0, 0.0),
        xform_rotate(turn[2], 0.0, 0.0, 1.0),
        xform_translate(-move[0], -move[1], -move[2]),
    };
    for (size_t i = 0; i < sizeof steps / sizeof steps[0]; i++)
        *to_texture = xform_mul(to_texture, &steps[i]);
    return true;
}

bool pbrt_texture_space(struct pbrt *p, struct texture *texture, struct err *err)
{
    if (!pbrt_state_check(p, err))
        return false;
    struct xform to_texture = xform_inverse(&p->state.ctm);
    if (p->lux && !lux_space(p, &to_texture, err))
        return false;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 4; j++)
            texture->space[i][j] = to_texture.m[i][j];
    return true;
}

bool pbrt_texture_dots(struct pbrt *p, bool is_float, struct pbrt_value *out,
                       struct err *err)
{
    struct pbrt_value inside, outside;
    if (!pbrt_texture_part(p, "inside", is_float, 1.0, &inside, err) ||
        !pbrt_texture_part(p, "outside", is_float, 0.0, &outside, err))
        return false;
    struct texture *made = texture_dots(&p->desc->textures, pbrt_colour_node(p, &inside),
                                        pbrt_colour_node(p, &outside));
    out->texture = made;
    return pbrt_texture_mapping(p, made, err);
}

/* octaves, roughness. */
static bool read_noise(struct pbrt *p, struct texture_noise *noise, struct err *err)
{
    *noise = (struct texture_noise){8, 0.5, 1.0, 0.2};
    if (!pbrt_params_int(&p->params, "octaves", &noise->octaves, err) ||
        !pbrt_params_float(&p->params, "roughness", &noise->roughness, err))
        return false;
    if (noise->octaves > PERLIN_OCTAVES_MAX) {
        log_note(&p->desc->log, &p->params.place, "%d octaves are taken as %d",
                 noise->octaves, PERLIN_OCTAVES_MAX);
        noise->octaves = PERLIN_OCTAVES_MAX;
    }
    return true;
}

bool pbrt_texture_fbm(struct pbrt *p, bool is_float, struct pbrt_value *out,
                      struct err *err)
{
    struct texture_noise noise;
    (void)is_float;
    if (!read_noise(p, &noise, err))
        return false;
    struct texture *made = texture_fbm(&p->desc->textures, noise.octaves,
                                       noise.roughness);
    out->texture = made;
    return pbrt_texture_space(p, made, err);
}

bool pbrt_texture_wrinkled(struct pbrt *p, bool is_float, struct pbrt_value *out,
                           struct err *err)
{
    struct texture_noise noise;
    (void)is_float;
    if (!read_noise(p, &noise, err))
        return false;
    struct texture *made = texture_wrinkled(&p->desc->textures, noise.octaves,
                                            noise.roughness);
    out->texture = made;
    return pbrt_texture_space(p, made, err);
}

bool pbrt_texture_windy(struct pbrt *p, bool is_float, struct pbrt_value *out,
                        struct err *err)
{
    (void)is_float;
    struct texture *made = texture_windy(&p->desc->textures);
    out->texture = made;
    return pbrt_texture_space(p, made, err);
}

bool pbrt_texture_marble(struct pbrt *p, bool is_float, struct pbrt_value *out,
                         struct err *err)
{
    struct texture_noise noise;
    (void)is_float;
    if (!read_noise(p, &noise, err) ||
        !pbrt_params_float(&p->params, "scale", &noise.scale, err) ||
        !pbrt_params_float(&p->params, "variation", &noise.variation, err))
        return false;
    struct texture *made = texture_marble(&p->desc->textures, &noise);
    out->texture = made;
    return pbrt_texture_space(p, made, err);
}

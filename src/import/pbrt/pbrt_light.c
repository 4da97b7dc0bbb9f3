#include "import/pbrt/pbrt_light.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/pbrt/pbrt_lux.h"
#include "import/pbrt/pbrt_scene.h"
#include "import/suggest.h"
#include "math/warp.h"

#include <math.h>

static const char *const sample_counts[] = {"samples", "nsamples", NULL};

/* v3 scales by a spectrum, v4 by a number. */
static bool read_scale(struct pbrt *p, struct rgb *value, struct err *err)
{
    struct rgb scale = rgb_grey(1.0);
    double number = 1.0;
    if (!pbrt_colour(p, "scale", &scale, err) ||
        !pbrt_colour_float(p, "scale", &number, NULL, err))
        return false;
    *value = rgb_scale(rgb_mul(*value, scale), number);
    pbrt_params_ignore(&p->params, sample_counts);
    return true;
}

static double mean_luminance(const struct texture_image *image)
{
    double sum = 0.0;
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++)
            sum += rgb_luminance(texture_image_texel(image, x, y));
    return sum / ((double)image->width * image->height);
}

/* v4: a picture over the lamp's parameters takes the place of L; a given power is that
 * of the picture's mean. */
static bool read_image(struct pbrt *p, struct rgb *radiance, struct err *err)
{
    const struct texture_image *image;
    const struct pbrt_param *name = pbrt_params_find(&p->params, "filename", PBRT_STRING);
    if (!name)
        return true;
    if (!pbrt_light_picture(p, name, &image, err))
        return false;
    if (!image)
        return true;
    p->state.emission = texture_picture(&p->desc->textures, image, TEXTURE_CLAMP);
    double mean = mean_luminance(image);
    if (p->state.power > 0.0 && mean > 0.0)
        *radiance = rgb_scale(*radiance, 1.0 / mean);
    return true;
}

/* LuxRender's L may be a texture. */
static bool read_radiance(struct pbrt *p, struct rgb *radiance, struct err *err)
{
    struct pbrt_value value = {.value = rgb_grey(1.0)};
    if (!p->lux || !pbrt_params_find(&p->params, "L", PBRT_TEXTURE))
        return pbrt_colour_light(p, "L", radiance, err);
    if (!pbrt_colour_value(p, "L", &value, err))
        return false;
    p->state.emission = value.texture;
    *radiance = value.texture ? rgb_grey(1.0) : value.value;
    return true;
}

bool pbrt_light_area(struct pbrt *p, struct err *err)
{
    static const char *const known[] = {"diffuse", "area", NULL};
    const char *kind = pbrt_params_head(&p->params, 0);
    if (!text_equal(kind, known[0]) && !text_equal(kind, known[1]))
        return suggest_fail(err, &p->params.head_places[0], "area light", kind, known);
    struct rgb radiance = rgb_grey(1.0);
    bool two_sided = false;
    p->state.emission = NULL;
    if (!read_radiance(p, &radiance, err) || !read_scale(p, &radiance, err) ||
        !pbrt_params_bool(&p->params, "twosided", &two_sided, err))
        return false;
    p->state.power = 0.0;
    if (pbrt_is_v4(p) && !pbrt_params_float(&p->params, "power", &p->state.power, err))
        return false;
    if (!read_image(p, &radiance, err))
        return false;
    p->state.radiance = radiance;
    if (p->lux && !pbrt_lux_area_light(p, err))
        return false;
    p->state.emits = !rgb_is_black(p->state.radiance);
    p->state.two_sided = two_sided;
    return true;
}

bool pbrt_light_measure(struct pbrt *p, const char *name, double unscaled,
                        struct rgb *value, struct err *err)
{
    double measure = -1.0;
    if (!pbrt_is_v4(p))
        return true;
    if (!pbrt_params_float(&p->params, name, &measure, err))
        return false;
    if (measure > 0.0 && unscaled > 0.0)
        *value = rgb_scale(*value, measure / unscaled);
    return true;
}

bool pbrt_light_add(struct pbrt *p, struct light_desc *light, struct err *err)
{
    light->place = p->params.place;
    if (!read_scale(p, &light->intensity, err))
        return false;
    if (rgb_is_black(light->intensity))
        log_note(&p->desc->log, &light->place, "a light of no intensity is left out");
    else
        scene_desc_add_light(p->desc, light);
    return true;
}

/* pbrt v3 moves the light by `from` after the CTM, so `from` is in world axes; v4 before.
 */
static bool point_light(struct pbrt *p, struct err *err)
{
    struct light_desc light = {.intensity = rgb_grey(1.0)};
    double v[3] = {0.0, 0.0, 0.0};
    bool found;
    if (!pbrt_colour_light(p, "I", &light.intensity, err) ||
        !pbrt_params_point(&p->params, "from", v, &found, err) ||
        !pbrt_light_measure(p, "power", 4.0 * MATH_PI, &light.intensity, err))
        return false;
    struct xform move = xform_translate(v[0], v[1], v[2]);
    light.to_world = pbrt_is_v4(p) ? xform_mul(&p->state.ctm, &move)
                                   : xform_mul(&move, &p->state.ctm);
    return pbrt_light_add(p, &light, err);
}

/* The transform whose +z runs from one point to the other, after the CTM. */
static bool aim(struct pbrt *p, double from[3], double to[3], struct xform *out,
                struct err *err)
{
    bool found;
    if (!pbrt_params_point(&p->params, "from", from, &found, err) ||
        !pbrt_params_point(&p->params, "to", to, &found, err))
        return false;
    double d[3] = {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
    bool steep = fabs(d[2]) > fabs(d[0]) && fabs(d[2]) > fabs(d[1]);
    const double up[3] = {steep ? 1.0 : 0.0, 0.0, steep ? 0.0 : 1.0};
    struct xform look;
    if (!xform_look_at(from, to, up, &look))
        return err_set(err, ERR_VALUE, &p->params.place,
                       "the light shines nowhere: from and to coincide");
    *out = xform_mul(&p->state.ctm, &look);
    return true;
}

/* Flux of a v4 spot of intensity 1; the cubic's mean over its edge is 1/2. */
static double spot_flux(double inner, double outer)
{
    double from = cos(inner * MATH_PI / 180.0), to = cos(outer * MATH_PI / 180.0);
    return 2.0 * MATH_PI * ((1.0 - from) + 0.5 * (from - to));
}

static bool spot_light(struct pbrt *p, struct err *err)
{
    struct light_desc light = {.type = &light_spot, .intensity = rgb_grey(1.0)};
    double from[3] = {0.0, 0.0, 0.0}, to[3] = {0.0, 0.0, 1.0};
    double outer = 30.0, delta = 5.0;
    if (!pbrt_colour_light(p, "I", &light.intensity, err) ||
        !pbrt_params_float(&p->params, "coneangle", &outer, err) ||
        !pbrt_params_float(&p->params, "conedeltaangle", &delta, err) ||
        !aim(p, from, to, &light.to_world, err))
        return false;
    light.outer = outer;
    light.inner = fmax(0.0, outer - delta);
    light.smooth = pbrt_is_v4(p);
    if (!pbrt_light_measure(p, "power", spot_flux(light.inner, outer), &light.intensity,
                            err))
        return false;
    return pbrt_light_add(p, &light, err);
}

static bool distant_light(struct pbrt *p, struct err *err)
{
    struct light_desc light = {.type = &light_distant, .intensity = rgb_grey(1.0)};
    double from[3] = {0.0, 0.0, 0.0}, to[3] = {0.0, 0.0, 1.0};
    if (!pbrt_colour_light(p, "L", &light.intensity, err) ||
        !pbrt_light_measure(p, "illuminance", 1.0, &light.intensity, err) ||
        !aim(p, from, to, &light.to_world, err))
        return false;
    return pbrt_light_add(p, &light, err);
}

static bool as_point(struct pbrt *p, struct err *err)
{
    static const char *const ignored[] = {"mapname", "filename", "fov", NULL};
    log_note(&p->desc->log, &p->params.place,
             "a light \"%s\" is taken as a point light of the same intensity",
             pbrt_params_head(&p->params, 0));
    pbrt_params_ignore(&p->params, ignored);
    return point_light(p, err);
}

bool pbrt_light_source(struct pbrt *p, struct err *err)
{
    static const struct {
        const char *name;
        bool (*read)(struct pbrt *p, struct err *err);
    } rows[] = {{"point", point_light},     {"spot", spot_light},
                {"distant", distant_light}, {"infinite", pbrt_light_infinite},
                {"goniometric", as_point},  {"projection", as_point}};
    if (p->lux && pbrt_lux_is_sky(p))
        return pbrt_lux_sky(p, err);
    enum { ROWS = sizeof rows / sizeof rows[0] };
    const char *known[ROWS + 1] = {0}, *kind = pbrt_params_head(&p->params, 0);
    for (int i = 0; i < ROWS; i++) {
        known[i] = rows[i].name;
        if (text_equal(kind, rows[i].name))
            return pbrt_state_check(p, err) && rows[i].read(p, err);
    }
    return suggest_fail(err, &p->params.head_places[0], "light", kind, known);
}

static double quadric_area(const struct shape_desc *shape)
{
    double scale = 0.0, r = shape->radius;
    if (!xform_is_similarity(&shape->to_world, &scale))
        return 0.0;
    double area = shape->kind == SHAPE_SPHERE ? 4.0 * MATH_PI * r * r
                  : shape->kind == SHAPE_DISK
                      ? MATH_PI * r * r
                      : 2.0 * MATH_PI * r * (shape->z_max - shape->z_min);
    return area * scale * scale;
}

/* A diffuse emitter of radiance 1 sends pi for each unit of area. */
struct rgb pbrt_light_radiance(const struct pbrt *p, const struct shape_desc *shape)
{
    double sides = p->state.two_sided && pbrt_is_v4(p) ? 2.0 : 1.0;
    double area = shape->mesh ? mesh_area(shape->mesh) : quadric_area(shape);
    if (p->state.power <= 0.0 || !(area > 0.0))
        return p->state.radiance;
    return rgb_scale(p->state.radiance, p->state.power / (MATH_PI * area * sides));
}

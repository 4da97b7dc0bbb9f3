/* LuxRender's additions to pbrt's grammar: volumes, other names of materials and
 * integrators, area lights in lumens. */

#include "import/pbrt/pbrt_lux.h"

#include "base/text.h"
#include "import/sky.h"
#include "scene/light.h"

bool pbrt_lux_integrator(struct pbrt *p, struct err *err)
{
    int eye = 0, light = 0, depth = 0;
    if (!pbrt_params_int(&p->params, "eyedepth", &eye, err) ||
        !pbrt_params_int(&p->params, "lightdepth", &light, err) ||
        !pbrt_params_int(&p->params, "maxdepth", &depth, err))
        return false;
    pbrt_ignored(p, err);
    int edges = depth > 0 ? depth + 1 : eye + light;
    p->desc->max_depth = edges < 1 ? 12 : edges > 64 ? 64 : edges;
    return true;
}

bool pbrt_lux_film(struct pbrt *p, const char *kind)
{
    if (!text_equal(kind, "multiimage"))
        return false;
    log_remark(&p->desc->log, &p->params.place,
               "the film \"%s\" is read for its size alone", kind);
    return true;
}

double pbrt_lux_focus(double distance, double lens_radius)
{
    return distance == 0.0 && lens_radius == 0.0 ? 1e6 : distance;
}

/* sky2 and sunsky2 name a later model of the same. */
static const struct {
    const char *name;
    bool sky, sun;
} skies[] = {{"sun", false, true},
             {"sky", true, false},
             {"sunsky", true, true},
             {"sky2", true, false},
             {"sunsky2", true, true}};

bool pbrt_lux_is_sky(const struct pbrt *p)
{
    for (size_t i = 0; i < sizeof skies / sizeof skies[0]; i++)
        if (text_equal(pbrt_params_head(&p->params, 0), skies[i].name))
            return true;
    return false;
}

static bool sky_numbers(struct pbrt *p, struct sky_options *options, double *gain,
                        struct err *err)
{
    const struct pbrt_param *sun = pbrt_params_find(&p->params, "sundir", PBRT_VECTOR);
    if (sun && sun->count == 3)
        for (int i = 0; i < 3; i++)
            options->sun[i] = pbrt_params_numbers(&p->params, sun)[i];
    return pbrt_params_float(&p->params, "turbidity", &options->turbidity, err) &&
           pbrt_params_float(&p->params, "relsize", &options->sun_radius_scale, err) &&
           pbrt_params_float(&p->params, "gain", gain, err);
}

bool pbrt_lux_sky(struct pbrt *p, struct err *err)
{
    static const char *const ignored[] = {"nsamples", "importance", NULL};
    struct light_desc light = {.type = &light_environment, .to_world = p->state.ctm};
    struct sky_options options = {.sun = {0.0, 0.0, 1.0},
                                  .turbidity = 2.0,
                                  .sun_radius_scale = 1.0,
                                  .ground = true};
    const char *kind = pbrt_params_head(&p->params, 0);
    double gain = 1.0;
    for (size_t i = 0; i < sizeof skies / sizeof skies[0]; i++)
        if (text_equal(kind, skies[i].name)) {
            options.sky_scale = skies[i].sky;
            options.sun_scale = skies[i].sun;
        }
    pbrt_params_ignore(&p->params, ignored);
    if (!sky_numbers(p, &options, &gain, err) ||
        !sky_check(p->desc, &options, &p->params.place, err))
        return false;
    log_note(&p->desc->log, &p->params.place,
             "light \"%s\" is a picture of Preetham's sky, its sun about a third of a "
             "degree blurred",
             kind);
    light.map = sky_picture(&p->desc->textures, &options);
    light.intensity = rgb_grey(gain);
    light.place = p->params.place;
    scene_desc_add_light(p->desc, &light);
    return true;
}

bool pbrt_lux_volume(struct pbrt *p, struct err *err)
{
    double index = 1.5;
    if (!pbrt_colour_float(p, "fresnel", &index, NULL, err))
        return false;
    pbrt_ignored(p, err);
    log_note(&p->desc->log, &p->params.place,
             "of a volume only the index is used: nothing absorbs or scatters");
    p->lux_index = index;
    return true;
}

bool pbrt_lux_nothing(struct pbrt *p, struct err *err)
{
    return pbrt_ignored(p, err);
}

/* eta and k of named metals, from measured spectra in linear Rec. 709. */
static const struct {
    const char *name;
    struct rgb eta, k;
} metals[] = {
    {"silver", {0.1552646, 0.1167233, 0.1383807}, {4.8283433, 3.1222459, 2.1470504}},
    {"aluminium", {1.6574600, 0.8803690, 0.5212287}, {9.2238692, 6.2695232, 4.8370012}},
    {"gold", {0.1431190, 0.3749570, 1.4424786}, {3.9831604, 2.3857207, 1.6032153}},
    {"copper", {0.2004377, 0.9240334, 1.1022120}, {3.9129485, 2.4528477, 2.1421880}},
};

void pbrt_lux_metal(struct pbrt *p, struct rgb *eta, struct rgb *k)
{
    const struct pbrt_param *param = pbrt_params_find(&p->params, "name", PBRT_STRING);
    if (!param)
        return;
    const char *name = pbrt_params_text(&p->params, param);
    for (size_t i = 0; i < sizeof metals / sizeof metals[0]; i++)
        if (text_equal(name, metals[i].name)) {
            *eta = metals[i].eta;
            *k = metals[i].k;
            return;
        }
    log_note(&p->desc->log, &param->place, "the metal \"%s\" is taken as copper", name);
}

bool pbrt_lux_area_light(struct pbrt *p, struct err *err)
{
    static const char *const ignored[] = {"importance", NULL};
    double power = 0.0, efficacy = 0.0, gain = 1.0;
    if (!pbrt_params_float(&p->params, "power", &power, err) ||
        !pbrt_params_float(&p->params, "efficacy", &efficacy, err) ||
        !pbrt_params_float(&p->params, "gain", &gain, err))
        return false;
    pbrt_params_ignore(&p->params, ignored);
    p->state.radiance = rgb_scale(p->state.radiance, gain);
    double colour = rgb_luminance(p->state.radiance);
    p->state.power = power > 0.0 && efficacy > 0.0 && colour > 0.0
                         ? gain * power * efficacy
                         : 0.0;
    if (p->state.power > 0.0)
        p->state.radiance = rgb_scale(p->state.radiance, 1.0 / colour);
    return true;
}

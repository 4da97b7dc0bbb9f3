#include "import/pbrt_scene.h"

#include "base/text.h"
#include "import/pbrt_colour.h"
#include "import/suggest.h"

static const char *const sample_counts[] = {"samples", "nsamples", NULL};

bool pbrt_light_area(struct pbrt *p, struct err *err)
{
    static const char *const known[] = {"diffuse", "area", NULL};
    const char *kind = pbrt_params_head(&p->params, 0);
    if (!text_equal(kind, known[0]) && !text_equal(kind, known[1]))
        return suggest_fail(err, &p->params.head_places[0], "area light", kind, known);
    struct rgb radiance = rgb_grey(1.0), scale = rgb_grey(1.0);
    bool two_sided = false;
    if (!pbrt_colour(p, "L", &radiance, err) || !pbrt_colour(p, "scale", &scale, err) ||
        !pbrt_params_bool(&p->params, "twosided", &two_sided, err))
        return false;
    pbrt_params_ignore(&p->params, sample_counts);
    p->state.radiance = rgb_mul(radiance, scale);
    p->state.emits = !rgb_is_black(p->state.radiance);
    p->state.two_sided = two_sided;
    return true;
}

/* pbrt v3 moves the light by `from` after the CTM, so `from` is in world axes. */
static bool point_light(struct pbrt *p, struct err *err)
{
    struct light_desc light = {.place = p->params.place};
    struct rgb intensity = rgb_grey(1.0), scale = rgb_grey(1.0);
    if (!pbrt_colour(p, "I", &intensity, err) || !pbrt_colour(p, "scale", &scale, err))
        return false;
    struct xform move = xform_identity();
    const struct pbrt_param *from = pbrt_params_find(&p->params, "from", PBRT_POINT);
    if (from) {
        if (from->count != 3)
            return err_set(err, ERR_VALUE, &from->place, "\"point from\" is one point");
        const double *v = pbrt_params_numbers(&p->params, from);
        move = xform_translate(v[0], v[1], v[2]);
    }
    pbrt_params_ignore(&p->params, sample_counts);
    light.to_world = xform_mul(&move, &p->state.ctm);
    light.intensity = rgb_mul(intensity, scale);
    if (rgb_is_black(light.intensity))
        log_note(&p->desc->log, &light.place, "a light of no intensity is left out");
    else
        scene_desc_add_light(p->desc, &light);
    return true;
}

bool pbrt_light_source(struct pbrt *p, struct err *err)
{
    static const char *const known[] = {
        "point", "spot", "distant", "infinite", "goniometric", "projection", NULL};
    const char *kind = pbrt_params_head(&p->params, 0);
    const struct place *at = &p->params.head_places[0];
    if (text_equal(kind, "point"))
        return point_light(p, err);
    for (int i = 1; known[i]; i++)
        if (text_equal(kind, known[i]))
            return err_set(err, ERR_UNSUPPORTED, at,
                           "light \"%s\" is not read yet, only \"point\" is", kind);
    return suggest_fail(err, at, "light", kind, known);
}

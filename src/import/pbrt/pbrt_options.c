#include "import/pbrt/pbrt_scene.h"

#include "base/text.h"
#include "import/pbrt/pbrt_lux.h"
#include "import/suggest.h"

#include <math.h>
#include <stdio.h>

static bool is_one_of(const char *name, const char *const *list)
{
    for (; *list; list++)
        if (text_equal(name, *list))
            return true;
    return false;
}

/* Four floats of that name, or nothing. */
static bool find_four(struct pbrt *p, const char *name, double out[4], bool *found,
                      struct err *err)
{
    const struct pbrt_param *param = pbrt_params_find(&p->params, name, PBRT_FLOAT);
    *found = param != NULL;
    if (!param)
        return true;
    if (param->count != 4)
        return err_set(err, ERR_VALUE, &param->place, "\"float %s\" wants 4 numbers",
                       name);
    const double *v = pbrt_params_numbers(&p->params, param);
    for (int i = 0; i < 4; i++)
        out[i] = v[i];
    return v[0] < v[1] && v[2] < v[3]
               ? true
               : err_set(err, ERR_VALUE, &param->place,
                         "\"float %s\" wants x0 < x1 and y0 < y1", name);
}

/* screenwindow replaces frameaspectratio, which replaces the film's aspect. */
static bool camera_window(struct pbrt *p, struct camera_desc *camera, struct err *err)
{
    double frame = 0.0;
    if (!find_four(p, "screenwindow", camera->window, &camera->has_window, err) ||
        !pbrt_params_float(&p->params, "frameaspectratio", &frame, err))
        return false;
    if (camera->has_window || !(frame > 0.0))
        return true;
    double x = fmax(frame, 1.0), y = fmax(1.0 / frame, 1.0);
    camera->has_window = true;
    camera->window[0] = -x;
    camera->window[1] = x;
    camera->window[2] = -y;
    camera->window[3] = y;
    return true;
}

bool pbrt_camera(struct pbrt *p, struct err *err)
{
    static const char *const known[] = {"perspective", "orthographic", "environment",
                                        "realistic", NULL};
    const char *kind = pbrt_params_head(&p->params, 0);
    const struct place *at = &p->params.head_places[0];
    if (!is_one_of(kind, known))
        return suggest_fail(err, at, "camera", kind, known);
    bool parallel = text_equal(kind, "orthographic");
    if (!parallel && !text_equal(kind, "perspective"))
        return err_set(err, ERR_UNSUPPORTED, at,
                       "camera \"%s\" is not read yet, only \"perspective\" and "
                       "\"orthographic\" are",
                       kind);
    if (!pbrt_state_check(p, err))
        return false;
    struct camera_desc *camera = &p->desc->camera;
    double fov = 90.0, half = -1.0, focus = 1e6, lens = 0.0, open = 0.0, close = 1.0;
    if ((!parallel && !pbrt_params_float(&p->params, "fov", &fov, err)) ||
        (!parallel && !pbrt_params_float(&p->params, "halffov", &half, err)) ||
        !pbrt_params_float(&p->params, "lensradius", &lens, err) ||
        !pbrt_params_float(&p->params, "focaldistance", &focus, err) ||
        !pbrt_params_float(&p->params, "shutteropen", &open, err) ||
        !pbrt_params_float(&p->params, "shutterclose", &close, err) ||
        !camera_window(p, camera, err))
        return false;
    if (p->lux)
        focus = pbrt_lux_focus(focus, lens);
    fov = half > 0.0 ? 2.0 * half : fov;
    if (!(fov > 0.0 && fov < 180.0))
        return err_set(err, ERR_VALUE, at, "fov %g is not between 0 and 180 degrees",
                       fov);
    if (lens < 0.0 || !(focus > 0.0))
        return err_set(err, ERR_VALUE, at, "lensradius or focaldistance is negative");
    p->shutter = close - open;
    camera->place = *at;
    camera->fov = fov;
    camera->extent = parallel ? 2.0 : 0.0;
    camera->fov_axis = FOV_SMALLER;
    camera->lens_radius = lens;
    camera->focus_distance = focus;
    camera->to_world = xform_inverse(&p->state.ctm);
    double scale; /* the lens lies in the camera's own space */
    if (xform_is_similarity(&camera->to_world, &scale)) {
        camera->lens_radius *= scale;
        camera->focus_distance *= scale;
    }
    if (p->lux) { /* its cameras are right-handed: +x is to the left of pbrt's */
        struct xform mirror = xform_scale(-1.0, 1.0, 1.0);
        camera->to_world = xform_mul(&camera->to_world, &mirror);
    }
    pbrt_names_add(&p->systems, "camera")->ctm = camera->to_world;
    return true;
}

/* v4's sensor: what it measures is exposed for the time that the shutter is open, times
 * iso / 100, and where it is not the CIE's observer its colours are much like it. */
static bool film_sensor(struct pbrt *p, double *scale, struct err *err)
{
    double iso = 100.0, seconds = 1.0, white = 0.0, brightest = HUGE_VAL;
    if (!pbrt_params_float(&p->params, "iso", &iso, err) ||
        !pbrt_params_float(&p->params, "exposuretime", &seconds, err) ||
        !pbrt_params_float(&p->params, "whitebalance", &white, err) ||
        !pbrt_params_float(&p->params, "maxcomponentvalue", &brightest, err))
        return false;
    if (!(iso > 0.0 && seconds > 0.0))
        return err_set(err, ERR_VALUE, &p->params.place,
                       "iso and exposuretime must be positive");
    const struct pbrt_param *sensor = pbrt_params_find(&p->params, "sensor", PBRT_STRING);
    if (sensor && !text_equal(pbrt_params_text(&p->params, sensor), "cie1931"))
        log_note(
            &p->desc->log, &sensor->place,
            "the sensor \"%s\" is taken as \"cie1931\": of its exposure, without its "
            "tints",
            pbrt_params_text(&p->params, sensor));
    if (white != 0.0)
        log_note(&p->desc->log, &p->params.place,
                 "whitebalance is not used: the picture keeps the light's colour");
    if (brightest < HUGE_VAL)
        log_note(&p->desc->log, &p->params.place,
                 "maxcomponentvalue is not used: it would darken the picture");
    *scale *= seconds * iso / 100.0;
    return true;
}

/* v4's crop in pixels; the half keeps the fraction clear of the rounding up to pixels. */
static bool film_bounds(struct pbrt *p, int x, int y, double crop[4], struct err *err)
{
    const struct pbrt_param *param = pbrt_params_find(&p->params, "pixelbounds",
                                                      PBRT_INTEGER);
    if (!param)
        return true;
    if (param->count != 4)
        return err_set(err, ERR_VALUE, &param->place,
                       "\"integer pixelbounds\" wants 4 numbers");
    for (int i = 0; i < 4; i++)
        crop[i] = (pbrt_params_numbers(&p->params, param)[i] - 0.5) / (i < 2 ? x : y);
    return true;
}

bool pbrt_film(struct pbrt *p, struct err *err)
{
    /* v4 names films after what they hold. */
    static const char *const known[] = {"image",    "rgb",       "gbuffer",
                                        "spectral", "fleximage", NULL};
    static const char *const ignored[] = {"filename",         "diagonal", "savefp16",
                                          "coordinatesystem", "nbuckets", "lambdamin",
                                          "lambdamax",        NULL};
    const char *kind = pbrt_params_head(&p->params, 0);
    if (!is_one_of(kind, known) && !(p->lux && pbrt_lux_film(p, kind)))
        return suggest_fail(err, &p->params.head_places[0], "film", kind, known);
    if (!p->lux)
        p->version = text_equal(kind, "image") ? PBRT_V3 : PBRT_V4;
    int x = 1280, y = 720;
    bool cropped;
    double scale = 1.0, brightest = HUGE_VAL;
    double crop[4] = {0.0, 1.0, 0.0, 1.0};
    if (!pbrt_params_int(&p->params, "xresolution", &x, err) ||
        !pbrt_params_int(&p->params, "yresolution", &y, err) ||
        !find_four(p, "cropwindow", crop, &cropped, err) ||
        !pbrt_params_float(&p->params, "scale", &scale, err) ||
        !pbrt_params_float(&p->params, "maxsampleluminance", &brightest, err))
        return false;
    pbrt_params_ignore(&p->params, ignored);
    if (pbrt_is_v4(p) && !film_sensor(p, &scale, err))
        return false;
    if (p->lux)
        pbrt_ignored(p, err); /* colour spaces and tone mapping of its pictures */
    if (brightest < HUGE_VAL)
        log_note(&p->desc->log, &p->params.place,
                 "maxsampleluminance is not used: it would darken the picture");
    if (!(scale >= 0.0))
        return err_set(err, ERR_VALUE, &p->params.place, "the film's scale is negative");
    p->film_scale = scale;
    if (x <= 0 || y <= 0)
        return err_set(err, ERR_VALUE, &p->params.place,
                       "a film of %d x %d pixels holds nothing", x, y);
    if (!film_bounds(p, x, y, crop, err))
        return false;
    p->desc->width = x;
    p->desc->height = y;
    for (int i = 0; i < 4; i++)
        p->desc->camera.crop[i] = fmin(fmax(crop[i], 0.0), 1.0);
    return true;
}

static void add_setting(struct pbrt *p, const char *key, double value)
{
    char text[40];
    snprintf(text, sizeof text, "%.17g", value);
    scene_desc_add_setting(p->desc, key, text, &p->params.head_places[0]);
}

/* pbrt's mlt is multiplexed as mmlt is: what it is told is the default of the same
 * setting here. Its bootstrap samples are as many for each depth; its small steps are
 * Gaussian. */
static void mlt_settings(struct pbrt *p, int depth)
{
    static const struct {
        const char *name, *key;
        double most;
        bool whole;
    } rows[] = {{"largestepprobability", "large_step_probability", 1.0, false},
                {"sigma", "sigma", 1.0, false},
                {"mutationsperpixel", "mutations_per_pixel", 1e9, true},
                {"chains", "chains", 1e6, true},
                {"bootstrapsamples", "bootstrap", 1e9, true}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        const struct pbrt_param *param = pbrt_params_find(
            &p->params, rows[i].name, rows[i].whole ? PBRT_INTEGER : PBRT_FLOAT);
        if (!param)
            continue;
        double value = param->count == 1 ? *pbrt_params_numbers(&p->params, param) : 0.0;
        if (!(value > 0.0 && value <= rows[i].most)) {
            log_note(
                &p->desc->log, &param->place,
                "\"%s\" of Integrator \"mlt\" is not used: one number above 0, at most "
                "%g, is wanted",
                rows[i].name, rows[i].most);
            continue;
        }
        if (text_equal(rows[i].key, "bootstrap"))
            value = fmin(value * (depth + 1), rows[i].most);
        if (text_equal(rows[i].key, "sigma"))
            scene_desc_add_setting(p->desc, "kernel", "gaussian", &param->place);
        add_setting(p, rows[i].key, value);
    }
}

bool pbrt_integrator(struct pbrt *p, struct err *err)
{
    static const char *const known[] = {
        "path",      "bdpt",          "mlt",      "volpath",          "directlighting",
        "ao",        "sppm",          "whitted",  "simplepath",       "randomwalk",
        "lightpath", "simplevolpath", "function", "ambientocclusion", NULL};
    /* How pbrt samples; what it computes is the same. */
    static const char *const ignored[] = {"rrthreshold",
                                          "lightsamplestrategy",
                                          "lightsampler",
                                          "samplelights",
                                          "samplebsdf",
                                          "cossample",
                                          "maxdistance",
                                          "nsamples",
                                          "strategy",
                                          "pixelbounds",
                                          "visualizestrategies",
                                          "visualizeweights",
                                          "numiterations",
                                          "iterations",
                                          "photonsperiteration",
                                          "imagewritefrequency",
                                          "radius",
                                          NULL};
    const char *kind = pbrt_params_head(&p->params, 0);
    const struct place *at = &p->params.head_places[0];
    if (!is_one_of(kind, known))
        return suggest_fail(err, at, "integrator", kind, known);
    if (text_equal(kind, "directlighting") || text_equal(kind, "ao") ||
        text_equal(kind, "ambientocclusion") || text_equal(kind, "whitted"))
        log_note(&p->desc->log, at,
                 "integrator \"%s\" leaves light out; here all of it is computed", kind);
    int depth = 5;
    if (!pbrt_params_int(&p->params, "maxdepth", &depth, err))
        return false;
    if (depth < 0 || depth > 100000)
        return err_set(err, ERR_VALUE, at, "maxdepth %d is out of range", depth);
    pbrt_params_ignore(&p->params, ignored);
    if (text_equal(kind, "mlt"))
        mlt_settings(p, depth);
    p->desc->max_depth = depth + 1; /* pbrt counts the surfaces between the ends */
    return true;
}

bool pbrt_filter(struct pbrt *p, struct err *err)
{
    static const char *const known[] = {"box",      "triangle", "gaussian",
                                        "mitchell", "sinc",     NULL};
    static const char *const shape[] = {"alpha", "B", "C", "tau", "sigma", NULL};
    const char *kind = pbrt_params_head(&p->params, 0);
    const struct place *at = &p->params.head_places[0];
    if (!is_one_of(kind, known))
        return suggest_fail(err, at, "filter", kind, known);
    double x = 0.5, y = 0.5; /* v3's widths are v4's radii */
    if (!pbrt_params_float(&p->params, "xwidth", &x, err) ||
        !pbrt_params_float(&p->params, "ywidth", &y, err) ||
        !pbrt_params_float(&p->params, "xradius", &x, err) ||
        !pbrt_params_float(&p->params, "yradius", &y, err))
        return false;
    pbrt_params_ignore(&p->params, shape);
    p->has_filter = true;
    if (!text_equal(kind, "box") || x != 0.5 || y != 0.5)
        log_remark(&p->desc->log, at,
                   "the filter \"%s\" is not used: reconstruction is a box of one pixel, "
                   "always",
                   kind);
    return true;
}

bool pbrt_ignored(struct pbrt *p, struct err *err)
{
    (void)err;
    for (size_t i = 0; i < p->params.count; i++)
        p->params.list[i].used = true;
    return true;
}

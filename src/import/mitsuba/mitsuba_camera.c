#include "import/mitsuba/mitsuba_scene.h"

#include "base/text.h"
#include "import/mitsuba/mitsuba_property.h"
#include "import/mitsuba/mitsuba_transform.h"
#include "import/suggest.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* A frame of 35 mm film, in millimetres. */
#define FRAME_WIDTH  36.0
#define FRAME_HEIGHT 24.0

static bool read_axis(struct mitsuba_node *object, enum fov_axis *axis, struct err *err)
{
    static const struct {
        const char *name;
        enum fov_axis axis;
    } rows[] = {{"x", FOV_X},
                {"y", FOV_Y},
                {"diagonal", FOV_DIAGONAL},
                {"smaller", FOV_SMALLER},
                {"larger", FOV_LARGER}};
    const char *known[sizeof rows / sizeof rows[0] + 1] = {0};
    const char *name = "x";
    if (!mitsuba_string(object, "fov_axis", &name, err))
        return false;
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        if (text_equal(name, rows[i].name)) {
            *axis = rows[i].axis;
            return true;
        }
        known[i] = rows[i].name;
    }
    return suggest_fail(err, &mitsuba_property(object, "fov_axis")->place, "fov_axis",
                        name, known);
}

/* Without a fov the focal length is used, which Mitsuba relates to the frame's diagonal.
 */
static bool read_fov(struct mitsuba_node *object, struct camera_desc *camera,
                     struct err *err)
{
    const char *focal = "50mm";
    char *end;
    if (!read_axis(object, &camera->fov_axis, err) ||
        !mitsuba_string(object, "focal_length", &focal, err))
        return false;
    if (!mitsuba_property(object, "fov")) {
        double length = strtod(focal, &end);
        if (end == focal || (*end && !text_equal(end, "mm")) || !(length > 0.0))
            return err_set(err, ERR_VALUE, &object->place,
                           "the focal length \"%.40s\" is no length like \"50mm\"",
                           focal);
        camera->fov_axis = FOV_DIAGONAL;
        camera->fov = 2.0 * atan(0.5 * hypot(FRAME_WIDTH, FRAME_HEIGHT) / length) *
                      180.0 / acos(-1.0);
        return true;
    }
    if (!mitsuba_float(object, "fov", &camera->fov, err))
        return false;
    return (camera->fov > 0.0 && camera->fov < 180.0) ||
           err_set(err, ERR_VALUE, &mitsuba_property(object, "fov")->place,
                   "fov %g is not between 0 and 180 degrees", camera->fov);
}

static bool read_lens(struct mitsuba_node *object, struct camera_desc *camera,
                      struct err *err)
{
    camera->lens_radius = -1.0;
    camera->focus_distance = 0.0;
    if (!mitsuba_float(object, "aperture_radius", &camera->lens_radius, err) ||
        !mitsuba_float(object, "focus_distance", &camera->focus_distance, err))
        return false;
    if (!(camera->lens_radius >= 0.0))
        return err_set(err, ERR_VALUE, &object->place,
                       "sensor \"thinlens\" wants an aperture_radius, not negative");
    return camera->focus_distance > 0.0 ||
           err_set(err, ERR_VALUE, &object->place,
                   "sensor \"thinlens\" wants a positive focus_distance");
}

/* The crop fraction for which the renderer's first pixel is `pixel`. */
static double crop_fraction(int pixel, int count)
{
    double fraction = (double)pixel / count;
    while (ceil(fraction * count) > pixel)
        fraction = nextafter(fraction, 0.0);
    return fraction;
}

/* Offset and size along one axis, in pixels. */
static bool read_span(struct mitsuba_node *object, const char *offset_name,
                      const char *size_name, int count, double fractions[2],
                      struct err *err)
{
    int offset = 0;
    if (!mitsuba_integer(object, offset_name, &offset, err))
        return false;
    bool inside = offset >= 0 && offset < count;
    int size = inside ? count - offset : 0;
    if (!mitsuba_integer(object, size_name, &size, err))
        return false;
    if (!inside || size <= 0 || size > count - offset)
        return err_set(err, ERR_VALUE, &object->place,
                       "%s %d and %s %d do not lie within the film's %d pixels",
                       offset_name, offset, size_name, size, count);
    fractions[0] = crop_fraction(offset, count);
    fractions[1] = crop_fraction(offset + size, count);
    return true;
}

static bool check_filter(struct mitsuba *m, struct mitsuba_node *film, struct err *err)
{
    struct mitsuba_node *filter;
    if (!mitsuba_child(m, film, "rfilter", &filter, err))
        return false;
    const char *type = filter ? mitsuba_type(filter) : "gaussian";
    if (!text_equal(type, "box"))
        log_remark(
            &m->desc->log, filter ? &filter->place : &film->place,
            "the filter \"%s\"%s is not used: reconstruction is a box of one pixel, "
            "always",
            type, filter ? "" : " (Mitsuba's default)");
    return true;
}

static bool read_film(struct mitsuba *m, struct mitsuba_node *object, struct err *err)
{
    /* How the file is written; here it is always the same. */
    static const char *const ignored[] = {
        "file_format", "pixel_format",     "component_format",
        "banner",      "attach_log",       "gamma",
        "exposure",    "tonemap_method",   "key",
        "burn",        "compensate",       "digits",
        "variable",    "highQualityEdges", NULL};
    int width = 768, height = 576;
    if (!mitsuba_integer(object, "width", &width, err) ||
        !mitsuba_integer(object, "height", &height, err))
        return false;
    if (width <= 0 || height <= 0)
        return err_set(err, ERR_VALUE, &object->place,
                       "a film of %d x %d pixels holds nothing", width, height);
    m->desc->width = width;
    m->desc->height = height;
    double *crop = m->desc->camera.crop;
    if (!read_span(object, "crop_offset_x", "crop_width", width, crop, err) ||
        !read_span(object, "crop_offset_y", "crop_height", height, crop + 2, err) ||
        !check_filter(m, object, err))
        return false;
    mitsuba_ignore(object, ignored);
    if (text_equal(object->name, "film"))
        mitsuba_report(m, object);
    return true;
}

static bool find_film(struct mitsuba *m, struct mitsuba_node *object, struct err *err)
{
    struct mitsuba_node *film, *sampler; /* how points are sampled is nothing to us */
    struct mitsuba_node none = {.name = object->name, .place = object->place};
    return mitsuba_child(m, object, "sampler", &sampler, err) &&
           mitsuba_child(m, object, "film", &film, err) &&
           read_film(m, film ? film : &none, err);
}

bool mitsuba_sensor(struct mitsuba *m, struct mitsuba_node *object, struct err *err)
{
    static const char *const known[] = {"perspective",       "thinlens",  "orthographic",
                                        "perspective_rdist", "spherical", NULL};
    static const char *const ignored[] = {
        "near_clip", "far_clip", "shutter_open", "shutter_close", "focus_distance", NULL};
    struct camera_desc *camera = &m->desc->camera;
    const char *type = mitsuba_type(object);
    bool thin = text_equal(type, "thinlens");
    bool parallel = text_equal(type, "orthographic");
    if (camera->fov > 0.0 || camera->extent > 0.0) {
        log_note(&m->desc->log, &object->place, "only the first sensor is used");
        return true;
    }
    if (!thin && !parallel && !text_equal(type, "perspective")) {
        if (!mitsuba_one_of(type, known))
            return suggest_fail(err, &object->place, "sensor", type, known);
        return err_set(
            err, ERR_UNSUPPORTED, &object->place,
            "sensor \"%s\" is not read, only \"perspective\", \"thinlens\" and "
            "\"orthographic\" are",
            type);
    }
    struct xform to_world = xform_identity(), flip = xform_scale(-1.0, 1.0, 1.0);
    camera->place = object->place;
    camera->focus_distance = 1.0;
    if (parallel) { /* the square from -1 to 1, cut or longer upwards */
        camera->extent = 2.0;
        camera->fov_axis = FOV_X;
    }
    if ((!parallel && !read_fov(object, camera, err)) ||
        (thin && !read_lens(object, camera, err)) ||
        !mitsuba_transform(object, "to_world", &to_world, err) ||
        !find_film(m, object, err))
        return false;
    camera->to_world = xform_mul(&to_world, &flip); /* Mitsuba's x goes to the left */
    mitsuba_ignore(object, ignored);
    mitsuba_report(m, object);
    return true;
}

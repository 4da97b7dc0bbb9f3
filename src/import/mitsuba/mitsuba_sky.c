#include "import/mitsuba/mitsuba_sky.h"

#include "base/text.h"
#include "import/mitsuba/mitsuba_property.h"
#include "import/sky.h"

#define APERTURE 0.5358 /* degrees: Mitsuba's sun */

/* Mitsuba's own defaults: Tokyo in July. */
static bool read_time(struct mitsuba_node *object, struct sky_time *time, struct err *err)
{
    double hour = 15.0, minute = 0.0, second = 0.0;
    *time = (struct sky_time){2010, 7, 10, 0.0, 9.0, 35.6894, 139.6917};
    if (!mitsuba_integer(object, "year", &time->year, err) ||
        !mitsuba_integer(object, "month", &time->month, err) ||
        !mitsuba_integer(object, "day", &time->day, err) ||
        !mitsuba_float(object, "hour", &hour, err) ||
        !mitsuba_float(object, "minute", &minute, err) ||
        !mitsuba_float(object, "second", &second, err) ||
        !mitsuba_float(object, "timezone", &time->timezone, err) ||
        !mitsuba_float(object, "latitude", &time->latitude, err) ||
        !mitsuba_float(object, "longitude", &time->longitude, err))
        return false;
    time->hour = hour + minute / 60.0 + second / 3600.0;
    return (time->year >= 1900 && time->year <= 2200 && time->month >= 1 &&
            time->month <= 12 && time->day >= 1 && time->day <= 31) ||
           err_set(err, ERR_VALUE, &object->place,
                   "year %d, month %d, day %d is no date from 1900 to 2200", time->year,
                   time->month, time->day);
}

/* Mitsuba 3's up is z; before it was y, with north at -z. */
static bool is_z_up(const struct mitsuba *m)
{
    return m->major >= 3;
}

static bool read_direction(const struct mitsuba *m, struct mitsuba_node *object,
                           double sun[3], struct err *err)
{
    struct sky_time time;
    double given[3];
    if (!mitsuba_property(object, "sun_direction"))
        return read_time(object, &time, err) && (sky_sun_direction(&time, sun), true);
    if (!mitsuba_point(object, "sun_direction", given, err))
        return false;
    sun[0] = given[0];
    sun[1] = is_z_up(m) ? given[1] : -given[2];
    sun[2] = is_z_up(m) ? given[2] : given[1];
    return true;
}

static bool read_scales(struct mitsuba_node *object, struct sky_options *options,
                        struct err *err)
{
    const char *type = mitsuba_type(object);
    double both = 1.0, sky = 1.0, sun = 1.0, aperture = APERTURE;
    options->sun_radius_scale = 1.0;
    if (!mitsuba_float(object, "scale", &both, err) ||
        !mitsuba_float(object, "sky_scale", &sky, err) ||
        !mitsuba_float(object, "sun_scale", &sun, err) ||
        !mitsuba_float(object, "sun_radius_scale", &options->sun_radius_scale, err) ||
        !mitsuba_float(object, "sun_aperture", &aperture, err))
        return false;
    options->sun_radius_scale *= aperture / APERTURE;
    options->sky_scale = text_equal(type, "sun") ? 0.0 : both * sky;
    options->sun_scale = text_equal(type, "sky") ? 0.0 : both * sun;
    return true;
}

bool mitsuba_sky(struct mitsuba *m, struct mitsuba_node *object, struct light_desc *light,
                 struct err *err)
{
    /* How finely Mitsuba tabulates it; and that it is lit from a ground. */
    static const char *const ignored[] = {"resolution", "albedo", "complex_sun", NULL};
    static const double y_up[16] = {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1};
    struct sky_options options = {.turbidity = 3.0};
    double stretch = 1.0;
    struct xform turn = xform_identity();
    if (!mitsuba_float(object, "turbidity", &options.turbidity, err) ||
        !mitsuba_float(object, "stretch", &stretch, err) ||
        !mitsuba_boolean(object, "extend", &options.ground, err) ||
        !read_direction(m, object, options.sun, err) ||
        !read_scales(object, &options, err) ||
        !sky_check(m->desc, &options, &object->place, err) ||
        (!is_z_up(m) && !xform_from_matrix(y_up, &turn)))
        return false;
    mitsuba_ignore(object, ignored);
    if (stretch != 1.0)
        log_note(&m->desc->log, &object->place, "the sky is not stretched here");
    log_note(&m->desc->log, &object->place,
             "emitter \"%s\" follows Preetham's model: its sky is up to three times as "
             "bright as that of Hosek, which Mitsuba has; skyScale dims it",
             mitsuba_type(object));
    light->map = sky_picture(&m->desc->textures, &options);
    light->intensity = rgb_grey(1.0);
    light->to_world = xform_mul(&light->to_world, &turn);
    return true;
}

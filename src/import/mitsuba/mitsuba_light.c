#include "import/mitsuba/mitsuba_scene.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/mitsuba/mitsuba_property.h"
#include "import/mitsuba/mitsuba_sky.h"
#include "import/mitsuba/mitsuba_texture.h"
#include "import/mitsuba/mitsuba_transform.h"
#include "scene/light.h"

static bool add(struct mitsuba *m, const struct mitsuba_node *object,
                const struct light_type *type, struct light_desc *light)
{
    light->type = type;
    light->place = object->place;
    scene_desc_add_light(m->desc, light);
    return true;
}

static bool point(struct mitsuba *m, struct mitsuba_node *object,
                  struct light_desc *light, struct err *err)
{
    double position[3] = {0.0, 0.0, 0.0};
    if (!mitsuba_colour(m, object, "intensity", &light->intensity, err) ||
        !mitsuba_point(object, "position", position, err))
        return false;
    if (mitsuba_property(object, "position"))
        light->to_world = xform_translate(position[0], position[1], position[2]);
    return add(m, object, &light_point, light);
}

/* Full within beam_width of the axis, then falling linearly to nothing at cutoff_angle.
 */
static bool spot(struct mitsuba *m, struct mitsuba_node *object, struct light_desc *light,
                 struct err *err)
{
    light->outer = 20.0;
    light->linear = true;
    if (!mitsuba_colour(m, object, "intensity", &light->intensity, err) ||
        !mitsuba_float(object, "cutoff_angle", &light->outer, err))
        return false;
    light->inner = 0.75 * light->outer;
    if (!mitsuba_float(object, "beam_width", &light->inner, err))
        return false;
    if (!(light->inner >= 0.0 && light->outer > 0.0 && light->inner <= light->outer &&
          light->outer <= 180.0))
        return err_set(err, ERR_VALUE, &object->place,
                       "beam_width %g and cutoff_angle %g are not in this order within 0 "
                       "and 180 degrees",
                       light->inner, light->outer);
    return add(m, object, &light_spot, light);
}

static bool directional(struct mitsuba *m, struct mitsuba_node *object,
                        struct light_desc *light, struct err *err)
{
    static const double zero[3] = {0.0, 0.0, 0.0};
    double direction[3] = {0.0, 0.0, 1.0};
    struct xform look;
    if (!mitsuba_colour(m, object, "irradiance", &light->intensity, err) ||
        !mitsuba_point(object, "direction", direction, err))
        return false;
    if (!mitsuba_look_along(zero, direction, &look))
        return err_set(err, ERR_VALUE, &object->place, "the direction is no direction");
    light->to_world = xform_mul(&light->to_world, &look);
    return add(m, object, &light_distant, light);
}

static bool constant(struct mitsuba *m, struct mitsuba_node *object,
                     struct light_desc *light, struct err *err)
{
    return mitsuba_colour(m, object, "radiance", &light->intensity, err) &&
           add(m, object, &light_environment, light);
}

/* Mitsuba's picture has +y in row 0 and -z, then +x, along its rows; ours +z, and +x,
 * then +y. */
static bool envmap(struct mitsuba *m, struct mitsuba_node *object,
                   struct light_desc *light, struct err *err)
{
    static const double turn[16] = {0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 0, 0, 0, 0, 1};
    struct err failure = {0};
    struct xform to_mitsuba;
    double scale = 1.0;
    light->map = mitsuba_picture(m, object, &failure);
    if (failure.code != ERR_NONE) {
        *err = failure;
        return false;
    }
    if (!mitsuba_float(object, "scale", &scale, err) ||
        !xform_from_matrix(turn, &to_mitsuba))
        return false;
    if (!(scale >= 0.0))
        return err_set(err, ERR_VALUE, &object->place, "the scale is negative");
    light->intensity = rgb_grey(scale);
    light->to_world = xform_mul(&light->to_world, &to_mitsuba);
    return add(m, object, &light_environment, light);
}

static bool sky(struct mitsuba *m, struct mitsuba_node *object, struct light_desc *light,
                struct err *err)
{
    return mitsuba_sky(m, object, light, err) &&
           add(m, object, &light_environment, light);
}

/* "area" belongs into a shape, but may wait here for a reference. */
static bool misplaced(struct mitsuba *m, struct mitsuba_node *object,
                      struct light_desc *light, struct err *err)
{
    (void)m, (void)light;
    return mitsuba_attribute(object, "id") ||
           err_set(err, ERR_VALUE, &object->place,
                   "an emitter of the type \"area\" belongs into a <shape>");
}

static const struct {
    const char *type;
    bool (*read)(struct mitsuba *m, struct mitsuba_node *object, struct light_desc *light,
                 struct err *err); /* NULL: known, left out */
} rows[] = {
    {"point", point},       {"spot", spot},        {"constant", constant},
    {"envmap", envmap},     {"area", misplaced},   {"directional", directional},
    {"collimated", NULL},   {"sky", sky},          {"sun", sky},
    {"sunsky", sky},        {"projector", NULL},   {"directionalarea", NULL},
    {"timed_sunsky", NULL}, {"volumelight", NULL},
};

#define ROWS (sizeof rows / sizeof rows[0])

/* How Mitsuba chooses lights and places on them. */
static const char *const ignored[] = {"sampling_weight", "mis_compensation", "cache",
                                      NULL};

static void lose(struct mitsuba *m, const struct mitsuba_node *object)
{
    char *what = text_format("emitter \"%s\"", mitsuba_type(object));
    scene_desc_lose_light(m->desc, what, &object->place);
    mem_free(what);
}

static bool read_row(struct mitsuba *m, struct mitsuba_node *object, size_t row,
                     struct err *err)
{
    struct light_desc light = {.intensity = rgb_grey(1.0)};
    light.to_world = xform_identity();
    if (!rows[row].read) {
        log_note(&m->desc->log, &object->place,
                 "emitter \"%s\" is not read yet and left out", rows[row].type);
        lose(m, object);
        return true;
    }
    mitsuba_ignore(object, ignored);
    if (!mitsuba_transform(object, "to_world", &light.to_world, err) ||
        !rows[row].read(m, object, &light, err))
        return false;
    if (rows[row].read != misplaced)
        mitsuba_report(m, object);
    return true;
}

bool mitsuba_emitter(struct mitsuba *m, struct mitsuba_node *object, struct err *err)
{
    const char *known[ROWS + 1] = {0};
    for (size_t i = 0; i < ROWS; i++) {
        known[i] = rows[i].type;
        if (text_equal(mitsuba_type(object), rows[i].type))
            return read_row(m, object, i, err);
    }
    mitsuba_unknown(m, object, known, "left out");
    lose(m, object);
    return true;
}

bool mitsuba_emitter_area(struct mitsuba *m, struct mitsuba_node *object,
                          struct shape_desc *shape, struct err *err)
{
    static const char *const known[] = {"area", NULL};
    if (!text_equal(mitsuba_type(object), "area"))
        mitsuba_unknown(m, object, known, "an area emitter, as its shape is one");
    shape->radiance = rgb_grey(1.0);
    if (!mitsuba_colour(m, object, "radiance", &shape->radiance, err))
        return false;
    shape->emits = !rgb_is_black(shape->radiance);
    mitsuba_ignore(object, ignored);
    mitsuba_report(m, object);
    return true;
}

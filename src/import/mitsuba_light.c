#include "import/mitsuba_scene.h"

#include "base/text.h"

static bool point(struct mitsuba *m, struct mitsuba_node *object, struct err *err)
{
    struct light_desc light = {.intensity = rgb_grey(1.0), .place = object->place};
    double position[3];
    light.to_world = xform_identity();
    if (!mitsuba_transform(object, "to_world", &light.to_world, err) ||
        !mitsuba_colour(m, object, "intensity", &light.intensity, err))
        return false;
    if (mitsuba_property(object, "position")) {
        if (!mitsuba_point(object, "position", position, err))
            return false;
        light.to_world = xform_translate(position[0], position[1], position[2]);
    }
    scene_desc_add_light(m->desc, &light);
    return true;
}

/* "area" belongs into a shape, but may wait here for a reference. */
static bool misplaced(struct mitsuba *m, struct mitsuba_node *object, struct err *err)
{
    (void)m;
    return mitsuba_attribute(object, "id") ||
           err_set(err, ERR_VALUE, &object->place,
                   "an emitter of the type \"area\" belongs into a <shape>");
}

static const struct {
    const char *type;
    bool (*read)(struct mitsuba *m, struct mitsuba_node *object,
                 struct err *err); /* NULL: known, left out */
} rows[] = {
    {"point", point},
    {"area", misplaced},
    {"envmap", NULL},
    {"constant", NULL},
    {"spot", NULL},
    {"directional", NULL},
    {"collimated", NULL},
    {"sky", NULL},
    {"sun", NULL},
    {"sunsky", NULL},
    {"directionalarea", NULL},
    {"projector", NULL},
};

#define ROWS (sizeof rows / sizeof rows[0])

/* Mitsuba 0.x weighs the choice of lights by samplingWeight; ours goes by power. */
static const char *const ignored[] = {"sampling_weight", NULL};

bool mitsuba_emitter(struct mitsuba *m, struct mitsuba_node *object, struct err *err)
{
    const char *known[ROWS + 1] = {0};
    for (size_t i = 0; i < ROWS; i++) {
        known[i] = rows[i].type;
        if (!text_equal(mitsuba_type(object), rows[i].type))
            continue;
        if (!rows[i].read) {
            log_note(&m->desc->log, &object->place,
                     "emitter \"%s\" is not read yet and left out", rows[i].type);
            return true;
        }
        mitsuba_ignore(object, ignored);
        if (!rows[i].read(m, object, err))
            return false;
        if (rows[i].read != misplaced)
            mitsuba_report(m, object);
        return true;
    }
    mitsuba_unknown(m, object, known, "left out");
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

#include "import/mitsuba_scene.h"

#include "base/text.h"

/* Where a picture is not read, a grey that is as likely as any. */
static bool grey(struct mitsuba *m, struct mitsuba_node *object, struct rgb *value,
                 struct err *err)
{
    (void)m, (void)object, (void)err;
    *value = rgb_grey(0.5);
    return true;
}

/* Two colours in equal shares. */
static bool two(struct mitsuba *m, struct mitsuba_node *object, struct rgb *value,
                struct err *err)
{
    struct rgb a = rgb_grey(0.4), b = rgb_grey(0.2);
    if (!mitsuba_colour(m, object, "color0", &a, err) ||
        !mitsuba_colour(m, object, "color1", &b, err))
        return false;
    *value = rgb_scale(rgb_add(a, b), 0.5);
    return true;
}

static const struct {
    const char *type;
    bool (*read)(struct mitsuba *m, struct mitsuba_node *object, struct rgb *value,
                 struct err *err);
} rows[] = {{"bitmap", grey}, {"checkerboard", two}, {"gridtexture", two}};

#define ROWS (sizeof rows / sizeof rows[0])

bool mitsuba_texture_mean(struct mitsuba *m, struct mitsuba_node *object,
                          struct rgb *value, struct err *err)
{
    const char *known[ROWS + 1] = {0};
    for (size_t i = 0; i < ROWS; i++) {
        known[i] = rows[i].type;
        if (!text_equal(mitsuba_type(object), rows[i].type))
            continue;
        if (!mitsuba_enter(object, err))
            return false;
        bool read = rows[i].read(m, object, value, err);
        mitsuba_leave(object);
        log_note(&m->desc->log, &object->place,
                 "texture \"%s\" is taken as its mean (a picture as grey)", rows[i].type);
        return read;
    }
    mitsuba_unknown(m, object, known, "grey");
    return grey(m, object, value, err);
}

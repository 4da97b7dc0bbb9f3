#include "import/mitsuba/mitsuba_spectrum.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/mitsuba/mitsuba_property.h"

#include <string.h>

/* A property that is a colour; untouched if it is not there. */
static bool colour(struct mitsuba *m, struct mitsuba_node *object, const char *name,
                   enum mitsuba_quantity quantity, struct rgb *value, struct err *err)
{
    struct mitsuba_node *node = mitsuba_property(object, name);
    if (!node)
        return true;
    node = mitsuba_resolve(m, node, err);
    if (!node)
        return false;
    if (mitsuba_spectrum_is(node))
        return mitsuba_spectrum_read(m, node, quantity, value, err);
    if (mitsuba_rgb_is(node))
        return mitsuba_rgb_read(m, node, quantity, value, err);
    return err_set(err, ERR_VALUE, &node->place, "\"%s\" wants a colour, this is <%s>",
                   name, node->name);
}

/* In RGB D65 is white; a colour tints it. */
static bool d65(struct mitsuba *m, struct mitsuba_node *object,
                enum mitsuba_quantity quantity, struct rgb *value, struct err *err)
{
    double scale = 1.0;
    *value = rgb_grey(1.0);
    if (!colour(m, object, "color", quantity, value, err) ||
        !mitsuba_float(object, "scale", &scale, err))
        return false;
    *value = rgb_scale(*value, scale);
    return true;
}

static bool plain_colour(struct mitsuba *m, struct mitsuba_node *object,
                         enum mitsuba_quantity quantity, struct rgb *value,
                         struct err *err)
{
    static const char *const ignored[] = {"unbounded", NULL};
    mitsuba_ignore(object, ignored);
    *value = rgb_grey(1.0);
    return colour(m, object, "color", quantity, value, err);
}

static bool uniform(struct mitsuba *m, struct mitsuba_node *object,
                    enum mitsuba_quantity quantity, struct rgb *value, struct err *err)
{
    static const char *const ignored[] = {"wavelength_min", "wavelength_max", NULL};
    (void)m, (void)quantity;
    double grey = 1.0;
    mitsuba_ignore(object, ignored);
    if (!mitsuba_float(object, "value", &grey, err))
        return false;
    *value = rgb_grey(grey);
    return true;
}

/* A number, or three of them as they are. */
static bool raw_constant(struct mitsuba *m, struct mitsuba_node *object,
                         enum mitsuba_quantity quantity, struct rgb *value,
                         struct err *err)
{
    const struct mitsuba_node *node = mitsuba_property(object, "value");
    double xyz[3] = {1.0, 1.0, 1.0};
    if (!node || !text_equal(node->name, "vector"))
        return uniform(m, object, quantity, value, err);
    if (!mitsuba_point(object, "value", xyz, err))
        return false;
    *value = rgb(xyz[0], xyz[1], xyz[2]);
    return true;
}

/* Radiance, W/(m^2 sr nm). */
static bool blackbody(struct mitsuba *m, struct mitsuba_node *object,
                      enum mitsuba_quantity quantity, struct rgb *value, struct err *err)
{
    static const char *const ignored[] = {"wavelength_min", "wavelength_max", NULL};
    (void)m, (void)quantity;
    double kelvin = 0.0, scale = 1.0;
    mitsuba_ignore(object, ignored);
    if (!mitsuba_float(object, "temperature", &kelvin, err) ||
        !mitsuba_float(object, "scale", &scale, err))
        return false;
    if (!(kelvin > 0.0))
        return err_set(err, ERR_VALUE, &object->place,
                       "\"blackbody\" wants a positive temperature");
    *value = rgb_scale(mitsuba_rgb_blackbody(kelvin), scale);
    return true;
}

/* A list of numbers in a string; *list is the caller's to free, come what may. */
static bool number_list(struct mitsuba_node *object, const char *name, double **list,
                        size_t *count, struct err *err)
{
    const struct mitsuba_node *node = mitsuba_property(object, name);
    const char *text = node ? mitsuba_attribute(node, "value") : NULL;
    *count = 0;
    if (!text)
        return err_set(err, ERR_VALUE, &object->place,
                       "spectrum \"%s\" wants a list \"%s\"", mitsuba_type(object), name);
    size_t room = strlen(text) / 2 + 1;
    *list = mem_alloc(room, sizeof **list);
    return mitsuba_numbers(node, "value", room, *list, count, err);
}

static bool from_lists(const struct mitsuba *m, const struct mitsuba_node *object,
                       enum mitsuba_quantity quantity, const double *wavelengths,
                       const double *values, size_t count, struct rgb *value,
                       struct err *err)
{
    double *pairs = mem_alloc(2 * count + 1, sizeof *pairs);
    for (size_t i = 0; i < count; i++) {
        pairs[2 * i] = wavelengths[i];
        pairs[2 * i + 1] = values[i];
    }
    bool read = mitsuba_rgb_from_pairs(m, object, quantity, pairs, 2 * count, value, err);
    mem_free(pairs);
    return read;
}

static bool irregular(struct mitsuba *m, struct mitsuba_node *object,
                      enum mitsuba_quantity quantity, struct rgb *value, struct err *err)
{
    double *wavelengths = NULL, *values = NULL;
    size_t count, value_count;
    bool read = number_list(object, "wavelengths", &wavelengths, &count, err) &&
                number_list(object, "values", &values, &value_count, err);
    if (read && count != value_count)
        read = err_set(err, ERR_VALUE, &object->place, "%zu wavelengths for %zu values",
                       count, value_count);
    read = read &&
           from_lists(m, object, quantity, wavelengths, values, count, value, err);
    mem_free(wavelengths);
    mem_free(values);
    return read;
}

/* Its ends by two numbers, or as the list "range". */
static bool read_range(struct mitsuba_node *object, double range[2], struct err *err)
{
    struct mitsuba_node *node = mitsuba_property(object, "range");
    size_t count;
    if (!mitsuba_float(object, "wavelength_min", &range[0], err) ||
        !mitsuba_float(object, "wavelength_max", &range[1], err) ||
        (node && !mitsuba_numbers(node, "value", 2, range, &count, err)))
        return false;
    return range[0] < range[1] ||
           err_set(err, ERR_VALUE, &object->place,
                   "the wavelengths %g to %g are no range", range[0], range[1]);
}

static bool regular(struct mitsuba *m, struct mitsuba_node *object,
                    enum mitsuba_quantity quantity, struct rgb *value, struct err *err)
{
    double range[2] = {0.0, 0.0}, *values = NULL;
    size_t count;
    if (!read_range(object, range, err))
        return false;
    bool read = number_list(object, "values", &values, &count, err);
    if (read && count < 2)
        read = err_set(err, ERR_VALUE, &object->place,
                       "spectrum \"regular\" wants two values or more");
    double *wavelengths = mem_alloc(count + 1, sizeof *wavelengths);
    for (size_t i = 0; read && i < count; i++)
        wavelengths[i] = range[0] +
                         (range[1] - range[0]) * (double)i / (double)(count - 1);
    read = read &&
           from_lists(m, object, quantity, wavelengths, values, count, value, err);
    mem_free(wavelengths);
    mem_free(values);
    return read;
}

static const struct spectrum_row {
    const char *type;
    bool (*read)(struct mitsuba *m, struct mitsuba_node *object,
                 enum mitsuba_quantity quantity, struct rgb *value, struct err *err);
} rows[] = {
    {"d65", d65},
    {"srgb_d65", d65},
    {"srgb", plain_colour},
    {"uniform", uniform},
    {"rawconstant", raw_constant},
    {"blackbody", blackbody},
    {"irregular", irregular},
    {"regular", regular},
};

static const struct spectrum_row *find_row(const struct mitsuba_node *object)
{
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        if (text_equal(object->name, "texture") &&
            text_equal(mitsuba_type(object), rows[i].type))
            return &rows[i];
    return NULL;
}

bool mitsuba_spectrum_is(const struct mitsuba_node *object)
{
    return find_row(object) != NULL;
}

bool mitsuba_spectrum_read(struct mitsuba *m, struct mitsuba_node *object,
                           enum mitsuba_quantity quantity, struct rgb *value,
                           struct err *err)
{
    if (!mitsuba_enter(m, object, err))
        return false;
    bool read = find_row(object)->read(m, object, quantity, value, err);
    mitsuba_leave(m, object);
    if (read)
        mitsuba_report(m, object);
    return read;
}

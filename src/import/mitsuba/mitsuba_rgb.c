#include "import/mitsuba/mitsuba_rgb.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/mitsuba/mitsuba_property.h"
#include "import/spectrum.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static double from_srgb(double v)
{
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

/* "#rrggbb" */
static bool hex_colour(const char *text, struct rgb *value)
{
    char *end;
    if (text[0] != '#' || strlen(text) != 7)
        return false;
    unsigned long code = strtoul(text + 1, &end, 16);
    if (*end || !isxdigit((unsigned char)text[1]))
        return false;
    *value = rgb(from_srgb((double)(code >> 16 & 255) / 255.0),
                 from_srgb((double)(code >> 8 & 255) / 255.0),
                 from_srgb((double)(code & 255) / 255.0));
    return true;
}

static bool triple(struct mitsuba *m, const struct mitsuba_node *node, struct rgb *value,
                   struct err *err)
{
    size_t count;
    double v[3];
    const char *text = mitsuba_attribute(node, "value");
    (void)m;
    if (text && hex_colour(text, value))
        return true;
    if (!mitsuba_numbers(node, "value", 3, v, &count, err))
        return false;
    if (count != 1 && count != 3)
        return err_set(err, ERR_SYNTAX, &node->place,
                       "<%s> wants 1 or 3 numbers, not %zu", node->name, count);
    *value = count == 1 ? rgb_grey(v[0]) : rgb(v[0], v[1], v[2]);
    return true;
}

static bool gamma_triple(struct mitsuba *m, const struct mitsuba_node *node,
                         struct rgb *value, struct err *err)
{
    const char *text = mitsuba_attribute(node, "value");
    if (!triple(m, node, value, err))
        return false;
    if (text[0] != '#')
        *value = rgb(from_srgb(value->r), from_srgb(value->g), from_srgb(value->b));
    return true;
}

/* "400:1, 500:2": colons become blanks, the rest is a list of numbers. */
static bool spectrum_pairs(const struct mitsuba_node *node, struct rgb *value,
                           struct err *err)
{
    struct mitsuba_attribute copy = {"value",
                                     text_copy(mitsuba_attribute(node, "value"))};
    size_t room = strlen(copy.value) / 2 + 1, count;
    double *pairs = mem_alloc(room, sizeof *pairs);
    struct mitsuba_node plain = *node;
    plain.attributes = &copy;
    plain.attribute_count = 1;
    for (char *colon; (colon = strchr(copy.value, ':'));)
        *colon = ' ';
    bool read = mitsuba_numbers(&plain, "value", room, pairs, &count, err);
    if (read && (count % 2 != 0 || !spectrum_from_pairs(pairs, count / 2, value)))
        read = err_set(err, ERR_VALUE, &node->place,
                       "<spectrum> wants pairs of a rising wavelength and a value");
    mem_free(copy.value);
    mem_free(pairs);
    return read;
}

static bool spectrum(struct mitsuba *m, const struct mitsuba_node *node,
                     struct rgb *value, struct err *err)
{
    const char *text = mitsuba_attribute(node, "value");
    const char *file = mitsuba_attribute(node, "filename");
    if (text && strchr(text, ':'))
        return spectrum_pairs(node, value, err);
    if (text || !file)
        return triple(m, node, value, err);
    char *path = text_join(m->directory, file);
    bool read = spectrum_from_file(path, &node->place, value, err);
    mem_free(path);
    return read;
}

static const struct colour_row {
    const char *element;
    bool (*read)(struct mitsuba *m, const struct mitsuba_node *node, struct rgb *value,
                 struct err *err);
} rows[] = {
    {"rgb", triple},   {"srgb", gamma_triple}, {"spectrum", spectrum},
    {"float", triple}, {"integer", triple},
};

static const struct colour_row *find_row(const struct mitsuba_node *node)
{
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++)
        if (text_equal(node->name, rows[i].element))
            return &rows[i];
    return NULL;
}

bool mitsuba_rgb_is(const struct mitsuba_node *node)
{
    return find_row(node) != NULL;
}

bool mitsuba_rgb_read(struct mitsuba *m, const struct mitsuba_node *node,
                      struct rgb *value, struct err *err)
{
    struct rgb read = {0};
    if (!find_row(node)->read(m, node, &read, err))
        return false;
    *value = scene_desc_clamp(m->desc, read, &node->place);
    return true;
}

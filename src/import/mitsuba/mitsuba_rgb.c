#include "import/mitsuba/mitsuba_rgb.h"

#include "base/mem.h"
#include "base/text.h"
#include "import/mitsuba/mitsuba_property.h"
#include "import/number.h"
#include "import/spectrum.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define KELVIN_MAX 1e9
#define END        1e-6 /* nm */

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

static bool triple(struct mitsuba *m, const struct mitsuba_node *node,
                   enum mitsuba_quantity quantity, struct rgb *value, struct err *err)
{
    size_t count;
    double v[3];
    const char *text = mitsuba_attribute(node, "value");
    (void)m, (void)quantity;
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
                         enum mitsuba_quantity quantity, struct rgb *value,
                         struct err *err)
{
    const char *text = mitsuba_attribute(node, "value");
    if (!triple(m, node, quantity, value, err))
        return false;
    if (text[0] != '#')
        *value = rgb(from_srgb(value->r), from_srgb(value->g), from_srgb(value->b));
    return true;
}

/* A reflectance of Mitsuba 2 and 3 is at most 1. */
static struct rgb bounded(const struct mitsuba *m, enum mitsuba_quantity quantity,
                          struct rgb value)
{
    if (m->old || quantity != MITSUBA_REFLECTANCE)
        return value;
    return rgb(fmin(value.r, 1.0), fmin(value.g, 1.0), fmin(value.b, 1.0));
}

/* The same list, and 0 right beyond its ends. */
static double *cut_off(const double *pairs, size_t count)
{
    double *cut = mem_alloc(2 * count + 4, sizeof *cut);
    cut[0] = pairs[0] - END;
    memcpy(cut + 2, pairs, 2 * count * sizeof *pairs);
    cut[2 * count + 2] = pairs[2 * count - 2] + END;
    return cut;
}

bool mitsuba_rgb_from_pairs(const struct mitsuba *m, const struct mitsuba_node *node,
                            enum mitsuba_quantity quantity, const double *pairs,
                            size_t count, struct rgb *value, struct err *err)
{
    bool lit = !m->old && quantity != MITSUBA_EMISSION;
    bool good = count > 0 && count % 2 == 0;
    double *cut = good ? cut_off(pairs, count / 2) : NULL;
    good = good && (lit ? spectrum_reflectance_from_pairs(cut, count / 2 + 2, value)
                        : spectrum_from_pairs(cut, count / 2 + 2, value));
    mem_free(cut);
    if (!good)
        return err_set(err, ERR_VALUE, &node->place,
                       "<spectrum> wants pairs of a rising wavelength and a value");
    *value = bounded(m, quantity, *value);
    return true;
}

/* "400:1, 500:2": colons become blanks, the rest is a list of numbers. */
static bool spectrum_pairs(const struct mitsuba *m, const struct mitsuba_node *node,
                           enum mitsuba_quantity quantity, struct rgb *value,
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
    bool read = mitsuba_numbers(&plain, "value", room, pairs, &count, err) &&
                mitsuba_rgb_from_pairs(m, node, quantity, pairs, count, value, err);
    mem_free(copy.value);
    mem_free(pairs);
    return read;
}

/* What emits the same at all wavelengths is no white in RGB but for Mitsuba 0.x. */
static bool spectrum_constant(struct mitsuba *m, const struct mitsuba_node *node,
                              enum mitsuba_quantity quantity, struct rgb *value,
                              struct err *err)
{
    double v[3];
    size_t count;
    if (!triple(m, node, quantity, value, err))
        return false;
    if (m->old || quantity != MITSUBA_EMISSION ||
        !mitsuba_numbers(node, "value", 3, v, &count, err) || count != 1)
        return true;
    *value = spectrum_from_xyz(v[0], v[0], v[0]);
    return true;
}

static bool spectrum(struct mitsuba *m, const struct mitsuba_node *node,
                     enum mitsuba_quantity quantity, struct rgb *value, struct err *err)
{
    const char *text = mitsuba_attribute(node, "value");
    const char *file = mitsuba_attribute(node, "filename");
    size_t count;
    if (text && strchr(text, ':'))
        return spectrum_pairs(m, node, quantity, value, err);
    if (text || !file)
        return spectrum_constant(m, node, quantity, value, err);
    char *path = text_join(m->directory, file);
    double *pairs = spectrum_read_file(path, &node->place, &count, err);
    bool read = pairs &&
                mitsuba_rgb_from_pairs(m, node, quantity, pairs, 2 * count, value, err);
    mem_free(pairs);
    mem_free(path);
    return read;
}

/* A black body's largest radiance follows from Wien's and Planck's laws. */
struct rgb mitsuba_rgb_blackbody(double kelvin)
{
    double largest = 4.0957e-15 * pow(kelvin, 5.0); /* W/(m^2 sr nm) */
    return rgb_scale(spectrum_from_blackbody(kelvin), largest);
}

/* Mitsuba 0.x: temperature="5000K" and a scale; radiance, W/(m^2 sr nm). */
static bool blackbody(struct mitsuba *m, const struct mitsuba_node *node,
                      enum mitsuba_quantity quantity, struct rgb *value, struct err *err)
{
    const char *text = mitsuba_attribute(node, "temperature");
    double kelvin = 0.0, scale = 1.0;
    size_t count = 1;
    (void)m, (void)quantity;
    const char *end = text ? number_parse(text + strspn(text, " "), &kelvin) : NULL;
    if (!end || !(text_equal(end, "") || text_equal(end, "K") || text_equal(end, "k")) ||
        !(kelvin > 0.0) || !(kelvin <= KELVIN_MAX))
        return err_set(err, ERR_VALUE, &node->place,
                       "<blackbody> wants a temperature like \"5000K\"");
    if (mitsuba_attribute(node, "scale") &&
        !mitsuba_numbers(node, "scale", 1, &scale, &count, err))
        return false;
    *value = rgb_scale(mitsuba_rgb_blackbody(kelvin), count ? scale : 1.0);
    return true;
}

static const struct colour_row {
    const char *element;
    bool (*read)(struct mitsuba *m, const struct mitsuba_node *node,
                 enum mitsuba_quantity quantity, struct rgb *value, struct err *err);
} rows[] = {
    {"rgb", triple},   {"srgb", gamma_triple}, {"spectrum", spectrum},
    {"float", triple}, {"integer", triple},    {"blackbody", blackbody},
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
                      enum mitsuba_quantity quantity, struct rgb *value, struct err *err)
{
    struct rgb read = {0};
    if (!find_row(node)->read(m, node, quantity, &read, err))
        return false;
    *value = scene_desc_clamp(m->desc, read, &node->place);
    return true;
}

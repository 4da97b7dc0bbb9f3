#ifndef ETALON_IMPORT_MITSUBA_RGB_H
#define ETALON_IMPORT_MITSUBA_RGB_H

/* Elements that stand for a colour: rgb, srgb, spectrum, blackbody, a number for grey. */

#include "import/mitsuba/mitsuba_object.h"

/* What a spectrum describes decides how it becomes a colour: Mitsuba 2 and 3 see all but
 * emission under D65, 0.x nothing. */
enum mitsuba_quantity {
    MITSUBA_REFLECTANCE,
    MITSUBA_EMISSION,
    MITSUBA_INDEX, /* eta, k: may exceed 1 */
};

/* Whether the element is one of them. */
bool mitsuba_rgb_is(const struct mitsuba_node *node);
/* Reads the colour in linear Rec. 709; negative components are clamped and counted. */
bool mitsuba_rgb_read(struct mitsuba *m, const struct mitsuba_node *node,
                      enum mitsuba_quantity quantity, struct rgb *value, struct err *err);

/* Pairs of a rising wavelength in nm and a value, `count` numbers, as a colour. */
bool mitsuba_rgb_from_pairs(const struct mitsuba *m, const struct mitsuba_node *node,
                            enum mitsuba_quantity quantity, const double *pairs,
                            size_t count, struct rgb *value, struct err *err);
/* Of a black body, W/(m^2 sr nm). */
struct rgb mitsuba_rgb_blackbody(double kelvin);

#endif

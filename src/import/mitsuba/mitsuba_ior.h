#ifndef ETALON_IMPORT_MITSUBA_IOR_H
#define ETALON_IMPORT_MITSUBA_IOR_H

/* Indices of refraction, by number or by the name of a stuff or metal. */

#include "import/mitsuba/mitsuba_object.h"

#define MITSUBA_IOR_BK7           1.5046
#define MITSUBA_IOR_POLYPROPYLENE 1.49

/* intIOR (`inside` by default) over extIOR, numbers or names of stuffs. */
bool mitsuba_ior_ratio(struct mitsuba_node *object, double inside, double *eta,
                       struct err *err);

/* eta and k, given or by the metal's name, relative to what is outside; *perfect: a metal
 * that reflects all. */
bool mitsuba_ior_metal(struct mitsuba *m, struct mitsuba_node *object, struct rgb *eta,
                       struct rgb *k, bool *perfect, struct err *err);

#endif

#ifndef ETALON_IMPORT_PBRT_LUX_H
#define ETALON_IMPORT_PBRT_LUX_H

/* LuxRender's scenes (.lxs) by pbrt's reader: what they have beside it. */

#include "import/pbrt/pbrt_colour.h"
#include "import/pbrt/pbrt_scene.h"

bool pbrt_lux_integrator(struct pbrt *p, struct err *err);
/* Whether LuxRender alone has that film, which is read for its size. */
bool pbrt_lux_film(struct pbrt *p, const char *kind);
/* A pinhole focuses nowhere, and LuxRender's files say 0 for that. */
double pbrt_lux_focus(double distance, double lens_radius);
/* The light sources "sun", "sky" and "sunsky". */
bool pbrt_lux_is_sky(const struct pbrt *p);
bool pbrt_lux_sky(struct pbrt *p, struct err *err);
bool pbrt_lux_volume(struct pbrt *p, struct err *err);
/* LightGroup, Interior, Exterior, PortalShape, ...: no light goes another way. */
bool pbrt_lux_nothing(struct pbrt *p, struct err *err);

/* The metal that the parameter "name" names, if it does. */
void pbrt_lux_metal(struct pbrt *p, struct rgb *eta, struct rgb *k);

/* power (W), efficacy (lm/W) and gain of the area light just read into p->state. */
bool pbrt_lux_area_light(struct pbrt *p, struct err *err);

#endif

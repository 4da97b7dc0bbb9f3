#ifndef ETALON_IMPORT_SKY_H
#define ETALON_IMPORT_SKY_H

/* Sun and sky of a clear day as a picture environment, by the analytic model of
 * [Preetham99], in a space whose z is up. Radiance is the spectral mean over the
 * observer, W/(m^2 sr nm), as Mitsuba and LuxRender have it. */

#include "scene/scene_desc.h"

struct sky_options {
    double sun[3];           /* towards it; any length, not below the horizon */
    double turbidity;        /* 2 (very clear) to 10 (haze) */
    double sky_scale;        /* factors; 0: without */
    double sun_scale;        /* of irradiance, whatever the radius */
    double sun_radius_scale; /* 1: .5358 degrees across */
    bool ground;             /* below the horizon as bright as there, else black */
};

#define SKY_MAX 16 /* pictures of a scene: each takes 6 MB */

/* Whether the model has an answer, and the scene room for one more. */
bool sky_check(const struct scene_desc *desc, const struct sky_options *options,
               const struct place *at, struct err *err);
/* Longitude and latitude as a light_desc has it. Owned by the set. */
const struct texture_image *sky_picture(struct texture_set *set,
                                        const struct sky_options *options);
/* Of the sun, outside the picture: its mean radiance within the disk. */
struct rgb sky_sun_radiance(const struct sky_options *options);

struct sky_time {
    int year, month, day;
    double hour;                /* local */
    double timezone;            /* hours east of Greenwich */
    double latitude, longitude; /* degrees, north and east */
};

/* Direction to the sun (east, north, up), within a minute of arc until 2050
 * [BlancoMuriel01]. */
void sky_sun_direction(const struct sky_time *time, double sun[3]);

#endif

#include "import/sky.h"

#include "math/warp.h"

#include <math.h>

static const double degree = MATH_PI / 180.0;

/* Days since noon of 1 January 2000, universal time. */
static double elapsed_days(const struct sky_time *time, double hour)
{
    long y = time->year, m = time->month, a = (m - 14) / 12;
    long julian = 1461 * (y + 4800 + a) / 4 + 367 * (m - 2 - 12 * a) / 12 -
                  3 * ((y + 4900 + a) / 100) / 4 + time->day - 32075;
    return (double)julian - 0.5 + hour / 24.0 - 2451545.0;
}

void sky_sun_direction(const struct sky_time *time, double sun[3])
{
    double hour = time->hour - time->timezone;
    double d = elapsed_days(time, hour);
    /* ecliptic */
    double omega = 2.1429 - 0.0010394594 * d;
    double anomaly = 6.2400600 + 0.0172019699 * d;
    double longitude = 4.8950630 + 0.017202791698 * d + 0.03341607 * sin(anomaly) +
                       0.00034894 * sin(2.0 * anomaly) - 0.0001134 -
                       0.0000203 * sin(omega);
    double obliquity = 0.4090928 - 6.2140e-9 * d + 0.0000396 * cos(omega);
    /* equatorial */
    double ascension = atan2(cos(obliquity) * sin(longitude), cos(longitude));
    double declination = asin(sin(obliquity) * sin(longitude));
    /* of the place */
    double sidereal = 6.6974243242 + 0.0657098283 * d + hour;
    double angle = (sidereal * 15.0 + time->longitude) * degree - ascension;
    double latitude = time->latitude * degree;
    sun[0] = -cos(declination) * sin(angle);
    sun[1] = sin(declination) * cos(latitude) -
             cos(declination) * cos(angle) * sin(latitude);
    sun[2] = cos(latitude) * cos(angle) * cos(declination) +
             sin(declination) * sin(latitude);
}

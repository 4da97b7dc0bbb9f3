#ifndef ETALON_TESTS_SUPPORT_NEAR_H
#define ETALON_TESTS_SUPPORT_NEAR_H

/* Doubles within an absolute or a relative distance; include after cmocka.h. */

#include <math.h>

static inline void near_check(double value, double expected, double distance,
                              const char *file, int line)
{
    if (fabs(value - expected) <= distance)
        return;
    print_error("%.17g is not within %g of %.17g\n", value, distance, expected);
    _fail(file, line);
}

#define assert_near(value, expected, distance) \
    near_check((double)(value), expected, distance, __FILE__, __LINE__)

/* distance as a share of |expected| */
static inline void near_check_relative(double value, double expected, double distance,
                                       const char *file, int line)
{
    if (fabs(value - expected) <= distance * fabs(expected))
        return;
    print_error("%.17g is not within %g times of %.17g\n", value, distance, expected);
    _fail(file, line);
}

#define assert_relative(value, expected, distance) \
    near_check_relative((double)(value), expected, distance, __FILE__, __LINE__)

#endif

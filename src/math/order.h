#ifndef ETALON_MATH_ORDER_H
#define ETALON_MATH_ORDER_H

/* Order statistics of finite doubles. */

#include <stddef.h>

void sort_ascending(double *values, size_t count);
/* Of sorted values; count > 0. */
static inline double median_of_sorted(const double *sorted, size_t count)
{
    return 0.5 * (sorted[(count - 1) / 2] + sorted[count / 2]);
}

#endif

#include "import/number.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define EXACT_POWER    22                  /* 10^22 is the last power exact in double */
#define EXACT_MANTISSA (UINT64_C(1) << 53) /* as are integers up to here */
#define MANTISSA_ROOM  (UINT64_MAX / 10 - 10) /* another digit still fits */
#define EXPONENT_CAP   100000

struct decimal {
    uint64_t mantissa;
    int exponent; /* of ten */
    bool negative;
    bool truncated; /* digits were left out of the mantissa */
    int digits;
};

static bool is_digit(char c)
{
    return c >= '0' && c <= '9';
}

static const char *read_digits(const char *s, bool fraction, struct decimal *d)
{
    for (; is_digit(*s); s++) {
        d->digits++;
        if (d->mantissa <= MANTISSA_ROOM) {
            d->mantissa = d->mantissa * 10 + (uint64_t)(*s - '0');
            d->exponent -= fraction;
        } else {
            d->truncated = true;
            d->exponent += !fraction;
        }
    }
    return s;
}

/* "e-12"; without digits the e belongs to what follows. */
static const char *read_exponent(const char *s, struct decimal *d)
{
    const char *p = s + 1;
    bool negative = *p == '-';
    if (*p == '-' || *p == '+')
        p++;
    if (!is_digit(*p))
        return s;
    int e = 0;
    for (; is_digit(*p); p++)
        if (e < EXPONENT_CAP)
            e = e * 10 + (*p - '0');
    d->exponent += negative ? -e : e;
    return p;
}

const char *number_parse(const char *s, double *value)
{
    static const double power[EXACT_POWER + 1] = {
        1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
        1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
    struct decimal d = {0};
    const char *p = s;
    d.negative = *p == '-';
    if (*p == '-' || *p == '+')
        p++;
    p = read_digits(p, false, &d);
    if (*p == '.')
        p = read_digits(p + 1, true, &d);
    if (d.digits == 0)
        return NULL;
    if (*p == 'e' || *p == 'E')
        p = read_exponent(p, &d);
    int e = d.exponent;
    if (d.truncated || d.mantissa > EXACT_MANTISSA || e < -EXACT_POWER ||
        e > EXACT_POWER) {
        *value = strtod(s, NULL);
        return p;
    }
    double m = (double)d.mantissa;
    m = e < 0 ? m / power[-e] : m * power[e];
    *value = d.negative ? -m : m;
    return p;
}

const char *number_skip_nonfinite(const char *s)
{
    static const char *const words[] = {"infinity", "inf",    "nan",   "1.#qnan",
                                        "1.#snan",  "1.#ind", "1.#inf"};
    s += *s == '-' || *s == '+';
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        size_t length = strlen(words[i]);
        if (strncasecmp(s, words[i], length) != 0)
            continue;
        s += length;
        if (*s == '(')
            s += strcspn(s, ") \t\r\n");
        return s + (*s == ')');
    }
    return NULL;
}

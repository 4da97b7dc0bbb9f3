#ifndef ETALON_MATH_FOUND_NUMBERS_H
#define ETALON_MATH_FOUND_NUMBERS_H

/* Numbers that were found, not drawn, of another way to make a sample: what inverse
 * sampling (path/invert.h) hands to a chain (chain/pss_jump.h). */

/* A stream (math/ustream.h) has value[place] where that is not below 0; else at its first
 * `kept` places what the current sample has there; else it draws. */
struct found_numbers {
    int kept;
    double *value; /* [places] */
};

struct found {
    struct found_numbers camera, light, connect;
};

/* Whether there are such numbers; if SAME, the way drawn is the current one. */
enum inversion { INVERSION_NONE, INVERSION_SAME, INVERSION_OTHER };

#endif

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

enum found_stream { FOUND_CAMERA, FOUND_LIGHT, FOUND_CONNECT };

struct found {
    struct found_numbers camera, light, connect;
    /* NULL, or corrects u[count], numbers found for the places from `place` on, by what
     * has become of the sample when it asks for them. */
    void (*correct)(void *ctx, enum found_stream stream, int place, double *u, int count);
    void *ctx;
};

/* Whether there are such numbers; if SAME, the way drawn is the current one. */
enum inversion { INVERSION_NONE, INVERSION_SAME, INVERSION_OTHER };

#endif

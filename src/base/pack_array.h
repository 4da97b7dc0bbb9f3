#ifndef ETALON_BASE_PACK_ARRAY_H
#define ETALON_BASE_PACK_ARRAY_H

/* The values of a field in the file of a pack: all of them, or, where that is shorter,
 * those that are not 0: how many, a bit for each value, the values. The films of a run
 * that has just begun are nearly empty: without this the start of mmlt at 1280x720 and 64
 * edges takes 975 MB. */

#include "base/pack_file.h"

struct pack_array {
    size_t count, size;           /* of values, and bytes of each: 4 or 8 */
    const unsigned char *values;  /* those that are stored */
    const unsigned char *present; /* a bit for each of `count` in words; NULL: all are */
};

/* How many values to store: those that are not 0, or all, `count`, if that is shorter. */
size_t pack_array_stored(const void *values, size_t count, size_t size);
void pack_array_put(struct pack *pack, const void *values, size_t count, size_t size,
                    size_t stored);
/* Finds the values in the file, where they stay; false if they cannot be there. */
bool pack_array_get(struct pack *pack, size_t count, size_t size, bool sparse,
                    struct pack_array *array);
void pack_array_copy(const struct pack_array *array, void *to);
/* Adds to what is there, unsigned: sums of a damaged file may wrap. */
void pack_array_add(const struct pack_array *array, void *to);
/* Hands out those that are not 0, in their order; values of 4 bytes are unsigned. */
void pack_array_each(const struct pack_array *array, pack_take take, void *ctx);

#endif

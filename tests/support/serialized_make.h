#ifndef ETALON_TESTS_SUPPORT_SERIALIZED_MAKE_H
#define ETALON_TESTS_SUPPORT_SERIALIZED_MAKE_H

/* Files of Mitsuba's .serialized, written by hand. */

#include <assert.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include <zlib.h>

#define SERIALIZED_MAX 4096

struct serialized {
    unsigned char data[SERIALIZED_MAX];
    size_t size;
};

static inline void serialized_put(struct serialized *s, uint64_t bits, int width)
{
    for (int i = 0; i < width; i++)
        s->data[s->size++] = (unsigned char)(bits >> 8 * i);
}

static inline void serialized_put_number(struct serialized *s, double value, bool wide)
{
    uint64_t bits = 0;
    float narrow = (float)value;
    if (wide)
        memcpy(&bits, &value, sizeof value);
    else
        memcpy(&bits, &narrow, sizeof narrow); /* the low bytes: a little-endian host */
    serialized_put(s, bits, wide ? 8 : 4);
}

/* The body of a unit square at z, what its flags say it has; before compression. */
static inline void serialized_square(struct serialized *s, int version, unsigned flags,
                                     double z)
{
    static const double corner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    static const uint32_t index[6] = {0, 1, 2, 0, 2, 3};
    bool wide = flags & 0x2000;
    serialized_put(s, flags, 4);
    if (version == 4)
        for (const char *c = "square";; c++) {
            serialized_put(s, (uint64_t)*c, 1);
            if (!*c)
                break;
        }
    serialized_put(s, 4, 8);
    serialized_put(s, 2, 8);
    for (int i = 0; i < 4; i++) {
        serialized_put_number(s, corner[i][0], wide);
        serialized_put_number(s, corner[i][1], wide);
        serialized_put_number(s, z, wide);
    }
    for (int i = 0; i < 12 && (flags & 1); i++)
        serialized_put_number(s, i % 3 == 2, wide);
    for (int i = 0; i < 8 && (flags & 2); i++)
        serialized_put_number(s, corner[i / 2][i % 2], wide);
    for (int i = 0; i < 12 && (flags & 8); i++)
        serialized_put_number(s, 0.5, wide);
    for (int i = 0; i < 6; i++)
        serialized_put(s, index[i], 4);
}

/* Appends one mesh: header and compressed body. Returns its offset. */
static inline size_t serialized_add(struct serialized *file, int version,
                                    const struct serialized *body)
{
    size_t offset = file->size;
    uLongf room = SERIALIZED_MAX - 256;
    serialized_put(file, 0x041c, 2);
    serialized_put(file, (uint64_t)version, 2);
    room -= file->size;
    int status = compress(file->data + file->size, &room, body->data, body->size);
    assert(status == Z_OK);
    (void)status;
    file->size += room;
    return offset;
}

/* The table of meshes that ends a file. */
static inline void serialized_end(struct serialized *file, int version,
                                  const size_t *offsets, unsigned count)
{
    for (unsigned i = 0; i < count; i++)
        serialized_put(file, offsets[i], version == 3 ? 4 : 8);
    serialized_put(file, count, 4);
}

#endif

#include "surface/png_check.h"

#include <stdint.h>
#include <string.h>
#include <zlib.h>

#define SIGNATURE 8
#define FRAME     12 /* of a chunk: length, name, checksum */

static uint32_t big_endian(const unsigned char *b)
{
    return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3];
}

const char *png_check(const unsigned char *data, size_t size)
{
    if (size < SIGNATURE || memcmp(data, "\x89PNG\r\n\x1a\n", SIGNATURE) != 0)
        return NULL;
    for (size_t at = SIGNATURE; size - at >= FRAME;) {
        uint32_t length = big_endian(data + at);
        const unsigned char *name = data + at + 4;
        if (length > size - at - FRAME)
            break;
        if (crc32(crc32(0, NULL, 0), name, length + 4) != big_endian(name + 4 + length))
            return "its checksum tells that it is damaged";
        if (memcmp(name, "IEND", 4) == 0)
            return NULL;
        at += FRAME + (size_t)length;
    }
    return "it is cut short";
}

/* Bits per pixel of colour types 0 (grey), 2 (colour), 3 (palette), 4 and 6 (grey and
 * colour with alpha). */
int png_bits(const unsigned char *data, size_t size)
{
    static const int channels[] = {1, 0, 3, 1, 2, 0, 4};
    const size_t depth = SIGNATURE + FRAME - 4 + 8, type = depth + 1;
    if (size <= type || memcmp(data, "\x89PNG\r\n\x1a\n", SIGNATURE) != 0 ||
        data[type] >= sizeof channels / sizeof *channels)
        return 0;
    return data[depth] * channels[data[type]];
}

#include "live/tev.h"

#include <stdbool.h>
#include <string.h>

enum { UPDATE_IMAGE = 3, CREATE_IMAGE = 4 };

#define CHANNELS 3
static const char *const channels[CHANNELS] = {"R", "G", "B"};

static uint8_t *put_u32(uint8_t *at, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        *at++ = (uint8_t)(value >> 8 * i);
    return at;
}

static uint8_t *put_int(uint8_t *at, int value)
{
    return put_u32(at, (uint32_t)value);
}

static uint8_t *put_float(uint8_t *at, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return put_u32(at, bits);
}

static uint8_t *put_text(uint8_t *at, const char *text)
{
    size_t size = strlen(text) + 1;
    memcpy(at, text, size);
    return at + size;
}

/* The length is filled in by finish. */
static uint8_t *begin(uint8_t *at, int kind, bool grab_focus, const char *name)
{
    at = put_u32(at, 0);
    *at++ = (uint8_t)kind;
    *at++ = grab_focus;
    return put_text(at, name);
}

static size_t finish(uint8_t *packet, const uint8_t *end)
{
    size_t length = (size_t)(end - packet);
    put_u32(packet, (uint32_t)length);
    return length;
}

size_t tev_packet_most(const char *name)
{
    return strlen(name) + 64 + sizeof(float) * TEV_TILE * TEV_TILE;
}

size_t tev_create_image(uint8_t *to, const char *name, int width, int height)
{
    uint8_t *at = begin(to, CREATE_IMAGE, true, name);
    at = put_int(at, width);
    at = put_int(at, height);
    at = put_int(at, CHANNELS);
    for (int c = 0; c < CHANNELS; c++)
        at = put_text(at, channels[c]);
    return finish(to, at);
}

static int least(int a, int b)
{
    return a < b ? a : b;
}

size_t tev_update_image(uint8_t *to, const char *name, const struct image *image,
                        int channel, int x, int y)
{
    int width = least(TEV_TILE, image->width - x);
    int height = least(TEV_TILE, image->height - y);
    uint8_t *at = begin(to, UPDATE_IMAGE, false, name);
    at = put_text(at, channels[channel]);
    at = put_int(at, x);
    at = put_int(at, y);
    at = put_int(at, width);
    at = put_int(at, height);
    for (int v = y; v < y + height; v++)
        for (int u = x; u < x + width; u++)
            at = put_float(at, image_at(image, u, v)[channel]);
    return finish(to, at);
}

#include "surface/pfm.h"

#include "base/mem.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

struct header {
    int width, height, channels;
    double scale; /* > 0 */
    bool little;
    size_t size; /* bytes of the header */
};

bool pfm_is(const unsigned char *data, size_t size)
{
    return size >= 3 && data[0] == 'P' && (data[1] == 'F' || data[1] == 'f') &&
           strchr(" \t\r\n", data[2]) != NULL && data[2] != '\0';
}

/* The words of the header are apart by white space; one byte of it ends the last. */
static const char *next_number(const char *at, double *value)
{
    char *end;
    *value = strtod(at, &end);
    return end == at || !*end || !strchr(" \t\r\n", *end) ? NULL : end;
}

static bool read_header(const char *data, int most, struct header *h)
{
    double width, height, scale;
    const char *at = next_number(data + 2, &width);
    at = at ? next_number(at, &height) : NULL;
    at = at ? next_number(at, &scale) : NULL;
    if (!at || !(width >= 1.0 && width <= most) || !(height >= 1.0 && height <= most) ||
        scale == 0.0 || !isfinite(scale))
        return false;
    at += at[0] == '\r' && at[1] == '\n' ? 2 : 1;
    *h = (struct header){.width = (int)width,
                         .height = (int)height,
                         .channels = data[1] == 'F' ? 3 : 1,
                         .scale = fabs(scale),
                         .little = scale < 0.0,
                         .size = (size_t)(at - data)};
    return h->width == width && h->height == height;
}

static float load(const unsigned char *b, bool little, double scale)
{
    uint32_t bits = 0;
    float value;
    for (int i = 0; i < 4; i++)
        bits = bits << 8 | b[little ? 3 - i : i];
    memcpy(&value, &bits, sizeof value);
    return (float)((double)value * scale);
}

float *pfm_read(const char *data, size_t size, int most, int *width, int *height,
                const char **why)
{
    struct header h;
    *why = "its header is damaged, or asks for a size of none or too many pixels";
    if (!pfm_is((const unsigned char *)data, size) || !read_header(data, most, &h))
        return NULL;
    size_t row = (size_t)h.width * (size_t)h.channels, rows = (size_t)h.height;
    *why = "it is cut short";
    if ((size - h.size) / sizeof(float) / row < rows)
        return NULL;
    float *pixels = mem_alloc(3 * (size_t)h.width * rows, sizeof *pixels);
    const unsigned char *from = (const unsigned char *)data + h.size;
    for (size_t y = 0; y < rows; y++)
        for (size_t i = 0; i < 3 * (size_t)h.width; i++) {
            size_t at = (rows - 1 - y) * row + (h.channels == 3 ? i : i / 3);
            pixels[y * 3 * (size_t)h.width + i] = load(from + sizeof(float) * at,
                                                       h.little, h.scale);
        }
    *width = h.width;
    *height = h.height;
    return pixels;
}

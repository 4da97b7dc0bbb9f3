#include "report/report_encode.h"

#include "base/mem.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include <zlib.h>

#define MEM_LEVEL        8  /* zlib's default */
#define LARGEST_EXPONENT 15 /* the largest value lies just below 2^15 */

/* --- half floats ----------------------------------------------------------------- */

/* Rounds to nearest, ties to even. |x| < 65520 or not finite. */
static uint16_t half_of(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    uint16_t sign = (uint16_t)(bits >> 16 & 0x8000);
    float size = fabsf(x);
    if (isnan(x))
        return 0x7e00;
    if (isinf(x))
        return sign | 0x7c00;
    if (size < 0x1p-14f) /* no normal number: steps of 2^-24 */
        return (uint16_t)(sign | (uint16_t)lrintf(size * 0x1p24f));
    uint32_t rest = bits & 0x7fffffff;
    rest += 0xfff + (rest >> 13 & 1);
    return (uint16_t)(sign | (uint16_t)((rest >> 13) - (112u << 10)));
}

/* Rounds away the last `shift` bits. Values that are not finite stay so, as their upper
 * bits are kept. */
static uint16_t rounded(uint16_t half, int shift)
{
    bool finite = (half & 0x7c00) != 0x7c00;
    return (uint16_t)((half + (finite && shift > 0 ? 1 << (shift - 1) : 0)) >> shift);
}

static int exponent_of(const struct image *image)
{
    size_t count = 3 * (size_t)image->width * (size_t)image->height;
    float largest = 0.0f;
    int exponent = 0;
    for (size_t i = 0; i < count; i++)
        if (isfinite(image->pixels[i]))
            largest = fmaxf(largest, fabsf(image->pixels[i]));
    if (largest > 0.0f)
        (void)frexpf(largest, &exponent);
    return largest > 0.0f ? exponent - LARGEST_EXPONENT : 0;
}

/* --- planes ---------------------------------------------------------------------- */

/* [3][height][width]: G, R - G, B - G. */
static uint16_t *numbers_of(const struct image *image, int exponent, int shift)
{
    size_t pixels = (size_t)image->width * (size_t)image->height;
    uint16_t *numbers = mem_alloc(3 * pixels, sizeof *numbers);
    double scale = ldexp(1.0, -exponent);
    for (size_t i = 0; i < pixels; i++) {
        uint16_t half[3];
        for (int c = 0; c < 3; c++)
            half[c] = rounded(
                half_of((float)(scale * (double)image->pixels[3 * i + (size_t)c])),
                shift);
        numbers[i] = half[1];
        numbers[pixels + i] = (uint16_t)(half[0] - half[1]);
        numbers[2 * pixels + i] = (uint16_t)(half[2] - half[1]);
    }
    return numbers;
}

static uint16_t predicted(const uint16_t *plane, int width, int x, int y)
{
    const uint16_t *at = plane + (size_t)y * (size_t)width + x;
    if (x == 0)
        return y == 0 ? 0 : at[-width];
    if (y == 0)
        return at[-1];
    /* The mean as signed numbers: ratios lie on both sides of 0. */
    int sum = (int16_t)at[-1] + (int16_t)at[-width];
    return (uint16_t)(sum >> 1);
}

static uint16_t zigzag(uint16_t difference)
{
    return (uint16_t)(difference << 1 ^ (difference & 0x8000 ? 0xffff : 0));
}

static unsigned char *bytes_of(const uint16_t *numbers, int width, int height)
{
    size_t pixels = (size_t)width * (size_t)height;
    unsigned char *bytes = mem_alloc(6 * pixels, 1);
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                const uint16_t *plane = numbers + c * pixels;
                size_t i = (size_t)y * (size_t)width + (size_t)x;
                uint16_t z = zigzag((uint16_t)(plane[i] - predicted(plane, width, x, y)));
                bytes[2 * c * pixels + i] = (unsigned char)(z & 0xff);
                bytes[(2 * c + 1) * pixels + i] = (unsigned char)(z >> 8);
            }
    return bytes;
}

/* --- text ------------------------------------------------------------------------ */

void report_append_base64(struct text *text, const unsigned char *bytes, size_t size)
{
    static const char digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    size_t length = (size + 2) / 3 * 4;
    text->data = mem_grow(text->data, &text->capacity, text->length + length + 1, 1);
    char *to = text->data + text->length;
    for (size_t i = 0; i < size; i += 3) {
        uint32_t group = (uint32_t)bytes[i] << 16;
        group |= i + 1 < size ? (uint32_t)bytes[i + 1] << 8 : 0;
        group |= i + 2 < size ? bytes[i + 2] : 0;
        *to++ = digits[group >> 18];
        *to++ = digits[group >> 12 & 63];
        *to++ = i + 1 < size ? digits[group >> 6 & 63] : '=';
        *to++ = i + 2 < size ? digits[group & 63] : '=';
    }
    *to = '\0';
    text->length += length;
}

/* What is left of noise repeats nothing but runs of one byte: to look for these alone
 * takes a fourth of the time and finds as much (zlib's Z_RLE). */
static void append_packed(struct text *base64, unsigned char *bytes, size_t size)
{
    z_stream stream = {.next_in = bytes, .avail_in = (uInt)size};
    if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, MAX_WBITS, MEM_LEVEL,
                     Z_RLE) != Z_OK)
        return; /* no memory */
    size_t bound = deflateBound(&stream, (uLong)size);
    unsigned char *packed = mem_alloc(bound, 1);
    stream.next_out = packed;
    stream.avail_out = (uInt)bound;
    deflate(&stream, Z_FINISH);
    report_append_base64(base64, packed, stream.total_out);
    deflateEnd(&stream);
    mem_free(packed);
}

void report_encode(const struct image *image, int shift, struct text *base64,
                   int *exponent)
{
    size_t size = 6 * (size_t)image->width * (size_t)image->height;
    *exponent = exponent_of(image);
    uint16_t *numbers = numbers_of(image, *exponent, shift);
    unsigned char *bytes = bytes_of(numbers, image->width, image->height);
    append_packed(base64, bytes, size);
    mem_free(numbers);
    mem_free(bytes);
}

static void mean_of_block(const struct image *image, int factor, int x, int y, float *to)
{
    double sum[3] = {0.0};
    for (int v = 0; v < factor; v++)
        for (int u = 0; u < factor; u++)
            for (int c = 0; c < 3; c++)
                sum[c] += (double)image_at(image, x * factor + u, y * factor + v)[c];
    for (int c = 0; c < 3; c++)
        to[c] = (float)(sum[c] / ((double)factor * factor));
}

struct image *report_reduce(const struct image *image, int factor)
{
    int most = image->width < image->height ? image->width : image->height;
    factor = factor < most ? factor : most;
    struct image *small = image_create(image->width / factor, image->height / factor);
    for (int y = 0; y < small->height; y++)
        for (int x = 0; x < small->width; x++)
            mean_of_block(image, factor, x, y, image_at(small, x, y));
    return small;
}

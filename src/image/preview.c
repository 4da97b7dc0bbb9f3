#include "image/preview.h"

#include "base/mem.h"
#include "base/text.h"
#include "math/accum.h"
#include "math/rgb.h"

#include <math.h>
#include <stb/stb_image_write.h>
#include <string.h>

#define MIDDLE_GREY 0.18
#define SHOULDER    0.6 /* linear up to here, then bent towards 1 */

/* IEC 61966-2-1; a NaN is black. */
static unsigned char srgb(double linear)
{
    double x = linear > 0.0 ? fmin(linear, 1.0) : 0.0;
    double v = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
    return (unsigned char)(255.0 * v + 0.5);
}

/* [Reinhard et al. 2002, Eq. 1 and 2], its offset in proportion to the mean. */
double preview_scale(const struct image *image)
{
    struct accum sum = {0}, logs = {0};
    long pixels = (long)image->width * image->height, count = 0;
    for (int pass = 0; pass < 2; pass++) {
        double offset = count ? 1e-3 * accum_value(&sum) / (double)count : 0.0;
        count = 0;
        for (long i = 0; i < pixels; i++) {
            double luminance = rgb_luminance(image_pixel(image, i));
            if (!(luminance > 0.0) || isinf(luminance))
                continue;
            count++;
            accum_add(pass ? &logs : &sum, pass ? log(luminance + offset) : luminance);
        }
    }
    return count ? MIDDLE_GREY / exp(accum_value(&logs) / (double)count) : 1.0;
}

/* Compresses the largest component and scales the others with it, which keeps hue and
 * saturation. */
static struct rgb roll_off(struct rgb x)
{
    double max = rgb_max(x), room = 1.0 - SHOULDER;
    if (!(max > SHOULDER) || isinf(max))
        return x;
    double bent = SHOULDER + room * (1.0 - exp((SHOULDER - max) / room));
    return rgb_scale(x, bent / max);
}

static void append(void *context, void *data, int size)
{
    struct text *out = context;
    out->data = mem_grow(out->data, &out->capacity, out->length + (size_t)size, 1);
    memcpy(out->data + out->length, data, (size_t)size);
    out->length += (size_t)size;
}

bool preview_append_png(struct text *png, const struct image *image, double exposure)
{
    bool automatic = isnan(exposure);
    double scale = automatic ? preview_scale(image) : exp2(exposure);
    long pixels = (long)image->width * image->height;
    unsigned char *bytes = mem_alloc((size_t)pixels, 3);
    for (long i = 0; i < pixels; i++) {
        struct rgb x = rgb_scale(image_pixel(image, i), scale);
        x = automatic ? roll_off(x) : x;
        bytes[3 * i] = srgb(x.r);
        bytes[3 * i + 1] = srgb(x.g);
        bytes[3 * i + 2] = srgb(x.b);
    }
    bool ok = stbi_write_png_to_func(append, png, image->width, image->height, 3, bytes,
                                     3 * image->width) != 0;
    mem_free(bytes);
    return ok;
}

bool preview_write_png(const char *path, const struct image *image, double exposure,
                       struct err *err)
{
    struct text png = {0};
    bool ok = preview_append_png(&png, image, exposure);
    ok = ok ? text_write_file(path, png.data, png.length, err)
            : err_set(err, ERR_IO, NULL, "cannot write '%s': no memory for a PNG", path);
    mem_free(png.data);
    return ok;
}

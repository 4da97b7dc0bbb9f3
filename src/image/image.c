#include "image/image.h"

#include "base/mem.h"

#include <assert.h>
#include <math.h>
#include <string.h>

struct image *image_create(int width, int height)
{
    struct image *image = mem_alloc(1, sizeof *image);
    image->width = image->whole_width = width;
    image->height = image->whole_height = height;
    image->pixels = mem_alloc((size_t)width * (size_t)height, 3 * sizeof(float));
    return image;
}

struct image *image_create_like(const struct image *image)
{
    struct image *made = image_create(image->width, image->height);
    made->x = image->x;
    made->y = image->y;
    made->whole_width = image->whole_width;
    made->whole_height = image->whole_height;
    return made;
}

struct image *image_copy(const struct image *image)
{
    struct image *made = image_create_like(image);
    memcpy(made->pixels, image->pixels,
           3 * sizeof *image->pixels * (size_t)image->width * (size_t)image->height);
    return made;
}

void image_destroy(struct image *image)
{
    if (!image)
        return;
    mem_free(image->pixels);
    mem_free(image);
}

static float block_mean(const struct image *image, int x, int y, int channel, int factor)
{
    double sum = 0.0;
    for (int j = 0; j < factor; j++)
        for (int i = 0; i < factor; i++)
            sum += (double)image_at(image, x * factor + i, y * factor + j)[channel];
    return (float)(sum / ((double)factor * factor));
}

struct image *image_reduce(const struct image *image, int factor)
{
    if (factor < 1 || image->width % factor || image->height % factor)
        return NULL;
    struct image *out = image_create(image->width / factor, image->height / factor);
    for (int y = 0; y < out->height; y++)
        for (int x = 0; x < out->width; x++)
            for (int c = 0; c < 3; c++)
                image_at(out, x, y)[c] = block_mean(image, x, y, c, factor);
    return out;
}

struct image *image_mean(const struct image *a, const struct image *b)
{
    assert(a->width == b->width && a->height == b->height);
    struct image *out = image_create_like(a);
    size_t count = 3 * (size_t)a->width * (size_t)a->height;
    for (size_t i = 0; i < count; i++)
        out->pixels[i] = (float)(0.5 * ((double)a->pixels[i] + (double)b->pixels[i]));
    return out;
}

long image_nonfinite(const struct image *image)
{
    long count = 0;
    for (long i = 0; i < (long)image->width * image->height; i++) {
        const float *p = image->pixels + 3 * i;
        count += !(isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]));
    }
    return count;
}

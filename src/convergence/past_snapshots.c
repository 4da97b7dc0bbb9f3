#include "convergence/past_snapshots.h"

#include "base/mem.h"
#include "math/rgb.h"

#include <stdint.h>
#include <string.h>

#define FIRST 0.015625 /* first snapshot, as a share of the budget */
#define PART  0.75     /* later snapshots have hardly changed since; of the length */

void past_snapshots_init(struct past_snapshots *past, int width, int height,
                         double budget)
{
    *past = (struct past_snapshots){.due = FIRST * budget};
    for (int i = 0; i < 2; i++)
        past->pictures[i] = image_create(width, height);
}

void past_snapshots_deinit(struct past_snapshots *past)
{
    for (int i = 0; i < 2; i++)
        image_destroy(past->pictures[i]);
}

struct image *past_snapshots_next(struct past_snapshots *past, double length)
{
    if (!(length >= past->due))
        return NULL;
    struct image *oldest = past->pictures[1];
    past->pictures[1] = past->pictures[0];
    past->lengths[1] = past->lengths[0];
    past->pictures[0] = oldest;
    past->lengths[0] = length;
    past->due = 2.0 * length;
    return oldest;
}

const struct image *past_snapshots_latest(const struct past_snapshots *past,
                                          double length)
{
    for (int i = 0; i < 2; i++)
        if (past->lengths[i] > 0.0 && past->lengths[i] <= PART * length)
            return past->pictures[i];
    return NULL;
}

/* Packs the bits of the floats, so that a resumed run compares with the same values. */
static void pack_picture(struct pack *pack, struct image *image)
{
    size_t count = 3 * (size_t)image->width * (size_t)image->height;
    uint32_t *bits = mem_alloc(count, sizeof *bits);
    memcpy(bits, image->pixels, count * sizeof *bits);
    pack_uint32s(pack, "past_snapshots", bits, count);
    memcpy(image->pixels, bits, count * sizeof *bits);
    mem_free(bits);
}

void past_snapshots_pack(struct pack *pack, struct past_snapshots *past)
{
    pack_doubles(pack, "past_snapshots_lengths", past->lengths, 2);
    pack_double(pack, "past_snapshots_due", &past->due);
    for (int i = 0; i < 2; i++)
        pack_picture(pack, past->pictures[i]);
}

/* Red, green, blue and luminance. */
static void values_of(const struct image *image, long pixel, double out[4])
{
    struct rgb value = image_pixel(image, pixel);
    out[0] = value.r;
    out[1] = value.g;
    out[2] = value.b;
    out[3] = rgb_luminance(value);
}

void past_snapshots_colours(const struct image *picture, const struct image *before,
                            double floor, double out[3])
{
    double sums[4] = {0.0};
    for (long i = 0; i < (long)picture->width * picture->height; i++) {
        double now[4], then[4];
        values_of(picture, i, now);
        values_of(before, i, then);
        for (int c = 0; c < 4; c++)
            sums[c] += (then[c] - now[c]) * (then[c] - now[c]) /
                       (now[c] * now[c] + floor);
    }
    for (int c = 0; c < 3; c++)
        out[c] = sums[c] > 0.0 || sums[3] > 0.0 ? sums[c] / sums[3] : 1.0;
}

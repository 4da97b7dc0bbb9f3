#include "convergence/past_snapshots.h"

#include "base/mem.h"
#include "math/rgb.h"

#include <stdint.h>
#include <string.h>

#define FIRST 0.015625 /* of the budget */
#define PART  0.75     /* of the length: what is nearer to it has hardly moved since */

void past_snapshots_init(struct past_snapshots *e, int width, int height, double budget)
{
    *e = (struct past_snapshots){.due = FIRST * budget};
    for (int i = 0; i < 2; i++)
        e->pictures[i] = image_create(width, height);
}

void past_snapshots_deinit(struct past_snapshots *e)
{
    for (int i = 0; i < 2; i++)
        image_destroy(e->pictures[i]);
}

struct image *past_snapshots_next(struct past_snapshots *e, double length)
{
    if (!(length >= e->due))
        return NULL;
    struct image *oldest = e->pictures[1];
    e->pictures[1] = e->pictures[0];
    e->lengths[1] = e->lengths[0];
    e->pictures[0] = oldest;
    e->lengths[0] = length;
    e->due = 2.0 * length;
    return oldest;
}

const struct image *past_snapshots_latest(const struct past_snapshots *e, double length)
{
    for (int i = 0; i < 2; i++)
        if (e->lengths[i] > 0.0 && e->lengths[i] <= PART * length)
            return e->pictures[i];
    return NULL;
}

/* Bit by bit: a resumed run compares with the same. */
static void pack_picture(struct pack *pack, struct image *image)
{
    size_t count = 3 * (size_t)image->width * (size_t)image->height;
    uint32_t *bits = mem_alloc(count, sizeof *bits);
    memcpy(bits, image->pixels, count * sizeof *bits);
    pack_uint32s(pack, "past_snapshots", bits, count);
    memcpy(image->pixels, bits, count * sizeof *bits);
    mem_free(bits);
}

void past_snapshots_pack(struct pack *pack, struct past_snapshots *e)
{
    pack_doubles(pack, "past_snapshots_lengths", e->lengths, 2);
    pack_double(pack, "past_snapshots_due", &e->due);
    for (int i = 0; i < 2; i++)
        pack_picture(pack, e->pictures[i]);
}

/* The channels and luminance. */
static void values_of(const struct image *image, long pixel, double out[4])
{
    for (int c = 0; c < 3; c++)
        out[c] = (double)image->pixels[3 * pixel + c];
    out[3] = rgb_luminance(rgb(out[0], out[1], out[2]));
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

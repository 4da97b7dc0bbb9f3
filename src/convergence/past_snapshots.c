#include "convergence/past_snapshots.h"

#include "base/mem.h"
#include "math/rgb.h"

#include <stdint.h>
#include <string.h>

#define FIRST 0.015625 /* first snapshot, as a share of the budget */
#define PART  0.75     /* later snapshots have hardly changed since; of the length */

static void sum_arrays(struct past_snapshots *past, size_t pixels, struct mem_plan *plan)
{
    for (int i = 0; i < 2 && past->count > 0; i++)
        past->sums[i] = mem_take(plan, MEM_APART, pixels * (size_t)past->count,
                                 sizeof *past->sums[i]);
}

void past_snapshots_init(struct past_snapshots *past, int width, int height,
                         double budget, int count)
{
    *past = (struct past_snapshots){.due = FIRST * budget, .count = count};
    sum_arrays(past, (size_t)width * (size_t)height, &(struct mem_plan){.take = true});
    for (int i = 0; i < 2; i++)
        past->pictures[i] = image_create(width, height);
}

void past_snapshots_deinit(struct past_snapshots *past)
{
    for (int i = 0; i < 2; i++) {
        image_destroy(past->pictures[i]);
        mem_free(past->sums[i]);
    }
}

double past_snapshots_bytes(int width, int height, int count)
{
    struct mem_plan plan = {.take = false};
    struct past_snapshots past = {.count = count};
    sum_arrays(&past, (size_t)width * (size_t)height, &plan);
    return plan.bytes + 6.0 * sizeof(float) * width * height;
}

bool past_snapshots_due(const struct past_snapshots *past, double length)
{
    return length >= past->due;
}

/* A snapshot becomes the older one, and its memory is used for the next. */
static void rotate(struct past_snapshots *past)
{
    struct image *picture = past->pictures[1];
    exact_sum *sums = past->sums[1];
    past->pictures[1] = past->pictures[0];
    past->pictures[0] = picture;
    past->sums[1] = past->sums[0];
    past->sums[0] = sums;
    past->lengths[1] = past->lengths[0];
    memcpy(past->scales[1], past->scales[0], sizeof past->scales[1]);
}

static void write_pixel(struct image *out, long pixel, const exact_sum *sums, int count,
                        const double scales[2])
{
    for (int c = 0; c < 3; c++) {
        double value = exact_value(sums[c]) * scales[0];
        if (count > 3)
            value += exact_value(sums[c + 3]) * scales[1];
        out->pixels[3 * pixel + c] = (float)value;
    }
}

void fixed_picture_write(const struct fixed_picture *picture, struct image *out)
{
    for (long i = 0; i < (long)out->width * out->height; i++) {
        exact_sum sums[FIXED_SUMS] = {0};
        picture->add(picture->self, i, sums);
        write_pixel(out, i, sums, picture->count, picture->scales);
    }
}

void past_snapshots_take(struct past_snapshots *past, double length,
                         const struct fixed_picture *picture)
{
    rotate(past);
    past->lengths[0] = length;
    past->due = 2.0 * length;
    memcpy(past->scales[0], picture->scales, sizeof past->scales[0]);
    if (past->count == 0) {
        fixed_picture_write(picture, past->pictures[0]);
        return;
    }
    long pixels = (long)past->pictures[0]->width * past->pictures[0]->height;
    for (long i = 0; i < pixels; i++) {
        exact_sum sums[FIXED_SUMS] = {0};
        picture->add(picture->self, i, sums);
        memcpy(past->sums[0] + i * past->count, sums, (size_t)past->count * sizeof *sums);
    }
}

void past_snapshots_clear(struct past_snapshots *past)
{
    size_t pixels = (size_t)past->pictures[0]->width * (size_t)past->pictures[0]->height;
    for (int i = 0; i < 2 && past->count > 0; i++)
        memset(past->sums[i], 0, pixels * (size_t)past->count * sizeof *past->sums[i]);
}

void past_snapshots_complete(struct past_snapshots *past, double factor)
{
    for (int i = 0; i < 2 && past->count > 0; i++) {
        struct image *out = past->pictures[i];
        const double scales[2] = {factor * past->scales[i][0],
                                  factor * past->scales[i][1]};
        for (long j = 0; j < (long)out->width * out->height; j++)
            write_pixel(out, j, past->sums[i] + j * past->count, past->count, scales);
    }
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

void past_snapshots_take_pictures(struct past_snapshots *past,
                                  const struct past_snapshots *from)
{
    size_t values = 3 * (size_t)past->pictures[0]->width *
                    (size_t)past->pictures[0]->height;
    past->due = from->due;
    for (int i = 0; i < 2; i++) {
        past->lengths[i] = from->lengths[i];
        memcpy(past->pictures[i]->pixels, from->pictures[i]->pixels,
               values * sizeof(float));
    }
}

/* The scales differ between parts that the clock ended; then the sums so far are
 * converted to those of the next part. */
static void rescale(struct past_snapshots *past, int index, const double scales[2])
{
    size_t values = (size_t)past->pictures[0]->width * (size_t)past->pictures[0]->height *
                    (size_t)past->count;
    for (size_t i = 0; i < values; i++) {
        int kind = (int)(i % (size_t)past->count) / 3;
        double from = past->scales[index][kind], to = scales[kind];
        if (from != to && to > 0.0)
            past->sums[index][i] = exact_of(exact_value(past->sums[index][i]) * from /
                                            to);
    }
    memcpy(past->scales[index], scales, sizeof past->scales[index]);
}

static void pack_sums(struct pack *pack, struct past_snapshots *past, int index)
{
    double scales[2] = {past->scales[index][0], past->scales[index][1]};
    size_t pixels = (size_t)past->pictures[0]->width * (size_t)past->pictures[0]->height;
    pack_doubles(pack, "past_snapshots_scales", scales, 2);
    if (pack_adds(pack) && pack_ok(pack))
        rescale(past, index, scales);
    else
        memcpy(past->scales[index], scales, sizeof scales);
    exact_pack(pack, "past_snapshots_sums", past->sums[index],
               pixels * (size_t)past->count);
}

void past_snapshots_pack(struct pack *pack, struct past_snapshots *past)
{
    pack_doubles(pack, "past_snapshots_lengths", past->lengths, 2);
    pack_double(pack, "past_snapshots_due", &past->due);
    for (int i = 0; i < 2; i++)
        if (past->count > 0)
            pack_sums(pack, past, i);
        else
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

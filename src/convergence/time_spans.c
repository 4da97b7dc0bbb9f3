#include "convergence/time_spans.h"

#include "base/mem.h"
#include "base/par.h"

static int tiles_across(int pixels, int tile)
{
    return (pixels + tile - 1) / tile;
}

int time_spans_tile(int width, int height, int least, int most)
{
    int tile = least;
    while ((double)tiles_across(width, tile) * tiles_across(height, tile) > most)
        tile++;
    return tile;
}

static size_t span_numbers(const struct time_spans *b)
{
    return (size_t)b->tiles * (size_t)b->replicas;
}

static void set_tiles(struct time_spans *b, int width, int height)
{
    b->tile = time_spans_tile(width, height, TILE_LEAST, TILES_MOST);
    b->columns = tiles_across(width, b->tile);
    b->rows = tiles_across(height, b->tile);
    b->tiles = b->columns * b->rows;
}

static void time_spans_arrays(struct time_spans *b, struct mem_plan *plan)
{
    b->sums = mem_take(plan, 0, TIME_SPANS_MOST * span_numbers(b), sizeof *b->sums);
    b->whole = mem_take(plan, 0, span_numbers(b), sizeof *b->whole);
}

double time_spans_bytes(int width, int height, int replicas)
{
    struct time_spans spans = {.replicas = replicas};
    struct mem_plan plan = {.take = false};
    set_tiles(&spans, width, height);
    time_spans_arrays(&spans, &plan);
    return plan.bytes;
}

void time_spans_init(struct time_spans *b, const struct replicas *r, double length)
{
    *b = (struct time_spans){.replicas = r->count, .length = length, .due = length};
    set_tiles(b, r->width, r->height);
    time_spans_arrays(b, &(struct mem_plan){.take = true});
}

void time_spans_deinit(struct time_spans *b)
{
    mem_free(b->sums);
    mem_free(b->whole);
}

/* One row of tiles of one replica. Sums of integers: the order does not matter. */
static void scan_row(void *ctx, long index, int thread)
{
    struct time_spans *b = ctx;
    const struct replicas *r = b->from;
    int replica = (int)(index / b->rows), row = (int)(index % b->rows);
    int64_t sums[TILES_MOST] = {0};
    (void)thread;
    for (int lane = 0; lane < r->threads && (lane == 0 || !r->lanes[lane].shared); lane++)
        for (int y = row * b->tile; y < (row + 1) * b->tile && y < r->height; y++) {
            const int64_t *from = r->lanes[lane].sums +
                                  ((long)replica * r->height + y) * r->width;
            for (int x = 0, column = 0; x < r->width; column++)
                for (int end = x + b->tile; x < end && x < r->width; x++)
                    sums[column] += from[x];
        }
    for (int column = 0; column < b->columns; column++) {
        long at = (long)(row * b->columns + column) * b->replicas + replica;
        double now = (double)sums[column] / REPLICAS_ONE;
        b->sums[(size_t)b->count * span_numbers(b) + (size_t)at] = now - b->whole[at];
        b->whole[at] = now;
    }
}

static void join_pairs(struct time_spans *b)
{
    size_t numbers = span_numbers(b);
    for (size_t i = 0; i < TIME_SPANS_MOST / 2; i++) {
        double *into = b->sums + i * numbers;
        const double *one = b->sums + 2 * i * numbers, *two = one + numbers;
        for (size_t j = 0; j < numbers; j++)
            into[j] = one[j] + two[j];
        b->lengths[i] = b->lengths[2 * i] + b->lengths[2 * i + 1];
    }
    b->count = TIME_SPANS_MOST / 2;
    b->length *= 2.0;
}

/* The mean over the replicas. */
static double brightness_of_last(const struct time_spans *b)
{
    const double *sums = b->sums + (size_t)b->count * span_numbers(b);
    double sum = 0.0;
    for (size_t i = 0; i < span_numbers(b); i++)
        sum += sums[i];
    return sum / b->replicas;
}

void time_spans_take(struct time_spans *b, const struct replicas *r, double done,
                     bool own, int threads)
{
    if (done < b->due)
        return;
    b->from = r;
    par_for((long)b->replicas * b->rows, threads, scan_row, b);
    b->from = NULL;
    double brightness = own ? brightness_of_last(b) : 0.0;
    b->lengths[b->count++] = brightness > 0.0 ? brightness : done - b->done;
    b->done = done;
    if (b->count == TIME_SPANS_MOST)
        join_pairs(b);
    b->due = done + b->length;
}

void time_spans_sequences(const struct time_spans *b, int tile, double *out)
{
    for (int i = 0; i < b->count; i++)
        for (int replica = 0; replica < b->replicas; replica++) {
            const double *sums = b->sums + (size_t)i * span_numbers(b) + replica;
            double sum = 0.0;
            for (int j = tile < 0 ? 0 : tile; j < (tile < 0 ? b->tiles : tile + 1); j++)
                sum += sums[(size_t)j * (size_t)b->replicas];
            out[replica * b->count + i] = sum / b->lengths[i];
        }
}

void time_spans_pack(struct pack *pack, struct time_spans *b)
{
    pack_int(pack, "spans", &b->count, 0, TIME_SPANS_MOST);
    pack_doubles(pack, "lengths", b->lengths, TIME_SPANS_MOST);
    pack_doubles(pack, "sums", b->sums, TIME_SPANS_MOST * span_numbers(b));
    pack_doubles(pack, "whole", b->whole, span_numbers(b));
    pack_double(pack, "done", &b->done);
    pack_double(pack, "due", &b->due);
    pack_double(pack, "length", &b->length);
}

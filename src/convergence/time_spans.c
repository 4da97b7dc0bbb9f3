#include "convergence/time_spans.h"

#include "base/mem.h"
#include "base/par.h"

int time_spans_across(int pixels, int tile)
{
    return (pixels + tile - 1) / tile;
}

int time_spans_tile(int width, int height, int least, int most)
{
    int tile = least;
    while ((double)time_spans_across(width, tile) * time_spans_across(height, tile) >
           most)
        tile++;
    return tile;
}

static size_t span_numbers(const struct time_spans *spans)
{
    return (size_t)spans->tiles * (size_t)spans->replicas;
}

static void set_tiles(struct time_spans *spans, int width, int height)
{
    spans->tile = time_spans_tile(width, height, TILE_LEAST, TILES_MOST);
    spans->columns = time_spans_across(width, spans->tile);
    spans->rows = time_spans_across(height, spans->tile);
    spans->tiles = spans->columns * spans->rows;
}

static void time_spans_arrays(struct time_spans *spans, struct mem_plan *plan)
{
    spans->sums = mem_take(plan, 0, TIME_SPANS_MOST * span_numbers(spans),
                           sizeof *spans->sums);
    spans->whole = mem_take(plan, 0, span_numbers(spans), sizeof *spans->whole);
}

double time_spans_bytes(int width, int height, int replicas)
{
    struct time_spans spans = {.replicas = replicas};
    struct mem_plan plan = {.take = false};
    set_tiles(&spans, width, height);
    time_spans_arrays(&spans, &plan);
    return plan.bytes;
}

void time_spans_init(struct time_spans *spans, const struct replicas *r, double length)
{
    *spans = (struct time_spans){.replicas = r->count, .length = length, .due = length};
    set_tiles(spans, r->width, r->height);
    time_spans_arrays(spans, &(struct mem_plan){.take = true});
}

void time_spans_deinit(struct time_spans *spans)
{
    mem_free(spans->sums);
    mem_free(spans->whole);
}

/* Sums one row of tiles of one replica. The sums are of integers, so their order does not
 * matter. */
static void scan_row(void *ctx, long index, int thread)
{
    struct time_spans *spans = ctx;
    const struct replicas *r = spans->from;
    int replica = (int)(index / spans->rows), row = (int)(index % spans->rows);
    int64_t sums[TILES_MOST] = {0};
    (void)thread;
    for (int lane = 0; lane < r->threads && (lane == 0 || !r->lanes[lane].shared); lane++)
        for (int y = row * spans->tile; y < (row + 1) * spans->tile && y < r->height;
             y++) {
            const int64_t *from = r->lanes[lane].sums +
                                  ((long)replica * r->height + y) * r->width;
            for (int x = 0, column = 0; x < r->width; column++)
                for (int end = x + spans->tile; x < end && x < r->width; x++)
                    sums[column] += from[x];
        }
    for (int column = 0; column < spans->columns; column++) {
        long at = (long)(row * spans->columns + column) * spans->replicas + replica;
        double now = (double)sums[column] / REPLICAS_ONE;
        spans->sums[(size_t)spans->count * span_numbers(spans) + (size_t)at] =
            now - spans->whole[at];
        spans->whole[at] = now;
    }
}

static void join_pairs(struct time_spans *spans)
{
    size_t numbers = span_numbers(spans);
    for (size_t i = 0; i < TIME_SPANS_MOST / 2; i++) {
        double *into = spans->sums + i * numbers;
        const double *one = spans->sums + 2 * i * numbers, *two = one + numbers;
        for (size_t j = 0; j < numbers; j++)
            into[j] = one[j] + two[j];
        spans->lengths[i] = spans->lengths[2 * i] + spans->lengths[2 * i + 1];
    }
    spans->count = TIME_SPANS_MOST / 2;
    spans->length *= 2.0;
}

/* Brightness of the newest span: mean over the replicas. */
static double brightness_of_last(const struct time_spans *spans)
{
    const double *sums = spans->sums + (size_t)spans->count * span_numbers(spans);
    double sum = 0.0;
    for (size_t i = 0; i < span_numbers(spans); i++)
        sum += sums[i];
    return sum / spans->replicas;
}

void time_spans_take(struct time_spans *spans, const struct replicas *r, double done,
                     bool own, int threads)
{
    if (done < spans->due)
        return;
    spans->from = r;
    par_for((long)spans->replicas * spans->rows, threads, scan_row, spans);
    spans->from = NULL;
    double brightness = own ? brightness_of_last(spans) : 0.0;
    spans->lengths[spans->count++] = brightness > 0.0 ? brightness : done - spans->done;
    spans->done = done;
    if (spans->count == TIME_SPANS_MOST)
        join_pairs(spans);
    spans->due = done + spans->length;
}

void time_spans_sequences(const struct time_spans *spans, int tile, double *out)
{
    for (int i = 0; i < spans->count; i++)
        for (int replica = 0; replica < spans->replicas; replica++) {
            const double *sums = spans->sums + (size_t)i * span_numbers(spans) + replica;
            double sum = 0.0;
            for (int j = tile < 0 ? 0 : tile; j < (tile < 0 ? spans->tiles : tile + 1);
                 j++)
                sum += sums[(size_t)j * (size_t)spans->replicas];
            out[replica * spans->count + i] = sum / spans->lengths[i];
        }
}

void time_spans_pack(struct pack *pack, struct time_spans *spans)
{
    pack_int(pack, "spans", &spans->count, 0, TIME_SPANS_MOST);
    pack_doubles(pack, "lengths", spans->lengths, TIME_SPANS_MOST);
    pack_doubles(pack, "sums", spans->sums, TIME_SPANS_MOST * span_numbers(spans));
    pack_doubles(pack, "whole", spans->whole, span_numbers(spans));
    pack_double(pack, "done", &spans->done);
    pack_double(pack, "due", &spans->due);
    pack_double(pack, "length", &spans->length);
}

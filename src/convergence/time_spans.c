#include "convergence/time_spans.h"

#include "base/mem.h"
#include "base/par.h"

#include <string.h>

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
    spans->ends = mem_take(plan, 0, TIME_SPANS_MOST * span_numbers(spans),
                           sizeof *spans->ends);
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
    mem_free(spans->ends);
}

/* The sums at the end of a span. */
static int64_t *end_of(const struct time_spans *spans, int span)
{
    return spans->ends + (size_t)span * span_numbers(spans);
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
        end_of(spans, spans->count)[at] = sums[column];
    }
}

static void join_pairs(struct time_spans *spans)
{
    spans->count /= 2;
    for (int i = 0; i < spans->count; i++) {
        memmove(end_of(spans, i), end_of(spans, 2 * i + 1),
                span_numbers(spans) * sizeof *spans->ends);
        spans->done[i] = spans->done[2 * i + 1];
    }
    spans->length *= 2.0;
}

/* Sum of a span in one tile of one replica; at: tile * replicas + replica. */
static double span_sum(const struct time_spans *spans, int span, size_t at)
{
    int64_t before = span > 0 ? end_of(spans, span - 1)[at] : 0;
    return (double)(end_of(spans, span)[at] - before) / REPLICAS_ONE;
}

static void find_lengths(struct time_spans *spans)
{
    for (int i = 0; i < spans->count; i++) {
        double sum = 0.0, before = i > 0 ? spans->done[i - 1] : 0.0;
        for (size_t j = 0; spans->own && j < span_numbers(spans); j++)
            sum += span_sum(spans, i, j);
        spans->lengths[i] = sum > 0.0 ? sum / spans->replicas : spans->done[i] - before;
    }
}

void time_spans_take(struct time_spans *spans, const struct replicas *r, double done,
                     bool own, int threads)
{
    if (done < spans->due)
        return;
    spans->from = r;
    par_for((long)spans->replicas * spans->rows, threads, scan_row, spans);
    spans->from = NULL;
    spans->own = own;
    spans->done[spans->count++] = done;
    if (spans->count == TIME_SPANS_MOST)
        join_pairs(spans);
    spans->due = done + spans->length;
    find_lengths(spans);
}

void time_spans_sequences(const struct time_spans *spans, int tile, double *out)
{
    int first = tile < 0 ? 0 : tile, end = tile < 0 ? spans->tiles : tile + 1;
    for (int i = 0; i < spans->count; i++)
        for (int replica = 0; replica < spans->replicas; replica++) {
            double sum = 0.0;
            for (int j = first; j < end; j++)
                sum += span_sum(spans, i,
                                (size_t)j * (size_t)spans->replicas + (size_t)replica);
            out[replica * spans->count + i] = sum / spans->lengths[i];
        }
}

/* --- parts ------------------------------------------------------------------------ */

/* Takes over when the spans of the first part end. */
static void begin_adding(struct time_spans *spans, const struct time_spans *part)
{
    int64_t *ends = spans->ends;
    *spans = *part;
    spans->ends = ends;
    spans->added = true;
}

void time_spans_add(struct time_spans *spans, struct time_spans *part)
{
    if (!spans->added)
        begin_adding(spans, part);
    while (part->length < spans->length && part->count > 0)
        join_pairs(part);
    while (spans->length < part->length && spans->count > 0)
        join_pairs(spans);
    if (part->count < spans->count)
        spans->count = part->count;
    size_t numbers = (size_t)spans->count * span_numbers(spans);
    for (size_t i = 0; i < numbers; i++)
        spans->ends[i] = (int64_t)((uint64_t)spans->ends[i] + (uint64_t)part->ends[i]);
    find_lengths(spans);
}

void time_spans_clear(struct time_spans *spans)
{
    memset(spans->ends, 0, TIME_SPANS_MOST * span_numbers(spans) * sizeof *spans->ends);
}

void time_spans_scale(struct time_spans *spans, int replica, double factor)
{
    for (size_t i = 0; i < (size_t)spans->count * span_numbers(spans); i++)
        if (replica < 0 || (int)(i % (size_t)spans->replicas) == replica)
            spans->ends[i] = (int64_t)rint((double)spans->ends[i] * factor);
    find_lengths(spans);
}

/* The numbers that time_spans_init gives are not in it. */
static void pack_spans(struct pack *pack, struct time_spans *spans)
{
    pack_int(pack, "spans", &spans->count, 0, TIME_SPANS_MOST);
    pack_doubles(pack, "spans_done", spans->done, TIME_SPANS_MOST);
    pack_int64s(pack, "ends", spans->ends, TIME_SPANS_MOST * span_numbers(spans));
    pack_double(pack, "due", &spans->due);
    pack_double(pack, "length", &spans->length);
    pack_flag(pack, "own", &spans->own);
}

void time_spans_pack(struct pack *pack, struct time_spans *spans)
{
    if (!pack_adds(pack)) {
        pack_spans(pack, spans);
        find_lengths(spans);
        return;
    }
    struct time_spans part = *spans;
    part.ends = mem_alloc(TIME_SPANS_MOST * span_numbers(spans), sizeof *part.ends);
    pack_spans(pack, &part);
    if (pack_ok(pack))
        time_spans_add(spans, &part);
    time_spans_deinit(&part);
}

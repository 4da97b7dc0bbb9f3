#include "convergence/replicas.h"

#include "base/pack.h"
#include "base/par.h"

#include <assert.h>
#include <string.h>

enum { CACHE_LINE = 64 };

static int64_t *lane_array(int width, int height, int count, struct mem_plan *plan)
{
    return mem_take(plan, CACHE_LINE, (size_t)width * (size_t)height * (size_t)count,
                    sizeof(int64_t));
}

static double one_lane(int width, int height, int count)
{
    struct mem_plan plan = {.take = false};
    lane_array(width, height, count, &plan);
    return plan.bytes;
}

int replicas_that_fit(int width, int height, int count)
{
    while (count > 1 && one_lane(width, height, count) > REPLICAS_BYTES)
        count /= 2;
    return count;
}

static bool has_lanes(int width, int height, int count, int threads)
{
    return one_lane(width, height, count) * threads <= REPLICAS_LANE_BYTES;
}

double replicas_bytes(int width, int height, int count, int threads, bool lanes)
{
    count = replicas_that_fit(width, height, count);
    lanes = lanes && has_lanes(width, height, count, threads);
    return one_lane(width, height, count) * (lanes ? threads : 1);
}

struct replicas *replicas_create(int width, int height, int count, int threads,
                                 bool lanes)
{
    struct replicas *r = mem_alloc(1, sizeof *r);
    *r = (struct replicas){width, height, replicas_that_fit(width, height, count), NULL,
                           threads};
    struct mem_plan take = {.take = true};
    lanes = lanes && has_lanes(width, height, r->count, threads);
    r->lanes = mem_aligned(MEM_APART, (size_t)threads, sizeof *r->lanes);
    for (int i = 0; i < threads; i++) {
        r->lanes[i].shared = !lanes && threads > 1;
        r->lanes[i].sums = lanes || i == 0 ? lane_array(width, height, r->count, &take)
                                           : r->lanes[0].sums;
    }
    return r;
}

void replicas_destroy(struct replicas *r)
{
    if (!r)
        return;
    for (int i = 0; i < r->threads; i++)
        if (i == 0 || !r->lanes[i].shared)
            mem_free(r->lanes[i].sums);
    mem_free(r->lanes);
    mem_free(r);
}

/* Hashes the bits to a uniform number in [0,1): two rounds of multiplication by odd
 * constants and xor with the upper bits. */
static double hash_to_uniform(uint64_t bits)
{
    bits *= 0xd1342543de82ef95;
    bits ^= bits >> 32;
    bits *= 0x9e3779b97f4a7c15;
    bits ^= bits >> 29;
    return (double)(bits >> 11) * 0x1p-53;
}

double replica_clamp_or_round(int64_t at, double steps, uint64_t random_bits)
{
    if (isnan(steps))
        return 0.0;
    if (fabs(steps) > REPLICAS_LIMIT)
        return copysign(REPLICAS_LIMIT, steps);
    return floor(steps + hash_to_uniform(random_bits +
                                         ((uint64_t)at << 1 | 1) * 0xbf58476d1ce4e5b9));
}

void replica_flush(struct replica_lane *lane)
{
    for (int i = 0; i < lane->pending_count; i++) {
        int64_t *sum = &lane->sums[lane->pending[i].at - lane->base];
        if (lane->shared)
            __atomic_fetch_add(sum, lane->pending[i].steps, __ATOMIC_RELAXED);
        else
            *sum += lane->pending[i].steps;
    }
    lane->pending_count = 0;
}

double replicas_value(const struct replicas *r, int replica, long pixel)
{
    int64_t sum = 0;
    long at = (long)replica * r->width * r->height + pixel;
    for (int i = 0; i < r->threads; i++)
        if (i == 0 || !r->lanes[i].shared)
            sum += r->lanes[i].sums[at];
    return (double)sum / REPLICAS_ONE;
}

/* All splats of a bin (an octave) count as equally bright: only ratios of sums are
 * needed. */
double replicas_top(const struct replicas *r, double share)
{
    double splats[REPLICAS_BINS] = {0.0}, count = 0.0, all = 0.0, top = 0.0;
    for (int bin = 0; bin < REPLICAS_BINS; bin++) {
        for (int i = 0; i < r->threads; i++)
            splats[bin] += (double)r->lanes[i].splats[bin];
        count += splats[bin];
        all += ldexp(splats[bin], bin);
    }
    double left = share * count;
    for (int bin = REPLICAS_BINS - 1; bin >= 0 && left > 0.0; bin--) {
        double taken = fmin(left, splats[bin]);
        top += ldexp(taken, bin);
        left -= taken;
    }
    return all > 0.0 ? top / all : (double)NAN;
}

/* Number of sums that a lane owns. */
static size_t own_sums(const struct replicas *r, int lane)
{
    size_t sums = (size_t)r->width * (size_t)r->height * (size_t)r->count;
    return lane == 0 || !r->lanes[lane].shared ? sums : 0;
}

static void empty_splats(struct replica_lane *into, struct replica_lane *lane)
{
    for (int i = 0; i < REPLICAS_BINS; i++) {
        into->splats[i] += lane->splats[i];
        lane->splats[i] = 0;
    }
}

static void empty_into(struct replica_lane *into, struct replica_lane *lane, size_t sums)
{
    for (size_t i = 0; i < sums; i++) {
        into->sums[i] += lane->sums[i];
        lane->sums[i] = 0;
    }
    empty_splats(into, lane);
}

struct move {
    int64_t *into;
    const struct replicas *from;
};

static void move_row(void *ctx, long y, int thread)
{
    const struct move *move = ctx;
    const struct replicas *from = move->from;
    long begin = y * from->width;
    (void)thread;
    for (int lane = 0; lane < from->threads; lane++)
        for (long i = begin; own_sums(from, lane) > 0 && i < begin + from->width; i++) {
            move->into[i] += from->lanes[lane].sums[i];
            from->lanes[lane].sums[i] = 0;
        }
}

void replicas_move(struct replicas *into, int replica, struct replicas *from)
{
    long pixels = (long)into->width * into->height;
    struct move move = {into->lanes[0].sums + replica * pixels, from};
    assert(from->count == 1 && into->threads == 1);
    par_for(into->height, from->threads, move_row, &move);
    for (int i = 0; i < from->threads; i++)
        empty_splats(&into->lanes[0], &from->lanes[i]);
}

void replicas_clear(struct replicas *r)
{
    for (int i = 0; i < r->threads; i++) {
        memset(r->lanes[i].sums, 0, own_sums(r, i) * sizeof *r->lanes[i].sums);
        memset(r->lanes[i].splats, 0, sizeof r->lanes[i].splats);
    }
}

void replicas_scale(struct replicas *r, int replica, double factor)
{
    size_t pixels = (size_t)r->width * (size_t)r->height;
    size_t begin = replica < 0 ? 0 : (size_t)replica * pixels;
    size_t end = replica < 0 ? (size_t)r->count * pixels : begin + pixels;
    for (size_t i = begin; i < end; i++)
        r->lanes[0].sums[i] = (int64_t)rint((double)r->lanes[0].sums[i] * factor);
}

void replicas_pack(struct pack *pack, struct replicas *r)
{
    struct replica_lane *first = &r->lanes[0];
    for (int i = 1; i < r->threads; i++)
        empty_into(first, &r->lanes[i], own_sums(r, i));
    pack_sum_int64s(pack, "replicas", first->sums, own_sums(r, 0));
    pack_sum_int64s(pack, "splats", first->splats, REPLICAS_BINS);
}

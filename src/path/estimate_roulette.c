#include "path/estimate_roulette.h"

#include "base/mem.h"
#include "path/estimate.h"

/* All (s,t) with s >= 1, t >= 1 and s + t <= max_depth + 1. */
static size_t roulette_bytes(int max_depth)
{
    size_t most = (size_t)max_depth * ((size_t)max_depth + 1) / 2;
    return sizeof(struct roulette) + most * sizeof(struct pending);
}

void estimate_bdpt_roulette(struct subpaths *paths, double rays)
{
    paths->roulette = mem_aligned(MEM_APART, 1, roulette_bytes(paths->max_depth));
    paths->roulette->rays = rays;
}

double estimate_roulette_bytes(int max_depth)
{
    return (double)roulette_bytes(max_depth);
}

void roulette_add(struct roulette *roulette, const struct connection *x, int s, int t,
                  const struct ray_endpoint *y)
{
    double size = rgb_luminance(x->value) * x->weight;
    roulette->pending[roulette->count++] = (struct pending){*x, size, 1.0, s, t, *y};
}

void roulette_choose(struct roulette *roulette, double certain, struct ustream *connect)
{
    double sum = certain;
    int count = roulette->count, kept = 0;
    for (int i = 0; i < count; i++)
        sum += roulette->pending[i].size;
    /* A sum that is not finite is for contrib_add to count, so all are tested. */
    if (count <= roulette->rays || !(sum < HUGE_VAL))
        return;
    double place = *ustream_take(connect, DIMS_ROULETTE, 1), least = sum / roulette->rays;
    for (int i = 0; i < count; i++) {
        struct pending *p = &roulette->pending[i];
        if (p->size < least) {
            p->chance = p->size / least;
            place += p->chance;
            if (place < 1.0)
                continue;
            place -= 1.0;
        }
        if (kept != i)
            roulette->pending[kept] = *p;
        kept++;
    }
    roulette->count = kept;
}

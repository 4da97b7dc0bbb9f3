#include "integrator/markov/sink_set.h"

/* --- films ------------------------------------------------------------------------ */

static void add_to_film(const struct splat_sink *self, const struct contrib *splats,
                        double weight, uint64_t random_bits)
{
    const struct film_sink *s = (const struct film_sink *)self;
    double scaled = weight * s->scale;
    (void)random_bits;
    for (int i = 0; i < splats->count; i++)
        film_splat(s->film, splats->splats[i].pixel, splats->splats[i].value, scaled);
}

static void prefetch_in_film(const struct splat_sink *self, const struct contrib *splats)
{
    const struct film_sink *s = (const struct film_sink *)self;
    for (int i = 0; i < splats->count; i++)
        film_prefetch(s->film, splats->splats[i].pixel);
}

struct film_sink film_sink_of(struct film *film, double scale)
{
    return (struct film_sink){{add_to_film, prefetch_in_film}, film, scale};
}

/* --- failures --------------------------------------------------------------------- */

static bool pixel_seen(const struct contrib *splats, int count, int pixel)
{
    for (int i = 0; i < count; i++)
        if (splats->splats[i].pixel == pixel)
            return true;
    return false;
}

static void add_failure(const struct splat_sink *self, const struct contrib *splats,
                        double weight, uint64_t random_bits)
{
    const struct failure_sink *s = (const struct failure_sink *)self;
    struct rgb value = rgb(weight, 1.0, 0.0);
    (void)random_bits;
    for (int i = 0; i < splats->count; i++)
        if (!pixel_seen(splats, i, splats->splats[i].pixel))
            film_splat(s->film, splats->splats[i].pixel, value, 1.0);
}

struct failure_sink failure_sink_of(struct film *film)
{
    return (struct failure_sink){{add_failure, NULL}, film};
}

/* --- replicas --------------------------------------------------------------------- */

static void add_to_replica(const struct replica_sink *s, const struct contrib *splats,
                           int64_t first, double factor, uint64_t random_bits)
{
    for (int i = 0; i < splats->count; i++)
        replica_add(s->lane, first + splats->splats[i].pixel,
                    rgb_luminance(splats->splats[i].value) * factor, random_bits);
}

/* The replicas' pixels are not prefetched: measured, that is slower. */
static void add_states(const struct splat_sink *self, const struct contrib *splats,
                       double weight, uint64_t random_bits)
{
    const struct replica_sink *s = (const struct replica_sink *)self;
    for (int i = 0; i < s->count; i++)
        add_to_replica(s, splats, s->shares[i].first,
                       weight * s->shares[i].states * REPLICAS_ONE, random_bits);
    replica_count_brightness(s->lane, splats->target * weight * s->scale);
}

static void add_large(const struct splat_sink *self, const struct contrib *splats,
                      double weight, uint64_t random_bits)
{
    const struct replica_sink *s = (const struct replica_sink *)self;
    for (int i = 0; i < s->count; i++)
        add_to_replica(s, splats, s->shares[i].first,
                       weight * s->shares[i].large * REPLICAS_ONE, random_bits);
    replica_count_brightness(s->lane, splats->target * weight * s->scale);
}

struct replica_sink replica_sink_of_states(struct replica_lane *lane,
                                           const struct replica_share *shares, int count,
                                           double scale)
{
    return (struct replica_sink){{add_states, NULL}, lane, shares, count, scale};
}

struct replica_sink replica_sink_of_large(struct replica_lane *lane,
                                          const struct replica_share *shares, int count,
                                          double scale)
{
    return (struct replica_sink){{add_large, NULL}, lane, shares, count, scale};
}

/* --- tiles ------------------------------------------------------------------------ */

static void add_to_tiles(const struct splat_sink *self, const struct contrib *splats,
                         double weight, uint64_t random_bits)
{
    const struct tile_sink *s = (const struct tile_sink *)self;
    (void)weight;
    (void)random_bits;
    for (int i = 0; i < splats->count; i++)
        s->sums[s->tile_of[splats->splats[i].pixel]] += rgb_luminance(
            splats->splats[i].value);
}

struct tile_sink tile_sink_of(double *sums, const uint16_t *tile_of)
{
    return (struct tile_sink){{add_to_tiles, NULL}, sums, tile_of};
}

/* --- the rest of a split ---------------------------------------------------------- */

static void add_rest(const struct splat_sink *self, const struct contrib *splats,
                     double weight, uint64_t random_bits)
{
    const struct rest_sink *s = (const struct rest_sink *)self;
    (void)weight;
    for (int i = 0; i < 2 && s->to[i]; i++)
        s->to[i]->add(s->to[i], splats, splats->rest * s->weight, random_bits);
}

struct rest_sink rest_sink_of(double weight, const struct splat_sink *first,
                              const struct splat_sink *second)
{
    return (struct rest_sink){{add_rest, NULL}, weight, {first, second}};
}

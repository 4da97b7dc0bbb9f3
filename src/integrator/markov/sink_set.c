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

/* --- classes of light ------------------------------------------------------------- */

static void add_to_classes(const struct splat_sink *self, const struct contrib *splats,
                           double weight, uint64_t random_bits)
{
    const struct class_sink *s = (const struct class_sink *)self;
    (void)random_bits;
    for (int i = 0; i < splats->count; i++) {
        const struct splat *splat = &splats->splats[i];
        int class = light_class(s->classes, splat->s, splat->t);
        if (class >= 0)
            film_splat(s->films[class], splat->pixel, splat->value, weight * s->scale);
    }
}

struct class_sink class_sink_of(const struct light_classes *classes,
                                struct film *const *films, double scale)
{
    return (struct class_sink){{add_to_classes, NULL}, classes, films, scale};
}

/* --- steps ------------------------------------------------------------------------ */

static void add_to_maps(const struct map_sink *s, int pixel, double share,
                        const struct step_event *event)
{
    double failed = event->failed, first = event->first;
    if (s->all)
        film_splat(s->all, pixel, rgb(first * failed, first, event->work), share);
    if (!s->small || !event->first || move_keeps_path(event->move))
        return;
    film_splat(event->move == MOVE_LARGE ? s->large : s->small, pixel,
               rgb(event->acceptance, 1.0, 0.0), share);
}

/* A state with several splats counts at each pixel by its share of the luminance, so that
 * every proposal counts once in all. */
static void add_step(const struct step_sink *self, const struct contrib *current,
                     const struct step_event *event)
{
    const struct map_sink *s = (const struct map_sink *)self;
    double sum = 0.0;
    for (int i = 0; i < current->count; i++)
        sum += rgb_luminance(current->splats[i].value);
    for (int i = 0; i < current->count && sum > 0.0; i++)
        add_to_maps(s, current->splats[i].pixel,
                    rgb_luminance(current->splats[i].value) / sum, event);
}

struct map_sink map_sink_of(struct film *all, struct film *small, struct film *large,
                            bool counts_work)
{
    return (struct map_sink){{add_step, counts_work}, all, small, large};
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
    for (int i = 0; i < REST_SINKS; i++)
        if (s->to[i])

            s->to[i]->add(s->to[i], splats, splats->rest * s->weight, random_bits);
}

struct rest_sink rest_sink_of(double weight, const struct splat_sink *film,
                              const struct splat_sink *replica,
                              const struct splat_sink *classes)
{
    return (struct rest_sink){{add_rest, NULL}, weight, {film, replica, classes}};
}

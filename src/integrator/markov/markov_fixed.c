/* With N pixels, C chains, D mutations each, and the bootstrap's b of a length and b0 of
 * the whole, the picture is N b0 / (C D) times the sum of films of one length times b C /
 * (b0 c), c the chains of that length, the film shared by lengths times C / c, c their
 * chains, the film of large steps. The factors are rounded to 2^-16. */

#include "integrator/markov/markov_fixed.h"

#include "integrator/markov/markov_group.h"
#include "integrator/markov/markov_state.h"

#define WEIGHT_BITS 16

static void add_film(const struct film *film, long pixel, double factor,
                     exact_sum sums[FIXED_SUMS])
{
    int64_t weight = (int64_t)rint(ldexp(factor, WEIGHT_BITS));
    for (int i = 0; i < 3; i++)
        sums[i] = exact_add(sums[i],
                            exact_times(film_exact(film, (int)pixel, i), weight));
}

static void add(const void *self, long pixel, exact_sum sums[FIXED_SUMS])
{
    const struct markov *m = self;
    for (int i = 0; m->done > 0 && i < m->group_count; i++) {
        const struct group *group = &m->groups[i];
        double factor = fmin(group->bootstrap.b / m->b0, 1.0) * m->chain_count;
        if (!group->shares)
            add_film(group->film, pixel, factor / group->chain_count, sums);
    }
    if (m->films.shared)
        add_film(m->films.shared, pixel, (double)m->chain_count / m->films.shared_chains,
                 sums);
    if (m->films.large)
        add_film(m->films.large, pixel, 1.0, sums);
    if (m->direct)
        passes_add_fixed(m->direct, pixel, sums + 3);
}

void markov_fixed_picture(void *self, struct fixed_picture *out)
{
    struct markov *m = self;
    struct fixed_picture plain = {.self = NULL};
    if (m->direct)
        passes_fixed_picture(m->direct, &plain);
    double made = (double)m->done * m->chain_count;
    double scale = made > 0.0 ? markov_pixels(m) * m->b0 / made : 0.0;
    *out = (struct fixed_picture){
        .self = m,
        .add = add,
        .scales = {ldexp(scale, -WEIGHT_BITS) * m->scene->emission_scale,
                   plain.scales[0]},
        .count = m->direct ? 6 : 3,
    };
}

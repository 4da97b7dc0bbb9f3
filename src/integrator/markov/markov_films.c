/* The films of a run of chains: which path lengths have a film of their own, and the
 * memory of all films.
 *
 * If films for all lengths would take too much memory, only some lengths have a film and
 * the rest share one, so that the memory is bounded for any depth. A film of one length
 * is multiplied by its b at the end. In a shared film each length must be weighted when
 * it is splatted, by its fixed_b, and the film as a whole is normalised at the end: with
 * D mutations a chain in all, d of them in a round with fixed brightness b(k), C chains
 * that share, N pixels, the shared lengths' picture is
 *
 *     N (sum over k of b) / (C sum over rounds of d sum over k of b(k)) film,
 *
 * film being of splats times b(k) C / n, n the chains of length k. The lengths' sum has
 * the b of the whole run, but their parts of it keep the error that b(k) has at the end
 * of the start: it falls as the start, a share of the budget, grows. A b(k) that is
 * refined with every round would have to be known to all parts of a run (base/part.h) at
 * once. */

#include "integrator/markov/markov_films.h"

#include "base/mem.h"
#include "integrator/markov/markov_group.h"
#include "integrator/markov/markov_state.h"

/* Memory for the films of all lengths. If they would take more, only as many lengths as
 * fit have their own, the brightest first. */
#define FILMS_BYTES 0x1p30
#define OWN_FILMS   12

static double one_film(const struct markov *m)
{
    return film_bytes(m->scene->camera.width, m->scene->camera.height);
}

static double films_limit(const struct markov *m)
{
    return m->settings->memory_limit > 0.0 ? m->settings->memory_limit : FILMS_BYTES;
}

/* A step that excludes proposals needs a film for each length. Classes of light have
 * films of their own, which are multiplied by the length's b in the end; so has the
 * length, then, or the classes would not sum to it. */
static bool some_share(const struct markov *m)
{
    return !m->design.step->excludes && m->films.light.count == 0 &&
           one_film(m) * m->group_count > films_limit(m);
}

/* Number of films of groups, the shared one included. */
static int count_films(const struct markov *m)
{
    int own = (int)fmax(fmin(films_limit(m) / one_film(m), OWN_FILMS), 1.0);
    return some_share(m) && own + 1 < m->group_count ? own + 1 : m->group_count;
}

/* Number of groups that are brighter; of equals the first counts as brighter. */
static int rank_of(const struct markov *m, const struct group *group)
{
    int rank = 0;
    for (const struct group *g = m->groups; g < m->groups + m->group_count; g++)
        rank += g->bootstrap.b > group->bootstrap.b ||
                (g < group && g->bootstrap.b >= group->bootstrap.b);
    return rank;
}

static bool is_kelemen(const struct markov *m)
{
    return settings_estimator(m->settings) == ESTIMATOR_KELEMEN;
}

static bool maps_steps(const struct markov *m)
{
    return m->design.failure_map ||
           (m->settings->layers & (LAYER_FAILURES | LAYER_WORK | LAYER_VISITS)) != 0;
}

static bool maps_acceptance(const struct markov *m)
{
    return (m->settings->layers & LAYER_ACCEPTANCE) != 0;
}

static int count_classes(const struct markov *m)
{
    return (1 + is_kelemen(m)) * m->films.light.count;
}

/* Number of all films: of groups, of large steps, and of layers. */
static int count_all(const struct markov *m)
{
    return count_films(m) + is_kelemen(m) + maps_steps(m) + 2 * maps_acceptance(m) +
           count_classes(m);
}

void markov_films_create(struct markov *m)
{
    const struct camera *camera = &m->scene->camera;
    light_classes_init(&m->films.light, m->settings, m->design.depth);
    m->films.count = count_all(m);
    for (int i = 0; i < m->films.count; i++)
        m->films.all[i] = film_create(camera->width, camera->height);
    /* Lanes for all films or for none: each lane takes the memory of a film for every
     * thread. Those of classes of light, the last, are many and have none. */
    int with_lanes = m->films.count - count_classes(m);
    for (int i = 0; i < with_lanes; i++)
        film_add_lanes(m->films.all[i], m->threads, FILM_LANES_BYTES / with_lanes);
}

static void assign_layers(struct markov *m, int next)
{
    struct markov_films *f = &m->films;
    if (maps_steps(m))
        f->steps = f->all[next++];
    if (maps_acceptance(m)) {
        f->small_steps = f->all[next++];
        f->large_steps = f->all[next++];
    }
    for (int i = 0; i < f->light.count; i++) {
        f->class_states[i] = f->all[next++];
        if (is_kelemen(m))
            f->class_large[i] = f->all[next++];
    }
}

void markov_films_assign(struct markov *m)
{
    int films = count_films(m), next = 0;
    for (int i = 0; i < m->group_count; i++) {
        struct group *group = &m->groups[i];
        group->shares = films < m->group_count && rank_of(m, group) + 1 >= films;
        if (!group->shares) {
            group->film = m->films.all[next++];
            continue;
        }
        if (m->films.shared == NULL)
            m->films.shared = m->films.all[next++];
        group->film = m->films.shared;
        m->films.shared_chains += group->chain_count;
    }
    if (is_kelemen(m))
        m->films.large = m->films.all[next++];
    assign_layers(m, next);
}

void markov_set_shared_weights(struct markov *m)
{
    for (int i = 0; m->films.shared && i < m->group_count; i++) {
        struct group *group = &m->groups[i];
        if (group->shares)
            group->states_scale = group->fixed_b / m->b0 * m->films.shared_chains /
                                  group->chain_count;
    }
}

/* Sum over mutations of the group's brightness at their time, see fixed_light, as a mean
 * over the group's chains, of what is in the films. */
static double light_in_films(const struct markov *m, const struct group *group)
{
    double start = (double)m->rounds.start_done, own = 0.0;
    double light = group->fixed_light - ((double)m->done - start) * group->fixed_b;
    if (!m->missing)
        return group->fixed_light;
    for (int j = 0; j < group->chain_count; j++)
        own += markov_main_in_films(m, group->first_chain + j);
    return (start > 0.0 ? light * markov_start_in_films(m) / start : 0.0) +
           own * group->fixed_b / group->chain_count;
}

double markov_shared_factor(const struct markov *m)
{
    double light = 0.0, variance;
    for (int i = 0; i < m->group_count; i++) {
        const struct group *group = &m->groups[i];
        if (group->shares && group_brightness(m, group, &variance) > 0.0)
            light += light_in_films(m, group);
    }
    return light > 0.0 ? m->b0 * markov_pixels(m) / (light * m->films.shared_chains)
                       : 0.0;
}

void markov_films_memory(struct markov *m, struct run_memory *out)
{
    light_classes_init(&m->films.light, m->settings, m->design.depth);
    int width = m->scene->camera.width, height = m->scene->camera.height;
    int films = count_all(m), with_lanes = films - count_classes(m);
    double lanes = film_lanes_bytes(width, height, m->threads);
    out->rare += films * film_rare_bytes(width, height);
    out->films += films * one_film(m);
    if (lanes * with_lanes <= FILM_LANES_BYTES)
        out->films += with_lanes * lanes;
}

#include "integrator/markov.h"

#include "base/clock.h"
#include "base/mem.h"
#include "base/par.h"
#include "math/accum.h"

#include <float.h>
#include <stdio.h>

#define START_P_LARGE 0.5
#define START_LOOKS   5

/* A round is short enough that no pixel of the film can overflow between two folds: one
 * mutation adds at most 1/.0722 (a blue path's channel over its luminance) units. */
#define ROUND_MUTATIONS 64
#define FOLD_MUTATIONS  0x1p22

enum phase { PHASE_BOOTSTRAP, PHASE_START, PHASE_MAIN };

struct markov {
    const struct scene *scene;
    const struct settings *settings;
    struct markov_design design;
    int threads, chain_count;
    struct target *targets; /* [threads] */
    struct chain *chains;   /* [chain_count] */
    struct bootstrap bootstrap;
    struct welford independent; /* targets of the bootstrap */
    struct chain_films films;
    struct chain_params params;
    enum phase phase;
    long round;           /* mutations a chain in a full round */
    long this_round;      /* and in the one that runs */
    long budget;          /* mutations a chain, 0 if the clock decides */
    long done;            /* mutations a chain so far */
    long start_until;     /* the measured start ends here, in mutations a chain */
    double start_until_s; /* and here, in seconds, if the clock decides */
    double unfolded;      /* mutations since the last fold */
    int looks;
    struct tally *start_tallies; /* [chain_count], at the end of the start */
    struct plarge plarge;
    double seconds_startup;
};

static double pixel_count(const struct markov *m)
{
    return (double)m->films.chain->width * (double)m->films.chain->height;
}

static void plan_budget(struct markov *m)
{
    const struct settings *s = m->settings;
    m->round = (long)(0x1p21 / m->chain_count);
    m->round = m->round < 1 ? 1 : m->round > ROUND_MUTATIONS ? ROUND_MUTATIONS : m->round;
    m->start_until = s->start_mutations;
    if (s->seconds > 0.0) {
        m->start_until_s = s->start * s->seconds;
        return;
    }
    /* The mutations per pixel that a run reports shall give that run again: rounding must
     * not make one mutation more of it. */
    double exact = s->mutations_per_pixel * pixel_count(m) / m->chain_count;
    double budget = ceil(exact * (1.0 - 4.0 * DBL_EPSILON));
    m->budget = (long)fmin(budget, 0x1p62);
    double share = s->start * (double)m->budget, cap = s->start_cap * (double)m->budget;
    double start = fmin(fmax(share, (double)s->start_mutations), cap);
    m->start_until = (long)fmax(ceil(start), 1.0);
}

struct markov *markov_create(const struct scene *scene, const struct settings *settings,
                             const struct markov_design *design)
{
    struct markov *m = mem_alloc(1, sizeof *m);
    const struct camera *camera = &scene->camera;
    struct kernel kernel;
    m->scene = scene;
    m->settings = settings;
    m->design = *design;
    m->threads = settings_threads(settings);
    m->chain_count = (int)settings->chains;
    m->targets = mem_alloc((size_t)m->threads, sizeof *m->targets);
    for (int i = 0; i < m->threads; i++)
        m->targets[i] = design->target_create(scene, settings);
    kernel_init(&kernel, settings->kernel, settings->sigma, settings->s1, settings->s2);
    m->chains = mem_aligned(64, (size_t)m->chain_count, sizeof *m->chains);
    for (int i = 0; i < m->chain_count; i++)
        chain_init(&m->chains[i], design->capacity, design->max_splats, &kernel);
    m->start_tallies = mem_alloc((size_t)m->chain_count, sizeof *m->start_tallies);
    m->films.chain = film_create(camera->width, camera->height);
    if (settings->estimator == ESTIMATOR_KELEMEN)
        m->films.large = film_create(camera->width, camera->height);
    film_add_lanes(m->films.chain, m->threads);
    if (m->films.large)
        film_add_lanes(m->films.large, m->threads);
    m->params.estimator = settings->estimator;
    m->params.chain_scale = m->params.large_scale = 1.0;
    m->params.p_large = settings_auto(settings) ? START_P_LARGE : settings->p_large;
    m->plarge = (struct plarge){.p_l = m->params.p_large, .p_l_hi = 1.0};
    plan_budget(m);
    return m;
}

void markov_destroy(void *self)
{
    struct markov *m = self;
    for (int i = 0; i < m->chain_count; i++)
        chain_deinit(&m->chains[i]);
    for (int i = 0; i < m->threads; i++)
        m->design.target_destroy(&m->targets[i]);
    bootstrap_deinit(&m->bootstrap);
    film_destroy(m->films.chain);
    film_destroy(m->films.large);
    mem_free(m->start_tallies);
    mem_free(m->chains);
    mem_free(m->targets);
    mem_free(m);
}

/* --- bootstrap and seeds ---------------------------------------------------------- */

struct seeding {
    struct markov *m;
    const long *seeds;
};

static void seed_one(void *ctx, long index, int thread)
{
    struct seeding *s = ctx;
    struct markov *m = s->m;
    chain_seed(&m->chains[index], &m->targets[thread], (uint64_t)m->settings->seed,
               (uint64_t)s->seeds[index], (uint64_t)index);
}

static void manual_plarge(struct markov *m)
{
    m->plarge = (struct plarge){.p_l = m->settings->p_large,
                                .p_l_lo = m->settings->p_large,
                                .p_l_hi = m->settings->p_large};
    snprintf(m->plarge.reason, sizeof m->plarge.reason, "p_l = %g was given",
             m->settings->p_large);
}

static void no_light_found(struct markov *m)
{
    struct statistics none = {.large = m->bootstrap.count};
    if (settings_auto(m->settings))
        m->plarge = plarge_zsolnai2013(&none);
    else
        manual_plarge(m);
    m->phase = PHASE_MAIN;
    m->budget = -1;
}

static void bootstrap(struct markov *m)
{
    uint64_t seed = (uint64_t)m->settings->seed;
    bootstrap_run(&m->bootstrap, m->settings->bootstrap, seed, m->design.max_splats,
                  m->targets, m->threads);
    for (long i = 0; i < m->bootstrap.count; i++)
        welford_add(&m->independent, m->bootstrap.targets[i]);
    m->params.b0 = m->bootstrap.b;
    if (!(m->bootstrap.b > 0.0)) {
        no_light_found(m);
        return;
    }
    struct rng rng;
    rng_init(&rng, seed, RNG_SELECT, 0);
    long *seeds = mem_alloc((size_t)m->chain_count, sizeof *seeds);
    bootstrap_select(&m->bootstrap, rng_double(&rng), seeds, m->chain_count);
    par_for(m->chain_count, m->threads, seed_one, &(struct seeding){m, seeds});
    mem_free(seeds);
    m->phase = PHASE_START;
}

/* --- rounds ----------------------------------------------------------------------- */

static void advance_one(void *ctx, long index, int thread)
{
    struct markov *m = ctx;
    struct chain *chain = &m->chains[index];
    struct chain_films films = {
        .chain = film_lane(m->films.chain, thread),
        .large = m->films.large ? film_lane(m->films.large, thread) : NULL,
    };
    m->design.step->advance(chain, &m->params, &m->targets[thread], &films,
                            m->this_round);
    chain_flush(chain, &m->params, &films);
}

static void fold(struct markov *m)
{
    film_fold(m->films.chain, m->threads);
    if (m->films.large)
        film_fold(m->films.large, m->threads);
    m->unfolded = 0.0;
}

static void run_round(struct markov *m, long until)
{
    long left = until - m->done;
    m->this_round = until > 0 && left < m->round ? left : m->round;
    if (m->this_round < 1)
        return;
    double mutations = (double)m->this_round * m->chain_count;
    if (m->unfolded + mutations > FOLD_MUTATIONS)
        fold(m);
    par_for(m->chain_count, m->threads, advance_one, m);
    m->done += m->this_round;
    m->unfolded += mutations;
}

static void copy_tallies(const struct markov *m, struct tally *out)
{
    for (int i = 0; i < m->chain_count; i++)
        out[i] = m->chains[i].tally;
}

/* Whether the measured start has the length that was asked for. */
static bool start_complete(const struct markov *m, double seconds)
{
    const struct settings *s = m->settings;
    if (s->seconds <= 0.0)
        return m->done >= m->start_until;
    return seconds >= s->start_cap * s->seconds ||
           (m->done >= m->start_until && seconds >= m->start_until_s);
}

/* Doubles the start while the branch of the rule is unsure; false at a limit. */
static bool start_longer(struct markov *m, double seconds)
{
    const struct settings *s = m->settings;
    if (m->looks >= START_LOOKS)
        return false;
    if (s->seconds > 0.0) {
        double cap = s->start_cap * s->seconds;
        m->start_until_s = fmin(2.0 * seconds, cap);
        m->start_until = 2 * m->done;
        return seconds < cap;
    }
    long cap = (long)(s->start_cap * (double)m->budget);
    m->start_until = 2 * m->done < cap ? 2 * m->done : cap;
    return m->start_until > m->done;
}

static void decide(struct markov *m, double seconds)
{
    struct statistics s;
    copy_tallies(m, m->start_tallies);
    statistics_measure(m->start_tallies, m->chain_count, &s);
    m->looks++;
    if (!settings_auto(m->settings)) {
        manual_plarge(m);
        m->phase = PHASE_MAIN;
        return;
    }
    m->plarge = plarge_zsolnai2013(&s);
    if (m->plarge.unsure && start_longer(m, seconds))
        return;
    m->params.p_large = m->plarge.p_l;
    m->phase = PHASE_MAIN;
}

static void startup_round(struct markov *m, const struct round_limits *limits)
{
    double begin = clock_wall();
    if (m->phase == PHASE_BOOTSTRAP) {
        bootstrap(m);
    } else {
        run_round(m, m->settings->seconds > 0.0 ? 0 : m->start_until);
        double seconds = limits->seconds_used + clock_wall() - begin;
        if (start_complete(m, seconds))
            decide(m, seconds);
    }
    m->seconds_startup += clock_wall() - begin;
}

bool markov_advance(void *self, const struct round_limits *limits)
{
    struct markov *m = self;
    if (m->phase != PHASE_MAIN)
        startup_round(m, limits);
    else
        run_round(m, m->budget);
    return m->budget == 0 || m->done < m->budget;
}

bool markov_started(const void *self)
{
    const struct markov *m = self;
    return m->phase == PHASE_MAIN;
}

double markov_progress(const void *self)
{
    const struct markov *m = self;
    return m->budget > 0 ? (double)m->done / (double)m->budget : 0.0;
}

/* --- results ---------------------------------------------------------------------- */

static struct tally all_tallies(const struct markov *m)
{
    struct tally sum = {0};
    for (int i = 0; i < m->chain_count; i++)
        tally_add(&sum, &m->chains[i].tally);
    return sum;
}

/* b from all independent paths: bootstrap and large steps. */
static void brightness(const struct markov *m, const struct tally *all, double *b,
                       double *b_se)
{
    const struct welford *boot = &m->independent;
    double n = boot->count + (double)all->proposed[MOVE_LARGE];
    double squares = boot->m2 + boot->mean * boot->mean * boot->count +
                     all->large_sum_squares;
    *b = n > 0.0 ? (boot->mean * boot->count + all->large_sum) / n : 0.0;
    double variance = n > 1.0 ? (squares - n * *b * *b) / (n - 1.0) : 0.0;
    *b_se = n > 1.0 ? sqrt(fmax(variance, 0.0) / n) : 0.0;
}

void markov_picture(void *self, struct image *out)
{
    struct markov *m = self;
    struct tally all = all_tallies(m);
    double b, b_se, mutations = (double)m->done * m->chain_count;
    long pixels = (long)pixel_count(m);
    brightness(m, &all, &b, &b_se);
    fold(m);
    double scale = mutations > 0.0 ? (double)pixels / mutations * m->scene->emission_scale
                                   : 0.0;
    for (long i = 0; i < pixels; i++) {
        struct rgb v = rgb_scale(film_value(m->films.chain, (int)i), b);
        if (m->films.large)
            v = rgb_add(v, rgb_scale(film_value(m->films.large, (int)i), m->params.b0));
        v = rgb_scale(v, scale);
        out->pixels[3 * i] = (float)v.r;
        out->pixels[3 * i + 1] = (float)v.g;
        out->pixels[3 * i + 2] = (float)v.b;
    }
}

static double ratio(double a, double b)
{
    return b > 0.0 ? a / b : (double)NAN;
}

static void chain_figures(const struct markov *m, struct run_statistics *out)
{
    out->nonfinite = (double)m->bootstrap.nonfinite;
    out->saturated = (double)m->films.chain->saturated;
    if (m->films.large)
        out->saturated += (double)m->films.large->saturated;
    for (int i = 0; i < m->chain_count; i++) {
        const struct chain *c = &m->chains[i];
        out->nonfinite += (double)(c->states[0].nonfinite + c->states[1].nonfinite);
        out->longest_stay = fmax(out->longest_stay, (double)c->longest_stay);
        out->chains_never_moved +=
            c->tally.accepted[MOVE_SMALL] + c->tally.accepted[MOVE_LARGE] == 0;
    }
}

void markov_statistics(const void *self, struct run_statistics *out)
{
    const struct markov *m = self;
    struct tally all = all_tallies(m),
                 *now = mem_alloc((size_t)m->chain_count, sizeof *now);
    double proposed = (double)all.proposed[MOVE_SMALL] + (double)all.proposed[MOVE_LARGE];
    double accepted = (double)all.accepted[MOVE_SMALL] + (double)all.accepted[MOVE_LARGE];
    double nonzero = (double)all.nonzero[MOVE_SMALL] + (double)all.nonzero[MOVE_LARGE];
    copy_tallies(m, now);
    /* A run that ended during the start has measured all the same. */
    const struct tally *start = m->phase == PHASE_MAIN ? m->start_tallies : now;
    *out = (struct run_statistics){
        .paths = (double)m->done * m->chain_count,
        .bootstrap_paths = (double)m->bootstrap.count,
        .plarge = m->plarge,
        .plarge_auto = settings_auto(m->settings),
        .start_looks = m->looks,
        .start_mutations = (double)start[0].proposed[MOVE_SMALL] +
                           (double)start[0].proposed[MOVE_LARGE],
        .seconds_startup = m->seconds_startup,
        .acceptance = ratio(accepted, proposed),
        .failure_rate = ratio(proposed - nonzero, proposed),
    };
    out->start_mutations *= m->chain_count;
    statistics_measure(start, m->chain_count, &out->start);
    statistics_measure(now, m->chain_count, &out->whole);
    brightness(m, &all, &out->b, &out->b_se);
    out->b *= m->scene->emission_scale;
    out->b_se *= m->scene->emission_scale;
    chain_figures(m, out);
    mem_free(now);
}

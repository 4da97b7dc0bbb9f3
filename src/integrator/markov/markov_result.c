/* The results of a run of chains: picture and statistics. */

#include "integrator/markov/markov_result.h"

#include "base/mem.h"
#include "integrator/markov/markov_bootstrap.h"
#include "integrator/markov/markov_films.h"
#include "integrator/markov/markov_group.h"
#include "integrator/markov/markov_mixing.h"
#include "integrator/markov/markov_state.h"

#include <stdio.h>

/* --- pictures --------------------------------------------------------------------- */

void markov_add_film(double *sum, const struct film *film, long pixels, double scale)
{
    for (long i = 0; i < pixels; i++) {
        struct rgb v = film_value(film, (int)i);
        sum[3 * i] += scale * v.r;
        sum[3 * i + 1] += scale * v.g;
        sum[3 * i + 2] += scale * v.b;
    }
}

/* Sums the films, in emission units of the mean pixel; see struct group. */
static void sum_films(const struct markov *m, double *sum)
{
    double shared_b = 0.0, variance;
    long pixels = (long)markov_pixels(m);
    for (int i = 0; i < m->group_count; i++) {
        const struct group *group = &m->groups[i];
        double b = group_brightness(m, group, &variance), n = markov_states(m, group);
        if (group->shares)
            shared_b += b;
        else if (n > 0.0)
            markov_add_film(sum, group->film, pixels, b * (double)pixels / n);
    }
    if (m->films.shared)
        markov_add_film(sum, m->films.shared, pixels, shared_b * markov_shared_factor(m));
    if (m->films.large)
        markov_add_film(sum, m->films.large, pixels,
                        m->b0 * (double)pixels / markov_large_count(m));
}

void markov_picture(void *self, struct image *out)
{
    struct markov *m = self;
    long values = 3 * (long)markov_pixels(m);
    double *sum = mem_alloc((size_t)values, sizeof *sum);
    if (m->done > 0)
        sum_films(m, sum);
    if (m->direct)
        passes_picture(m->direct, out);
    for (long i = 0; i < values; i++) {
        double plain = m->direct ? (double)out->pixels[i] : 0.0;
        out->pixels[i] = (float)(sum[i] * m->scene->emission_scale + plain);
    }
    mem_free(sum);
}

/* The estimate of b has a heavy tail if few samples carry its variance: fewer than
 * SAMPLES_LEAST, or than a thousandth of all, unless that is more than SAMPLES_MOST.
 * (Measured on a coarse glass ball over a floor, where b is low by 2 to 6 standard
 * errors: 4 to 51 of 6e5 samples, and 315 to 351. Of 40 further seeds 12 missed b by more
 * than two standard errors; the rule flagged all 40.) */
#define SAMPLES_LEAST 100.0
#define SAMPLES_MOST  1000.0
#define SAMPLES_SHARE 1e-3
/* With fewer effective seeds, a single seed changes the statistics by more than their
 * standard errors. */
#define SEEDS_FEW 64.0

/* --- figures ---------------------------------------------------------------------- */

static double ratio(double a, double b)
{
    return b > 0.0 ? a / b : (double)NAN;
}

/* Zeng's counters [Zeng19, section 6.1], failures by cause, and rates. */
static void count_paths(const struct tally *all, struct run_statistics *out)
{
    double first = (double)tally_first(all->proposed);
    double nonzero = (double)tally_first(all->nonzero);
    for (int move = 0; move < MOVES_MOST; move++) {
        out->counters.total += (double)all->proposed[move];
        out->counters.accepted += (double)all->accepted[move];
        for (int cause = 0; cause < FAILURES; cause++)
            out->counters.failures[cause] += (double)all->failures[move][cause];
    }
    out->paths = (double)tally_paths(all);
    out->counters.excluded = (double)all->excluded;
    out->counters.final_failures = (double)all->final_failures;
    out->counters.second_stage = (double)all->proposed[MOVE_SECOND_STAGE];
    double counted = out->counters.total - out->counters.excluded;
    out->excluded = out->counters.excluded;
    out->acceptance = ratio(out->counters.accepted, first);
    out->failure_rate = ratio(first - nonzero, first);
    /* FailureRate and AcceptanceRate [Zeng19, section 6.1]. */
    out->final_failure_rate = ratio(out->counters.final_failures, counted);
    out->acceptance_rate = ratio(out->counters.accepted, counted);
    out->second_acceptance = ratio(all->acceptance[MOVE_SECOND_STAGE],
                                   (double)all->proposed[MOVE_SECOND_STAGE]);
    out->jumps = (double)all->proposed[MOVE_JUMP];
    out->jump_acceptance = ratio(all->acceptance[MOVE_JUMP], out->jumps);
}

static void chain_figures(const struct markov *m, struct run_statistics *out)
{
    for (int i = 0; i < m->chain_count; i++) {
        const struct chain *c = &m->chains[i];
        if (m->missing && m->missing[i])
            continue;
        out->nonfinite += (double)(c->contribs[0].nonfinite + c->contribs[1].nonfinite);
        out->most_rejections_in_row = fmax(out->most_rejections_in_row,
                                           (double)c->most_rejections_in_row);
        out->chains_never_moved += tally_moves(&c->tally) == 0;
    }
}

static void length_figures(const struct markov *m, const struct group *group,
                           const struct tally *now, struct length_statistics *out)
{
    struct tally all = group_tally(m, group);
    double variance, proposed = (double)tally_first(all.proposed);
    *out = (struct length_statistics){
        .length = group->length,
        .chains = group->chain_count,
        .found = group->bootstrap.b > 0.0,
        .p_l = group->params.p_large,
        .b = group_brightness(m, group, &variance) * m->scene->emission_scale,
        .b_se = sqrt(variance) * m->scene->emission_scale,
        .failure_rate = ratio(proposed - (double)tally_first(all.nonzero), proposed),
    };
    struct statistics_part part = group_part(m, group, now);
    statistics_measure(&part, 1, &out->whole);
}

/* For runs without chains, whose p_l is not used. */
static void explain_plain_only(const struct markov *m, struct run_statistics *out)
{
    out->plain_only = true;
    if (m->split && m->design.passes.estimate) {
        snprintf(out->plarge.reason, sizeof out->plarge.reason, "no chain runs: %.300s",
                 m->split->plan.reason);
        return;
    }
    snprintf(
        out->plarge.reason, sizeof out->plarge.reason,
        "no chain is needed: all light found is of length %s, by plain samples; %.0f "
        "longer paths carried none",
        m->design.plain_lengths > 1 ? "1 or 2" : "1", out->bootstrap_paths);
}

/* Mean luminance of the passes' part of the picture. */
static double passes_brightness(const struct markov *m)
{
    struct image *image = image_create(m->scene->camera.width, m->scene->camera.height);
    double sum = 0.0, pixels = markov_pixels(m);
    passes_picture(m->direct, image);
    for (long i = 0; i < (long)pixels; i++)
        sum += rgb_luminance(image_pixel(image, i));
    image_destroy(image);
    return sum / pixels;
}

/* Mean luminance of the chains' part. */
static double chains_brightness(const struct markov *m)
{
    long pixels = (long)markov_pixels(m);
    double *sum = mem_alloc(3 * (size_t)pixels, sizeof *sum), all = 0.0;
    if (m->done > 0)
        sum_films(m, sum);
    for (long i = 0; i < pixels; i++)
        all += rgb_luminance(rgb(sum[3 * i], sum[3 * i + 1], sum[3 * i + 2]));
    mem_free(sum);
    return all / (double)pixels * m->scene->emission_scale;
}

static void split_figures(const struct markov *m, struct run_statistics *out)
{
    const struct split *split = &m->split->split;
    const struct split_plan *plan = &m->split->plan;
    struct split_figures *to = &out->split;
    *to = split_figures_none;
    to->used = true;
    to->samples = m->split->samples;
    out->bootstrap_paths += to->samples;
    if (m->phase == PHASE_BOOTSTRAP)
        return;
    to->floor = plan->floor;
    to->ceiling = plan->ceiling;
    to->passes = m->design.passes.estimate ? plan->passes : (double)NAN;
    to->relmse = plan->relmse;
    to->passes_alone = plan->passes_alone;
    to->chains_alone = plan->chains_alone;
    to->b = split->unit > 0.0 ? out->b / (split->unit * m->scene->emission_scale) : 0.0;
    to->b_se = split->unit > 0.0 ? out->b_se / (split->unit * m->scene->emission_scale)
                                 : 0.0;
    to->large = 0.0;
    for (int g = 0; g < m->group_count; g++)
        to->large += split->large[m->groups[g].length] * m->groups[g].chain_count /
                     m->chain_count;
    snprintf(to->reason, sizeof to->reason, "%s", plan->reason);
}

/* With a split the targets of chains are no luminance: b is that of whole samples of the
 * passes, or else of the chains' picture, with the relative error of the mean target. */
static void split_brightness(const struct markov *m, struct run_statistics *out)
{
    double relative = out->b > 0.0 ? out->b_se / out->b : 0.0;
    if (m->design.passes.estimate)
        return;
    out->b = chains_brightness(m);
    out->b_se = out->b * relative;
}

static void add_plain_samples(const struct markov *m, struct run_statistics *out)
{
    struct run_statistics plain;
    passes_statistics(m->direct, &plain);
    bool whole = m->design.passes.estimate != NULL;
    out->plain_lengths = m->design.plain_lengths;
    out->plain_samples = plain.paths;
    out->plain_b = whole ? passes_brightness(m) : plain.b;
    out->plain_b_se = plain.b_se;
    out->paths += plain.paths;
    out->b = whole ? plain.b : out->b + plain.b;
    out->b_se = whole ? plain.b_se : hypot(out->b_se, plain.b_se);
    out->nonfinite += plain.nonfinite;
    out->unsampled = plain.unsampled;
    if (m->no_light && plain.b > 0.0)
        explain_plain_only(m, out);
}

static void group_figures(const struct markov *m, const struct tally *now,
                          struct run_statistics *out)
{
    double variance = 0.0, squares = 0.0, fourths = 0.0, all = 0.0;
    for (int i = 0; i < m->group_count; i++) {
        const struct group *group = &m->groups[i];
        double own;
        out->b += group_brightness(m, group, &own);
        variance += own;
        group_moments(m, group, &squares, &fourths);
        all += group->independent.count +
               (double)group_tally(m, group).proposed[MOVE_LARGE];
        out->bootstrap_paths += (double)group->bootstrap.count;
        out->nonfinite += (double)group->bootstrap.nonfinite;
        if (group->length > 0)
            length_figures(m, group, now, &out->lengths[out->length_count++]);
    }
    for (int i = 0; i < m->films.count; i++)
        out->saturated += (double)film_saturated(m->films.all[i]);
    out->b *= m->scene->emission_scale;
    out->b_se = sqrt(variance) * m->scene->emission_scale;
    if (m->split) {
        split_figures(m, out);
        split_brightness(m, out);
    }
    if (m->direct)
        add_plain_samples(m, out);
    /* The variance of plain samples is known. */
    squares += pow(out->plain_b_se / m->scene->emission_scale, 2.0);
    out->b_samples = fourths > 0.0   ? squares / fourths * squares
                     : squares > 0.0 ? HUGE_VAL
                                     : 0.0;
    out->b_freedom = 2.0 * out->b_samples;
    double wanted = fmin(fmax(SAMPLES_LEAST, SAMPLES_SHARE * all), SAMPLES_MOST);
    out->b_trusted = out->b_samples >= wanted && out->b_se < HUGE_VAL;
    out->seeds_effective = m->b0 > 0.0 ? markov_effective_seeds(m) : 0.0;
    out->seeds_few = m->b0 > 0.0 && out->seeds_effective < SEEDS_FEW;
}

static void measure_whole(const struct markov *m, const struct tally *now,
                          const struct tally *start, const struct tally *all,
                          struct run_statistics *out)
{
    struct statistics_part whole[DIMS_MAX_DEPTH], before[DIMS_MAX_DEPTH];
    struct statistics_mixing mixing = markov_mixing(m, all, start);
    markov_add_allocation(m, now, &mixing);
    for (int i = 0; i < m->group_count; i++) {
        whole[i] = group_part(m, &m->groups[i], now);
        before[i] = group_part(m, &m->groups[i], start);
    }
    statistics_measure_after(whole, before, m->group_count, &mixing, &out->whole);
}

static void count_moves(const struct tally *all, const struct markov_design *design,
                        struct run_statistics *out)
{
    const char *const *names = design->state->moves;
    for (int move = 0; move < MOVES_MOST; move++) {
        struct move_statistics *m = &out->moves[out->move_count];
        if (!names[move])
            continue;
        *m = (struct move_statistics){
            .name = names[move],
            .proposed = (double)all->proposed[move],
            .accepted = (double)all->accepted[move],
            .acceptance = ratio(all->acceptance[move], (double)all->proposed[move]),
            .work = ratio(all->work[move], (double)all->proposed[move]),
        };
        if (design->state == &state_mlt && move >= MOVE_LOCAL)
            m->weight = design->mlt.weights[move - MOVE_LOCAL];
        for (int cause = 0; cause < FAILURES; cause++)
            m->failures[cause] = (double)all->failures[move][cause];
        out->move_count++;
    }
}

void markov_statistics(const void *self, struct run_statistics *out)
{
    const struct markov *m = self;
    struct tally all = markov_tally(m),
                 *now = mem_alloc((size_t)m->chain_count, sizeof *now);
    for (int i = 0; i < m->chain_count; i++)
        now[i] = m->chains[i].tally;
    /* A run that ended during the start has measured all the same. */
    const struct tally *start = m->phase == PHASE_MAIN ? m->start.tallies : now;
    *out = (struct run_statistics){
        .plarge = m->plarge,
        .p_l_zsolnai2013 = m->start.p_zsolnai,
        .tours = m->start.tours,
        .split = split_figures_none,
        .race = race_figures_none,
        .adaptive = adaptive_figures_none,
        .plarge_auto = settings_auto(m->settings),
        .start_looks = m->start.looks,
        .seconds_startup = m->start.seconds,
        .chains = m->chain_count,
    };
    for (int i = 0; m->missing && i < m->chain_count; i++)
        out->chains -= m->missing[i];
    for (int i = 0; i < m->chain_count; i++)
        out->start_mutations += (double)tally_first(start[i].proposed);
    count_paths(&all, out);
    count_moves(&all, &m->design, out);
    chain_figures(m, out);
    if (m->group_count > 0) {
        group_figures(m, now, out);
        if (m->start.looks > 0)
            out->start =
                m->start.statistics; /* the input of the rule, with the b of that time */
        else
            markov_measure(m, start, &out->start);
        measure_whole(m, now, start, &all, out);
    }
    mem_free(now);
}

void markov_counts(const void *self, struct run_counts *out)
{
    const struct markov *m = self;
    struct tally all = markov_tally(m);
    struct run_statistics s = {.paths = 0.0};
    struct run_counts plain = {.paths = 0.0};
    count_paths(&all, &s);
    if (m->direct)
        passes_counts(m->direct, &plain);
    *out = (struct run_counts){s.paths + plain.paths, s.acceptance, m->plarge.p_l};
}

/* The choice by the pilots' errors times work, with what experience says of errors that
 * pilots do not show (results/smlt):
 *
 *   bdpt wins unless another is clearly less: it weighs all techniques, so it is the one
 * that is least often far worse than a short pilot shows.
 *   pt has at least the error that bdpt's samples predict for it (race_moments.h): of
 * light that it hardly ever samples its pilots show nothing. Above that, the error is the
 * geometric mean of the prediction and of what its pilots show, which is the noisier.
 *   Chains are not run where not even independent draws from their target would win.
 *   Chains that begin at a few paths have not seen enough of the light for their halves
 * to tell their error: they are out.
 *   The brightness of chains is left out: that of a pilot has few independent paths, that
 * of a run many. */

#include "image/metric.h"
#include "integrator/path_work.h"
#include "integrator/race_moments.h"
#include "integrator/race_state.h"

#include <stdio.h>

#define CLEARLY       0.8 /* of the error of bdpt: another without chains */
#define CLEARLY_CHAIN 0.4 /* one with chains */
#define SEEDS_LEAST   12.0
#define MOMENT_PASSES 1.0 /* samples a pixel of the pilots' film */

const char *const race_names[RACE_CANDIDATES] = {"pt", "bdpt", "pssmlt", "mmlt"};

double race_moment_work(const struct race *race)
{
    if (!race->entries[RACE_PT].type)
        return 0.0;
    return MOMENT_PASSES * race_pixels(&race->scene) * race->entries[RACE_BDPT].work;
}

/* The score of pt that bdpt's samples predict. */
static double moment_score(struct race *race)
{
    const struct entry *pt = &race->entries[RACE_PT], *bdpt = &race->entries[RACE_BDPT];
    long samples = (long)(MOMENT_PASSES * race_pixels(&race->scene));
    race->work += race_moment_work(race);
    race->paths += (double)samples;
    return bdpt->score * pt->work / bdpt->work *
           race_moments(&race->scene, settings_depth(race->settings, race->whole),
                        (uint64_t)race->settings->seed, samples, race->scale);
}

static void get_halves(const struct race *race, struct race_halves *halves)
{
    for (int k = 0; k < RACE_CANDIDATES; k++)
        halves[k] = race->entries[k].halves;
}

/* The states of a chain are no better than independent draws from its target, and its
 * large steps, which the kelemen estimator adds, no better than samples of bdpt: the
 * error of a mutation is at least the lesser of the two. mmlt's large steps pick one
 * technique each, and are left out. A chain has to be clearly better than bdpt, so it
 * cannot win if the bound is not. (Runs of 17 scenes have 1.03 times the bound at least,
 * results/smlt.) */
void race_screen(struct race *race)
{
    struct race_halves halves[RACE_CANDIDATES];
    double errors[RACE_CANDIDATES], pixels = race_pixels(&race->scene);
    int width = race->scene.camera.width, height = race->scene.camera.height;
    const struct entry *bdpt = &race->entries[RACE_BDPT];
    get_halves(race, halves);
    race_weigh(halves, RACE_CANDIDATES, width, height, METRIC_RELATIVE_FLOOR,
               race->scale);
    race_errors(halves, RACE_CANDIDATES, width, height, race->scale, errors);
    double draws = race_draws_error(halves, RACE_CANDIDATES, (long)pixels, race->scale);
    double samples = errors[RACE_BDPT] * bdpt->halves.samples / pixels;
    for (int k = 0; k < RACE_CANDIDATES; k++) {
        struct entry *e = &race->entries[k];
        double bound = k == RACE_PSSMLT ? fmin(draws, samples) : draws;
        if (e->type && !e->halves.independent &&
            bound * pixels * e->work > CLEARLY_CHAIN * errors[RACE_BDPT] * bdpt->spent)
            e->least = bound * pixels * e->work;
    }
}

void race_judge(struct race *race)
{
    struct race_halves halves[RACE_CANDIDATES];
    double errors[RACE_CANDIDATES];
    int width = race->scene.camera.width, height = race->scene.camera.height;
    get_halves(race, halves);
    race_level(halves, RACE_CANDIDATES, (long)width * height);
    race_errors(halves, RACE_CANDIDATES, width, height, race->scale, errors);
    for (int k = 0; k < RACE_CANDIDATES; k++) {
        struct entry *e = &race->entries[k];
        e->score = (double)INFINITY;
        if (e->type && e->least == 0.0 &&
            (e->halves.independent || e->seeds >= SEEDS_LEAST))
            e->score = errors[k] * e->spent;
    }
    struct entry *pt = &race->entries[RACE_PT];
    if (pt->type) {
        double predicted = moment_score(race);
        pt->score = fmax(predicted, sqrt(predicted * pt->score));
    }
    race->judged = true;
}

static int best_of(const struct race *race)
{
    double least = race->entries[RACE_BDPT].score;
    int best = RACE_BDPT;
    for (int k = 0; race->judged && k < RACE_CANDIDATES; k++) {
        const struct entry *e = &race->entries[k];
        double clearly = e->halves.independent ? CLEARLY : CLEARLY_CHAIN;
        if (k != RACE_BDPT && e->type && e->score / clearly < least) {
            least = e->score / clearly;
            best = k;
        }
    }
    return best;
}

static void explain(const struct race *race, int best, struct race_figures *out)
{
    double least = race->entries[best].score;
    int used = snprintf(out->reason, sizeof out->reason,
                        "by pilots of %.2g %% of the work",
                        100.0 * race->work / race->budget);
    for (int k = 0; k < RACE_CANDIDATES; k++) {
        const struct entry *e = &race->entries[k];
        size_t left = sizeof out->reason - (size_t)used;
        const char *comma = used > 40 ? "," : ":";
        if (k == best || !e->type)
            continue;
        if (e->score < (double)INFINITY)
            used += snprintf(out->reason + used, left,
                             "%s %s would have %.3g times the squared error", comma,
                             race_names[k], e->score / least);
        else if (e->least > 0.0)
            used += snprintf(out->reason + used, left,
                             "%s %s would have at least %.3g times", comma, race_names[k],
                             e->least / least);
        else
            used += snprintf(out->reason + used, left, "%s %s begins at too few paths",
                             comma, race_names[k]);
    }
    snprintf(out->reason + used, sizeof out->reason - (size_t)used, ", at equal work");
}

/* Work of what the chosen one will trace. */
static double work_left(const struct race *race, const struct entry *e)
{
    double budget = race->budget;
    if (!(race->settings->seconds > 0.0))
        budget = race->settings->mutations_per_pixel * race_pixels(race->whole) * e->work;
    return budget - race->work;
}

void race_result(const struct race *race, struct race_figures *out)
{
    int best = best_of(race);
    const struct entry *e = &race->entries[best];
    *out = (struct race_figures){.used = true,
                                 .paths = race->paths,
                                 .equal_paths = race->work / e->work,
                                 .relmse = (double)NAN};
    snprintf(out->chosen, sizeof out->chosen, "%s", race_names[best]);
    if (!race->judged) {
        snprintf(out->reason, sizeof out->reason,
                 "without a race, whose pilots would be more than %.0f %% of so small a "
                 "budget",
                 100.0 * RACE_SHARE_ALL);
        return;
    }
    out->relmse = e->score / work_left(race, e) * race_pixels(race->whole) /
                  race_pixels(&race->scene);
    explain(race, best, out);
}

/* The choice by the pilots' errors times work, with what experience says of errors that
 * pilots do not show (results/smlt):
 *
 *   bdpt wins unless another is clearly less: it weighs all techniques, so it is the one
 * that is least often far worse than a short pilot shows.
 *   pt has at least the error that bdpt's samples predict for it (race_moments.h): of
 * light that it hardly ever samples its pilots show nothing. Above that, the error is the
 * geometric mean of the prediction and of what its pilots show, which is the noisier.
 *   Chains that begin at a few paths have not seen enough of the light for their halves
 * to tell their error: they are out.
 *   The brightness of chains is left out: that of a pilot has few independent paths, that
 * of a run many. */

#include "base/mem.h"
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
static double moment_score(struct race *race, const float *scale)
{
    const struct entry *pt = &race->entries[RACE_PT], *bdpt = &race->entries[RACE_BDPT];
    long samples = (long)(MOMENT_PASSES * race_pixels(&race->scene));
    race->work += race_moment_work(race);
    race->paths += (double)samples;
    return bdpt->score * pt->work / bdpt->work *
           race_moments(&race->scene, settings_depth(race->settings, race->whole),
                        (uint64_t)race->settings->seed, samples, scale);
}

void race_judge(struct race *race)
{
    struct race_halves halves[RACE_CANDIDATES];
    double errors[RACE_CANDIDATES];
    int width = race->scene.camera.width, height = race->scene.camera.height;
    float *scale = mem_alloc((size_t)width * (size_t)height, sizeof *scale);
    for (int k = 0; k < RACE_CANDIDATES; k++)
        halves[k] = race->entries[k].halves;
    race_level(halves, RACE_CANDIDATES, (long)width * height);
    race_weigh(halves, RACE_CANDIDATES, width, height, METRIC_RELATIVE_FLOOR, scale);
    race_errors(halves, RACE_CANDIDATES, width, height, scale, errors);
    for (int k = 0; k < RACE_CANDIDATES; k++) {
        struct entry *e = &race->entries[k];
        e->score = (double)INFINITY;
        if (e->type && (e->halves.independent || e->seeds >= SEEDS_LEAST))
            e->score = errors[k] * e->spent;
    }
    struct entry *pt = &race->entries[RACE_PT];
    if (pt->type) {
        double predicted = moment_score(race, scale);
        pt->score = fmax(predicted, sqrt(predicted * pt->score));
    }
    race->judged = true;
    mem_free(scale);
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

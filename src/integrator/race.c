/* Each candidate makes pilot runs in pairs, A and B, that differ in their seeds. Both are
 * unbiased, so E[(A - B)^2] / 4 is the variance of their mean, whatever kind of estimator
 * it is, and correlation within chains is in it (race_error.h). Errors are in inverse
 * proportion to work, of independent samples exactly; of chains because a pilot has few
 * of them, which run for a good part of the length that they will have. So error times
 * work tells which candidate has the least error at equal work, and what it will be.
 *
 * Error is the geometric mean of relMSE and of relMSE without the worst pixels: the one
 * follows single bright samples, the other does not see what is rare.
 *
 * In the first round all candidates have pilots of the same small work; those whose error
 * is DROP times the least are out. The others have a second round of twice the work. Work
 * is counted, not timed (path_work.h), so under a budget of paths the choice depends on
 * the seed alone. */

#include "integrator/race.h"

#include "base/clock.h"
#include "base/mem.h"
#include "base/text.h"
#include "image/metric.h"
#include "integrator/path_work.h"
#include "integrator/race_error.h"
#include "integrator/registry.h"

#include <stdio.h>
#include <string.h>

#define CANDIDATES     4
#define ROUNDS         2
#define SHARE          0.004 /* of the budget's work: a pilot of the first round */
#define SHARE_MOST     0.12  /* of the budget's work: all pilots */
#define PASSES_MOST    64.0  /* samples a pixel of bdpt whose work a pilot has at most */
#define DROP           1.5
#define CHAINS         32
#define CHAIN_LEAST    64.0 /* mutations of a chain */
#define P_LARGE        0.3
#define BOOTSTRAP_EACH 64.0    /* of a path length, at least */
#define BOOTSTRAP      0.125   /* of the paths of a pilot with chains */
#define SEEDS          1000003 /* between the seeds of pilots */

static const char *const names[CANDIDATES] = {"pt", "bdpt", "pssmlt", "mmlt"};
#define BDPT 1 /* the one that does without a race */

struct entry {
    const struct integrator_type *type; /* NULL: no candidate, or out */
    double work;                        /* of a path */
    double paths;                       /* of a pilot of this round */
    struct race_halves halves;          /* of this round */
    double spent;                       /* work of these two pilots */
    double full, trimmed;               /* error times work, sums weighted by work */
    bool lacks;    /* light that the others show: of no use whatever its error is */
    double weight; /* sum of work over rounds */
};

struct race {
    const struct scene *scene;
    const struct settings *settings;
    struct entry entries[CANDIDATES];
    struct image *image;
    int round, next, half; /* of the pilot to come */
    bool begun, over;
    double budget;      /* work of the whole run */
    double pace;        /* work a second, and */
    double time;        /* that there is time for, under a time budget */
    double paths, work; /* of all pilots */
};

/* --- candidates -------------------------------------------------------------------- */

static bool is_candidate(const struct scene *scene, int index)
{
    const struct blind_family *found[BLIND_FAMILIES];
    struct needs needs = needs_of_desc(scene->desc);
    int depth = DIMS_MAX_DEPTH;
    return index != 0 || blind_find(&needs, TECHNIQUES_PT, depth, found) ==
                             blind_find(&needs, TECHNIQUES_BDPT, depth, found);
}

const char *race_candidate(const struct scene *scene, int index)
{
    index += !is_candidate(scene, 0);
    return index < CANDIDATES ? names[index] : NULL;
}

static double pixels_of(const struct race *race)
{
    return (double)race->scene->camera.width * race->scene->camera.height;
}

struct race *race_create(const struct scene *scene, const struct settings *settings)
{
    struct race *race = mem_alloc(1, sizeof *race);
    size_t pixels = (size_t)scene->camera.width * (size_t)scene->camera.height;
    race->scene = scene;
    race->settings = settings;
    race->image = image_create(scene->camera.width, scene->camera.height);
    for (int k = 0; k < CANDIDATES; k++) {
        struct entry *e = &race->entries[k];
        e->type = is_candidate(scene, k) ? integrator_find(names[k]) : NULL;
        for (int half = 0; half < 2; half++)
            e->halves.picture[half] = mem_alloc(pixels, sizeof(float));
    }
    return race;
}

void race_destroy(struct race *race)
{
    if (!race)
        return;
    for (int k = 0; k < CANDIDATES; k++)
        for (int half = 0; half < 2; half++)
            mem_free(race->entries[k].halves.picture[half]);
    image_destroy(race->image);
    mem_free(race);
}

/* --- pilots ------------------------------------------------------------------------ */

/* Paths of a pilot of this round: whole passes, or chains that are not too short. */
static double pilot_paths(const struct race *race, const struct entry *e)
{
    double share = SHARE * (race->round == 0 ? 1.0 : 2.0), pixels = pixels_of(race);
    double most = PASSES_MOST * race->entries[BDPT].work * pixels;
    double paths = fmin(share * race->budget, most) / e->work;
    if (e->type->methods->chains)
        return fmax(paths, CHAINS * CHAIN_LEAST);
    return pixels * fmax(round(paths / pixels), 1.0);
}

static struct settings pilot_settings(const struct race *race, const struct entry *e)
{
    struct settings s = *race->settings;
    s.integrator = e->type->name;
    long pilot = race->next + (long)CANDIDATES * race->round;
    s.seed += SEEDS * (1 + race->half + 2 * pilot);
    s.seconds = 0.0;
    s.replicas = 1;
    s.until_relmse = 0.0;
    s.until_converged = false;
    s.layers = 0;
    s.p_large = settings_auto(&s) ? P_LARGE : s.p_large;
    s.chains = s.chains < CHAINS ? s.chains : CHAINS;
    s.mutations_per_pixel = e->paths / pixels_of(race);
    s.bootstrap = (long)fmax(BOOTSTRAP * e->paths,
                             BOOTSTRAP_EACH * settings_depth(&s, race->scene));
    return s;
}

static void keep_picture(struct race *race, float *out)
{
    for (long j = 0; j < (long)pixels_of(race); j++)
        out[j] = (float)fmin(rgb_luminance(image_pixel(race->image, j)), 1e30);
}

/* Runs a pilot to its end; false if it was stopped. */
static bool run_pilot(struct race *race, struct entry *e,
                      const struct round_limits *limits)
{
    struct settings settings = pilot_settings(race, e);
    const struct integrator_methods *methods = e->type->methods;
    struct round_limits own = {.begin = clock_wall(), .stop = limits->stop};
    struct run_statistics s;
    void *pilot = methods->create(e->type, race->scene, &settings);
    bool stopped = false;
    while (!stopped && methods->advance(pilot, &own))
        stopped = limits->stop && *limits->stop;
    methods->picture(pilot, race->image);
    methods->statistics(pilot, &s);
    methods->destroy(pilot);
    keep_picture(race, e->halves.picture[race->half]);
    e->work = path_work(e->type, race->scene, &settings, &s);
    e->halves.samples += s.paths;
    e->spent += s.paths * e->work;
    race->work += (s.paths + s.bootstrap_paths) * e->work;
    race->paths += s.paths;
    return !stopped;
}

/* --- judgement --------------------------------------------------------------------- */

static double score(const struct entry *e)
{
    if (!(e->weight > 0.0) || e->lacks)
        return (double)INFINITY;
    return sqrt(e->full * e->trimmed) / e->weight;
}

/* The least error times work. */
static int best_of(const struct race *race)
{
    int best = BDPT;
    for (int k = 0; k < CANDIDATES; k++) {
        const struct entry *e = &race->entries[k], *b = &race->entries[best];
        if (score(e) < score(b))
            best = k;
    }
    return best;
}

static void add_errors(struct race *race)
{
    struct race_halves halves[CANDIDATES];
    struct race_error errors[CANDIDATES];
    for (int k = 0; k < CANDIDATES; k++)
        halves[k] = race->entries[k].halves;
    race_errors(halves, CANDIDATES, race->scene->camera.width, race->scene->camera.height,
                METRIC_RELATIVE_FLOOR, errors);
    for (int k = 0; k < CANDIDATES; k++) {
        struct entry *e = &race->entries[k];
        double squares = e->spent * e->spent;
        if (!(e->halves.samples > 0.0))
            continue;
        e->full += squares * errors[k].full;
        e->trimmed += squares * errors[k].trimmed;
        e->lacks = e->lacks || errors[k].missing > 0.0;
        e->weight += e->spent;
        e->halves.samples = e->spent = 0.0;
    }
}

/* Work of the whole run. Under a budget of paths that depends on who traces them: the
 * best so far, at first the geometric mean of all. */
static double run_work(const struct race *race)
{
    const struct settings *s = race->settings;
    double logs = 0.0, count = 0.0;
    if (s->seconds > 0.0)
        return race->time;
    for (int k = 0; k < CANDIDATES; k++)
        if (race->entries[k].type) {
            logs += log(race->entries[k].work);
            count += 1.0;
        }
    double work = race->round > 0 ? race->entries[best_of(race)].work : exp(logs / count);
    return s->mutations_per_pixel * pixels_of(race) * work;
}

/* Plans the pilots of the round; false if their work is too much. */
static bool plan_round(struct race *race)
{
    double work = race->work;
    race->budget = run_work(race);
    race->next = race->half = 0;
    for (int k = 0; k < CANDIDATES; k++) {
        struct entry *e = &race->entries[k];
        e->paths = e->type ? pilot_paths(race, e) : 0.0;
        work += 2.0 * e->paths * e->work;
    }
    return work <= SHARE_MOST * race->budget;
}

/* At the end of a round. */
static void judge(struct race *race)
{
    int left = 0;
    add_errors(race);
    double least = score(&race->entries[best_of(race)]);
    for (int k = 0; k < CANDIDATES; k++) {
        struct entry *e = &race->entries[k];
        if (e->type && !(score(e) <= DROP * least))
            e->type = NULL;
        left += e->type != NULL;
    }
    race->over = ++race->round == ROUNDS || left < 2 || !plan_round(race);
}

/* --- the race ---------------------------------------------------------------------- */

/* Work of all candidates; under a time budget also how much work there is time for, by
 * the time that the samples of pt and bdpt take. */
static void begin(struct race *race, const struct round_limits *limits)
{
    struct settings s = *race->settings;
    double begin = clock_wall(), work = 0.0;
    s.p_large = settings_auto(&s) ? P_LARGE : s.p_large;
    for (int k = 0; k < CANDIDATES; k++) {
        struct entry *e = &race->entries[k];
        if (e->type)
            e->work = path_work(e->type, race->scene, &s, NULL);
        work += e->work;
        if (k == BDPT)
            race->pace = work * PATH_WORK_SAMPLES / (clock_wall() - begin) *
                         settings_threads(&s);
    }
    race->time = race->pace * (s.seconds - limits->seconds_used);
    race->begun = true;
    race->over = !plan_round(race);
}

bool race_advance(struct race *race, const struct round_limits *limits)
{
    if (!race->begun)
        begin(race, limits);
    while (!race->over && race->next < CANDIDATES && !race->entries[race->next].type)
        race->next++;
    if (!race->over && race->next < CANDIDATES) {
        if (!run_pilot(race, &race->entries[race->next], limits))
            return true;
        race->next += race->half;
        race->half = !race->half;
    } else if (!race->over) {
        judge(race);
    }
    return !race->over;
}

double race_paths(const struct race *race)
{
    return race->paths;
}

/* --- the choice -------------------------------------------------------------------- */

static void explain(const struct race *race, int best, struct race_figures *out)
{
    double least = score(&race->entries[best]);
    int used = snprintf(out->reason, sizeof out->reason,
                        "by pilots of %.2g %% of the work",
                        100.0 * race->work / race->budget);
    for (int k = 0; k < CANDIDATES; k++)
        if (k != best && race->entries[k].weight > 0.0)
            used += snprintf(out->reason + used, sizeof out->reason - (size_t)used,
                             "%s %s would have %.3g times the squared error",
                             used > 40 ? "," : ":", names[k],
                             score(&race->entries[k]) / least);
    snprintf(out->reason + used, sizeof out->reason - (size_t)used, ", at equal work");
}

/* Work of what the chosen one will trace. */
static double work_left(const struct race *race, const struct entry *e)
{
    const struct settings *s = race->settings;
    if (s->seconds > 0.0)
        return race->budget - race->work;
    return (s->mutations_per_pixel * pixels_of(race) - race->paths) * e->work;
}

void race_result(const struct race *race, struct race_figures *out)
{
    int best = best_of(race);
    const struct entry *e = &race->entries[best];
    *out = (struct race_figures){
        .used = true, .paths = race->paths, .relmse = (double)NAN};
    snprintf(out->chosen, sizeof out->chosen, "%s", names[best]);
    if (!(e->weight > 0.0)) {
        snprintf(out->reason, sizeof out->reason,
                 "without a race, whose pilots would be more than %.0f %% of so small a "
                 "budget",
                 100.0 * SHARE_MOST);
        return;
    }
    out->relmse = e->full / e->weight / work_left(race, e);
    explain(race, best, out);
}

void race_memory(const struct scene *scene, struct run_memory *out)
{
    double pixels = (double)scene->camera.width * scene->camera.height;
    out->pictures += pixels * (2.0 * CANDIDATES * sizeof(float) + 2.0 * sizeof(double) +
                               4.0 * sizeof(float));
}

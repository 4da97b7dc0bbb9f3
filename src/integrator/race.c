/* Each candidate makes pilot runs in pairs, A and B, that differ in their seeds. Both are
 * unbiased, so E[(A - B)^2] / 4 is the variance of their mean, whatever kind of estimator
 * it is, and correlation within chains is in it (race_error.h). Errors are in inverse
 * proportion to work, of independent samples exactly; of chains because a pilot has few
 * of them, which run for a good part of the length that they will have. So error times
 * work tells which candidate has the least error at equal work, and what it will be.
 *
 * Pilots render a small film, on which a sample of each pixel is a small share of the
 * budget's work. The relative variance of a pixel with n samples does not depend on its
 * size, so relMSE at equal work is in proportion to the number of pixels. On films much
 * smaller than PIXELS chains looked worse than they are.
 *
 * bdpt wins unless another error is clearly less: it weighs all techniques, so of all
 * candidates it is the one that is least often far worse than a short pilot shows.
 *
 * All pilots of a round have about the same work. Candidates whose error is DROP times
 * the least are out after the first round, and the others have a second one. Work is
 * counted, not timed (path_work.h), so under a budget of paths the choice depends on the
 * seed alone.
 *
 * The winner's pilots are thrown away too: a pilot without a rare bright sample is too
 * dark and looks better than it is, so the mean of pilots that won is not the picture. */

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

#define CANDIDATES 4
#define ROUNDS     2
/* Work of all pilots of a round: a share of the budget's; more where so little would not
 * tell methods from each other; and at most. */
#define SHARE          0.03
#define WORK_LEAST     4e6 /* of the random events and connections, state_work() */
#define SHARE_MOST     0.07
#define SHARE_ALL      0.14   /* of both rounds, at most */
#define PIXELS         2560.0 /* of the pilots' film, at most */
#define DROP           2.0
#define CLEARLY        0.8 /* of the error of bdpt */
#define CHAINS         32
#define CHAIN_LEAST    64.0 /* mutations of a chain */
#define PLAIN_PASS     5.0  /* mutations a pixel that have a pass of plain samples */
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
    double error;                       /* times work, sum weighted by work */
    bool lacks;    /* light that the others show: of no use whatever its error is */
    double weight; /* sum of work over rounds */
};

struct race {
    const struct scene *whole;
    struct scene scene; /* `whole` with the film of the pilots */
    const struct settings *settings;
    struct entry entries[CANDIDATES];
    struct image *image;
    struct race_light light;
    long edges_cut;        /* by pilots, which are no part of the picture */
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

static double pixels_of(const struct scene *scene)
{
    return (double)scene->camera.width * scene->camera.height;
}

static void make_film(struct race *race)
{
    struct camera *camera = &race->scene.camera;
    double side = fmin(sqrt(PIXELS / pixels_of(race->whole)), 1.0);
    camera->width = (int)fmax(round(side * camera->width), 1.0);
    camera->height = (int)fmax(round(side * camera->height), 1.0);
    size_t count = (size_t)camera->width * (size_t)camera->height;
    race->image = image_create(camera->width, camera->height);
    race->light.sum = mem_alloc(count, sizeof *race->light.sum);
    for (int k = 0; k < CANDIDATES; k++)
        for (int half = 0; half < 2; half++)
            race->entries[k].halves.picture[half] = mem_alloc(count, sizeof(float));
}

struct race *race_create(const struct scene *scene, const struct settings *settings)
{
    struct race *race = mem_alloc(1, sizeof *race);
    race->whole = scene;
    race->scene = *scene;
    race->scene.edges_cut = &race->edges_cut;
    race->settings = settings;
    for (int k = 0; k < CANDIDATES; k++) {
        struct entry *e = &race->entries[k];
        e->type = is_candidate(scene, k) ? integrator_find(names[k]) : NULL;
        e->halves.independent = e->type && !e->type->methods->chains;
    }
    make_film(race);
    return race;
}

void race_destroy(struct race *race)
{
    if (!race)
        return;
    for (int k = 0; k < CANDIDATES; k++)
        for (int half = 0; half < 2; half++)
            mem_free(race->entries[k].halves.picture[half]);
    mem_free(race->light.sum);
    image_destroy(race->image);
    mem_free(race);
}

static int candidates_left(const struct race *race)
{
    int left = 0;
    for (int k = 0; k < CANDIDATES; k++)
        left += race->entries[k].type != NULL;
    return left;
}

/* --- pilots ------------------------------------------------------------------------ */

/* Of a pilot of this round. */
static double pilot_work(const struct race *race)
{
    double work = fmin(fmax(SHARE * race->budget, WORK_LEAST), SHARE_MOST * race->budget);
    return work / (2.0 * candidates_left(race));
}

/* Whether the chains of the whole run leave short paths to plain samples, as those of the
 * pilots then do. */
static bool plain_beside(const struct race *race, const struct entry *e)
{
    struct settings s = *race->settings;
    s.integrator = e->type->name;
    return settings_uses(&s, "direct") &&
           settings_plain_lengths(&s, settings_depth(&s, race->whole)) > 0;
}

/* Paths of a pilot of this round: whole passes, or chains that are not too short. */
static double pilot_paths(const struct race *race, const struct entry *e)
{
    double paths = pilot_work(race) / e->work, pixels = pixels_of(&race->scene);
    if (!e->type->methods->chains)
        return pixels * fmax(round(paths / pixels), 1.0);
    double least = plain_beside(race, e) ? PLAIN_PASS * pixels : 0.0;
    return fmax(fmax(paths, least), CHAINS * CHAIN_LEAST);
}

/* Of path_work, and of pilots. */
static struct settings common_settings(const struct race *race)
{
    struct settings s = *race->settings;
    s.p_large = settings_auto(&s) ? P_LARGE : s.p_large;
    return s;
}

static struct settings pilot_settings(const struct race *race, const struct entry *e)
{
    struct settings s = common_settings(race);
    s.integrator = e->type->name;
    long pilot = race->next + (long)CANDIDATES * race->round;
    s.seed += SEEDS * (1 + race->half + 2 * pilot);
    s.seconds = 0.0;
    s.replicas = 1;
    s.until_relmse = 0.0;
    s.until_converged = false;
    s.layers = 0;
    s.chains = s.chains < CHAINS ? s.chains : CHAINS;
    s.mutations_per_pixel = e->paths / pixels_of(&race->scene);
    s.bootstrap = (long)fmax(BOOTSTRAP * e->paths,
                             BOOTSTRAP_EACH * settings_depth(&s, race->whole));
    if (settings_uses(&s, "direct"))
        s.direct = plain_beside(race, e) ? DIRECT_SEPARATE : DIRECT_JOINT;
    return s;
}

static void keep_picture(struct race *race, float *out)
{
    for (long j = 0; j < (long)pixels_of(&race->scene); j++)
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
    void *pilot = methods->create(e->type, &race->scene, &settings);
    bool stopped = false;
    while (!stopped && methods->advance(pilot, &own))
        stopped = limits->stop && *limits->stop;
    methods->picture(pilot, race->image);
    methods->statistics(pilot, &s);
    methods->destroy(pilot);
    keep_picture(race, e->halves.picture[race->half]);
    e->work = path_work(e->type, &race->scene, &settings, &s);
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
    return e->error / e->weight;
}

/* The least error times work; that of bdpt if no other is clearly less. */
static int best_of(const struct race *race)
{
    double least = score(&race->entries[BDPT]) * CLEARLY;
    int best = BDPT;
    for (int k = 0; k < CANDIDATES; k++)
        if (k != BDPT && score(&race->entries[k]) < least) {
            least = score(&race->entries[k]);
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
    race_errors(halves, CANDIDATES, race->scene.camera.width, race->scene.camera.height,
                METRIC_RELATIVE_FLOOR, &race->light, errors);
    for (int k = 0; k < CANDIDATES; k++) {
        struct entry *e = &race->entries[k];
        double squares = e->spent * e->spent;
        if (!(e->halves.samples > 0.0))
            continue;
        e->error += squares * errors[k].relmse;
        e->lacks = e->lacks || errors[k].missing > 0.0;
        e->weight += e->spent;
        e->halves.samples = e->spent = 0.0;
    }
}

/* Work of the whole run. Under a budget of paths that depends on who traces them: the
 * best so far; at first the geometric mean of all, but not more than lets the pilots be
 * SHARE_ALL of the cheapest. */
static double run_work(const struct race *race)
{
    const struct settings *s = race->settings;
    double logs = 0.0, least = (double)INFINITY;
    if (s->seconds > 0.0)
        return race->time;
    for (int k = 0; k < CANDIDATES; k++)
        if (race->entries[k].type) {
            logs += log(race->entries[k].work) / candidates_left(race);
            least = fmin(least, race->entries[k].work);
        }
    double work = race->round > 0 ? race->entries[best_of(race)].work
                                  : fmin(exp(logs), least * SHARE_ALL / SHARE_MOST);
    return s->mutations_per_pixel * pixels_of(race->whole) * work;
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
    return work <= SHARE_ALL * race->budget;
}

/* At the end of a round. */
static void judge(struct race *race)
{
    add_errors(race);
    double least = score(&race->entries[best_of(race)]);
    for (int k = 0; k < CANDIDATES; k++) {
        struct entry *e = &race->entries[k];
        if (e->type && !(score(e) <= DROP * least))
            e->type = NULL;
    }
    race->over = ++race->round == ROUNDS || candidates_left(race) < 2 ||
                 !plan_round(race);
}

/* --- the race ---------------------------------------------------------------------- */

/* Work of all candidates; under a time budget also how much work there is time for, by
 * the time that the samples of pt and bdpt take. */
static void begin(struct race *race, const struct round_limits *limits)
{
    struct settings s = common_settings(race);
    double begin = clock_wall(), work = 0.0;
    for (int k = 0; k < CANDIDATES; k++) {
        struct entry *e = &race->entries[k];
        if (e->type)
            e->work = path_work(e->type, &race->scene, &s, NULL);
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
    double budget = race->budget;
    if (!(race->settings->seconds > 0.0))
        budget = race->settings->mutations_per_pixel * pixels_of(race->whole) * e->work;
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
    snprintf(out->chosen, sizeof out->chosen, "%s", names[best]);
    if (!(e->weight > 0.0)) {
        snprintf(out->reason, sizeof out->reason,
                 "without a race, whose pilots would be more than %.0f %% of so small a "
                 "budget",
                 100.0 * SHARE_ALL);
        return;
    }
    out->relmse = score(e) / work_left(race, e) * pixels_of(race->whole) /
                  pixels_of(&race->scene);
    explain(race, best, out);
}

void race_memory(const struct scene *scene, struct run_memory *out)
{
    double pixels = fmin(pixels_of(scene), PIXELS);
    out->pictures += pixels * (2.0 * CANDIDATES * sizeof(float) + 3.0 * sizeof(double) +
                               4.0 * sizeof(float));
}

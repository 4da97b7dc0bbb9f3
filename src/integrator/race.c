/* Each candidate makes two pilot runs, A and B, that differ in their seeds. Both are
 * unbiased, so E[(A - B)^2] / 4 is the variance of their mean, whatever kind of estimator
 * it is, and correlation within chains is in it (race_error.h). Errors are in inverse
 * proportion to work, of independent samples exactly; of chains because a pilot has few
 * of them, which run for a good part of the length that they will have. So error times
 * work tells which candidate has the least error at equal work, and what it will be
 * (race_choice.c).
 *
 * Pilots render a small film, on which a sample of each pixel is a small share of the
 * budget's work. The relative variance of a pixel with n samples does not depend on its
 * size, so relMSE at equal work is in proportion to the number of pixels. On films much
 * smaller than PIXELS chains looked worse than they are.
 *
 * Chains that cannot win by what pt and bdpt have shown run no pilots.
 *
 * All pilots have about the same work. Work is counted, not timed (path_work.h), so under
 * a budget of paths the choice depends on the seed alone.
 *
 * The winner's pilots are thrown away too: a pilot without a rare bright sample is too
 * dark and looks better than it is, so the mean of pilots that won is not the picture. */

#include "integrator/race.h"

#include "base/clock.h"
#include "base/mem.h"
#include "base/text.h"
#include "integrator/path_work.h"
#include "integrator/race_state.h"
#include "integrator/registry.h"

#include <string.h>

/* Work of all pilots: a share of the budget's; more where so little would not tell
 * methods from each other; and at most. */
#define SHARE          0.04
#define WORK_LEAST     4e6 /* of the random events and connections, state_work() */
#define SHARE_MOST     0.07
#define PIXELS         2560.0 /* of the pilots' film, at most */
#define CHAINS         32
#define CHAIN_LEAST    64.0 /* mutations of a chain */
#define PLAIN_PASS     5.0  /* mutations a pixel that have a pass of plain samples */
#define P_LARGE        0.3
#define BOOTSTRAP_EACH 64.0    /* of a path length, at least */
#define BOOTSTRAP      0.125   /* of the paths of a pilot with chains */
#define SEEDS          1000003 /* between the seeds of pilots */

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
    return index < RACE_CANDIDATES ? race_names[index] : NULL;
}

static void make_film(struct race *race)
{
    struct camera *camera = &race->scene.camera;
    double side = fmin(sqrt(PIXELS / race_pixels(race->whole)), 1.0);
    camera->width = (int)fmax(round(side * camera->width), 1.0);
    camera->height = (int)fmax(round(side * camera->height), 1.0);
    size_t count = (size_t)camera->width * (size_t)camera->height;
    race->image = image_create(camera->width, camera->height);
    race->scale = mem_alloc(count, sizeof *race->scale);
    for (int k = 0; k < RACE_CANDIDATES; k++)
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
    for (int k = 0; k < RACE_CANDIDATES; k++) {
        struct entry *e = &race->entries[k];
        e->type = is_candidate(scene, k) ? integrator_find(race_names[k]) : NULL;
        e->halves.independent = e->type && !e->type->methods->chains;
    }
    make_film(race);
    return race;
}

void race_destroy(struct race *race)
{
    if (!race)
        return;
    for (int k = 0; k < RACE_CANDIDATES; k++)
        for (int half = 0; half < 2; half++)
            mem_free(race->entries[k].halves.picture[half]);
    image_destroy(race->image);
    mem_free(race->scale);
    mem_free(race);
}

static int candidates(const struct race *race)
{
    int count = 0;
    for (int k = 0; k < RACE_CANDIDATES; k++)
        count += race->entries[k].type != NULL;
    return count;
}

/* --- pilots ------------------------------------------------------------------------ */

/* Of a pilot. */
static double pilot_work(const struct race *race)
{
    double work = fmin(fmax(SHARE * race->budget, WORK_LEAST), SHARE_MOST * race->budget);
    return work / (2.0 * candidates(race));
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

/* Paths of a pilot: whole passes, or chains that are not too short. */
static double pilot_paths(const struct race *race, const struct entry *e)
{
    double paths = pilot_work(race) / e->work, pixels = race_pixels(&race->scene);
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
    s.seed += SEEDS * (1 + race->half + 2L * race->next);
    /* Steps of the run: on a smaller film their own default would be wider. */
    s.s2 = settings_s2(&s, race_pixels(race->whole));
    s.sigma = settings_sigma(&s, race_pixels(race->whole));
    s.seconds = 0.0;
    s.film_sampling = FILM_SAMPLING_UNIFORM;
    s.replicas = 1;
    s.until_relmse = 0.0;
    s.until_converged = false;
    s.layers = 0;
    s.chains = s.chains < CHAINS ? s.chains : CHAINS;
    s.mutations_per_pixel = e->paths / race_pixels(&race->scene);
    s.bootstrap = (long)fmax(BOOTSTRAP * e->paths,
                             BOOTSTRAP_EACH * settings_depth(&s, race->whole));
    if (settings_uses(&s, "direct"))
        s.direct = plain_beside(race, e) ? DIRECT_SEPARATE : DIRECT_JOINT;
    return s;
}

static void keep_picture(struct race *race, float *out)
{
    for (long j = 0; j < (long)race_pixels(&race->scene); j++)
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
    e->seeds = race->half ? fmin(e->seeds, s.seeds_effective) : s.seeds_effective;
    race->work += (s.paths + s.bootstrap_paths) * e->work;
    race->paths += s.paths;
    return !stopped;
}

/* --- the race ---------------------------------------------------------------------- */

/* Work of the whole run. Under a budget of paths that depends on who traces them: the
 * geometric mean of all, but not more than twice that of the cheapest. */
static double run_work(const struct race *race)
{
    const struct settings *s = race->settings;
    double logs = 0.0, least = (double)INFINITY;
    if (s->seconds > 0.0)
        return race->time;
    for (int k = 0; k < RACE_CANDIDATES; k++)
        if (race->entries[k].type) {
            logs += log(race->entries[k].work) / candidates(race);
            least = fmin(least, race->entries[k].work);
        }
    return s->mutations_per_pixel * race_pixels(race->whole) *
           fmin(exp(logs), 2.0 * least);
}

/* Plans the pilots; false if their work is too much. */
static bool plan(struct race *race)
{
    double work = race_moment_work(race);
    race->budget = run_work(race);
    for (int k = 0; k < RACE_CANDIDATES; k++) {
        struct entry *e = &race->entries[k];
        e->paths = e->type ? pilot_paths(race, e) : 0.0;
        work += 2.0 * e->paths * e->work;
    }
    return work <= RACE_SHARE_ALL * race->budget;
}

/* Work of all candidates; under a time budget also how much work there is time for, by
 * the time that the samples of pt and bdpt take. */
static void begin(struct race *race, const struct round_limits *limits)
{
    struct settings s = common_settings(race);
    double begin = clock_wall(), work = 0.0;
    for (int k = 0; k < RACE_CANDIDATES; k++) {
        struct entry *e = &race->entries[k];
        if (e->type)
            e->work = path_work(e->type, &race->scene, &s, NULL);
        work += e->work;
        if (k == RACE_BDPT)
            race->pace = work * PATH_WORK_SAMPLES / (clock_wall() - begin) *
                         settings_threads(&s);
    }
    race->time = race->pace * (s.seconds - limits->seconds_used);
    race->begun = true;
    race->over = !plan(race);
}

/* Goes on to the next candidate that can win. */
static void find_next(struct race *race)
{
    for (; race->next < RACE_CANDIDATES; race->next++) {
        const struct entry *e = &race->entries[race->next];
        if (race->next == RACE_PSSMLT && race->half == 0)
            race_screen(race);
        if (e->type && e->least == 0.0)
            return;
    }
}

bool race_advance(struct race *race, const struct round_limits *limits)
{
    if (!race->begun)
        begin(race, limits);
    if (!race->over)
        find_next(race);
    if (race->over)
        return false;
    if (race->next == RACE_CANDIDATES) {
        race_judge(race);
        race->over = true;
    } else if (run_pilot(race, &race->entries[race->next], limits)) {
        race->next += race->half;
        race->half = !race->half;
    }
    return !race->over;
}

double race_paths(const struct race *race)
{
    return race->paths;
}

void race_memory(const struct scene *scene, struct run_memory *out)
{
    double pixels = fmin(race_pixels(scene), PIXELS);
    out->pictures += pixels * (2.0 * RACE_CANDIDATES * sizeof(float) +
                               2.0 * sizeof(double) + 5.0 * sizeof(float));
}

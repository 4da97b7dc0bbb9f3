/* What -i auto's choice is held against: the errors that single methods have at the same
 * CPU time, measured once.
 *
 *   race render SCENE LABEL NAME SEED COUNT FOLDER integrator=I seconds=S key=value ...
 *     COUNT runs by the seeds from SEED on, each of about S of CPU time, or of as many
 *     mutations a pixel as mutations_per_pixel=M says. Their pictures are written to the
 *     folder; a row for each run: label, name, mutations a pixel, seed, CPU seconds.
 *   race errors FOLDER
 *     Reads such rows of one label and repeats them with the errors: relMSE without the
 *     worst 1 % of pixels, and relMSE. With R1, R2 the means of all runs by two sets of
 *     other seeds the expectation of (X - R1)(X - R2) is the variance of X: no reference,
 *     and no noise of one, is in the errors. Needs three seeds.
 *   race choose SCENE LABEL MPP SEED SEEDS key=value ...
 *     Runs the pilots only, for a budget of as much work as bdpt has in MPP samples a
 *     pixel. A row for each seed: label, mpp, seed, chosen, share of the pilots, the
 *     predicted relMSE, and the reason. */

#include "program.h"

#include "base/mem.h"
#include "image/exr.h"
#include "image/metric.h"
#include "integrator/path_work.h"
#include "integrator/race.h"
#include "integrator/registry.h"

#include <math.h>

#define CALIBRATION 32 /* mutations a pixel */
#define RUNS        512
#define SEEDS       64

/* --- runs ----------------------------------------------------------------------------
 */

/* Mutations a pixel that take so many seconds: independent paths before the chains take
 * as long as mutations. */
static double paced(const struct scene *scene, const struct settings *settings)
{
    struct settings s = *settings;
    double pixels = (double)scene->camera.width * scene->camera.height;
    double before = integrator_find(s.integrator)->methods->chains
                        ? (double)s.bootstrap / pixels
                        : 0.0;
    s.seconds = 0.0;
    s.mutations_per_pixel = CALIBRATION;
    s.seed = 99;
    struct run_result r = program_render(scene, &s);
    double mpp = (CALIBRATION + before) * settings->seconds / r.seconds_cpu - before;
    run_result_deinit(&r);
    return fmax(ceil(mpp), 4.0);
}

static void picture_path(char path[512], const char *folder, const char *label,
                         const char *name, long seed)
{
    snprintf(path, 512, "%s/%s.%s.%ld.exr", folder, label, name, seed);
}

static void render(const struct scene *scene, struct settings *settings, char **words)
{
    const char *label = words[0], *name = words[1], *folder = words[4];
    long first = atol(words[2]), end = first + atol(words[3]);
    if (settings->seconds > 0.0)
        settings->mutations_per_pixel = paced(scene, settings);
    settings->seconds = 0.0;
    for (long seed = first; seed < end; seed++) {
        char path[512];
        struct err err = {0};
        settings->seed = seed;
        struct run_result r = program_render(scene, settings);
        picture_path(path, folder, label, name, seed);
        if (!exr_write(path, r.image, NULL, 0, NULL, &err))
            program_die(&err);
        printf("%s,%s,%g,%ld,%.4g\n", label, name, settings->mutations_per_pixel, seed,
               r.seconds_cpu);
        fflush(stdout);
        run_result_deinit(&r);
    }
}

/* --- errors --------------------------------------------------------------------------
 */

struct one_run {
    char row[256]; /* as read */
    char name[64];
    long seed;
    struct image *image;
    double weight; /* in references: inverse to the variance of its method */
};

struct cell {
    struct one_run runs[RUNS];
    int count;
    long seeds[SEEDS];
    int seed_count;
    long values;          /* of a picture */
    double *scale;        /* [values], of relMSE */
    double *reference[2]; /* [values], by two sets of seeds */
};

static void add_seed(struct cell *cell, long seed)
{
    for (int i = 0; i < cell->seed_count; i++)
        if (cell->seeds[i] == seed)
            return;
    if (cell->seed_count < SEEDS)
        cell->seeds[cell->seed_count++] = seed;
}

static void read_runs(struct cell *cell, const char *folder)
{
    struct one_run *run = cell->runs;
    for (; cell->count < RUNS && fgets(run->row, sizeof run->row, stdin); run++) {
        char label[64], path[512];
        struct err err = {0};
        run->row[strcspn(run->row, "\n")] = '\0';
        if (sscanf(run->row, "%63[^,],%63[^,],%*[^,],%ld", label, run->name,
                   &run->seed) != 3)
            continue;
        picture_path(path, folder, label, run->name, run->seed);
        if (!(run->image = exr_read(path, NULL, &err)))
            program_die(&err);
        add_seed(cell, run->seed);
        cell->values = 3L * run->image->width * run->image->height;
        cell->count++;
    }
}

/* Means over the channels of a pixel, and of the pixels without the worst. */
static double trimmed_mean(double *errors, long values)
{
    double all, trimmed;
    for (long j = 0; j < values / 3; j++)
        errors[j] = (errors[3 * j] + errors[3 * j + 1] + errors[3 * j + 2]) / 3.0;
    metric_means(errors, values / 3, &all, &trimmed);
    return trimmed;
}

static double value(const struct one_run *run, long k)
{
    return (double)run->image->pixels[k];
}

/* Of the method of one run, from the differences of runs that follow each other; 0 if it
 * has one run alone. */
static double find_variance(const struct cell *cell, const char *name)
{
    double *errors = mem_alloc((size_t)cell->values, sizeof *errors);
    const struct one_run *last = NULL;
    int pairs = 0;
    for (int i = 0; i < cell->count; i++) {
        const struct one_run *run = &cell->runs[i];
        if (strcmp(run->name, name) != 0)
            continue;
        for (long k = 0; last && k < cell->values; k++) {
            double d = value(run, k) - value(last, k);
            errors[k] += 0.5 * d * d * cell->scale[k];
        }
        pairs += last != NULL;
        last = run;
    }
    double variance = pairs ? trimmed_mean(errors, cell->values) / pairs : 0.0;
    mem_free(errors);
    return variance;
}

/* Weighted mean of the runs by every other seed but one, from the first or second of
 * these on; of all runs, if step is 1. */
static void find_mean(const struct cell *cell, int but, int first, int step, double *out)
{
    double sum = 0.0;
    memset(out, 0, (size_t)cell->values * sizeof *out);
    for (int i = 0; i < cell->count; i++) {
        const struct one_run *run = &cell->runs[i];
        int place = 0;
        while (cell->seeds[place] != run->seed)
            place++;
        if (place == but || (place - (but >= 0 && place > but)) % step != first)
            continue;
        for (long k = 0; k < cell->values; k++)
            out[k] += run->weight * value(run, k);
        sum += run->weight;
    }
    for (long k = 0; k < cell->values; k++)
        out[k] /= sum;
}

static void find_scale(struct cell *cell)
{
    find_mean(cell, -1, 0, 1, cell->scale);
    for (long k = 0; k < cell->values; k++)
        cell->scale[k] = 1.0 / (cell->scale[k] * cell->scale[k] + METRIC_RELATIVE_FLOOR);
}

/* Weights begin as 1, and the scale with them. */
static void find_weights(struct cell *cell)
{
    for (int i = 0; i < cell->count; i++)
        cell->runs[i].weight = 1.0;
    find_scale(cell);
    for (int i = 0; i < cell->count; i++) {
        double variance = find_variance(cell, cell->runs[i].name);
        cell->runs[i].weight = variance > 0.0 ? 1.0 / fmax(variance, 1e-12) : 1e-12;
    }
    find_scale(cell);
}

/* Of all pixels and without the worst 1 %, which the squared differences from both
 * references tell. */
static void print_errors(const struct cell *cell, const struct one_run *run)
{
    const double *a = cell->reference[0], *b = cell->reference[1];
    long pixels = cell->values / 3, kept = 0;
    double *squares = mem_alloc((size_t)pixels, sizeof *squares);
    double *sorted = mem_alloc((size_t)pixels, sizeof *sorted);
    double ignored, sum = 0.0, left = 0.0;
    for (long k = 0; k < cell->values; k++) {
        double d = value(run, k) - 0.5 * (a[k] + b[k]);
        squares[k / 3] += d * d * cell->scale[k];
    }
    memcpy(sorted, squares, (size_t)pixels * sizeof *sorted);
    metric_means(sorted, pixels, &ignored, &ignored);
    double most = sorted[pixels - 1 - pixels / METRIC_TRIM];
    for (long j = 0; j < pixels; j++) {
        double e = 0.0;
        for (long k = 3 * j; k < 3 * j + 3; k++)
            e += (value(run, k) - a[k]) * (value(run, k) - b[k]) * cell->scale[k] / 3.0;
        sum += e;
        if (squares[j] <= most)
            left += e, kept++;
    }
    printf("%s,%.5g,%.5g\n", run->row, left / (double)kept, sum / (double)pixels);
    mem_free(squares);
    mem_free(sorted);
}

static void errors(const char *folder)
{
    struct cell *cell = mem_alloc(1, sizeof *cell);
    read_runs(cell, folder);
    cell->scale = mem_alloc((size_t)cell->values, sizeof *cell->scale);
    for (int i = 0; i < 2; i++)
        cell->reference[i] = mem_alloc((size_t)cell->values, sizeof **cell->reference);
    find_weights(cell);
    for (int but = 0; cell->seed_count > 2 && but < cell->seed_count; but++) {
        for (int i = 0; i < 2; i++)
            find_mean(cell, but, i, 2, cell->reference[i]);
        for (int i = 0; i < cell->count; i++)
            if (cell->runs[i].seed == cell->seeds[but])
                print_errors(cell, &cell->runs[i]);
    }
    for (int i = 0; i < cell->count; i++)
        image_destroy(cell->runs[i].image);
    for (int i = 0; i < 2; i++)
        mem_free(cell->reference[i]);
    mem_free(cell->scale);
    mem_free(cell);
}

/* --- the choice ----------------------------------------------------------------------
 */

static void choose(const struct scene *scene, struct settings *settings,
                   const char *label, double mpp, long seed, long seeds)
{
    const char *name;
    double logs = 0.0, least = (double)INFINITY, bdpt = 0.0;
    int count = 0;
    settings->integrator = "auto";
    for (; (name = race_candidate(scene, count)) != NULL; count++) {
        struct settings s = *settings;
        s.p_large = 0.3; /* as pilots have it */
        double work = path_work(integrator_find(name), scene, &s, NULL);
        logs += log(work);
        least = fmin(least, work);
        bdpt = strcmp(name, "bdpt") == 0 ? work : bdpt;
    }
    settings->mutations_per_pixel = mpp * bdpt / fmin(exp(logs / count), 2.0 * least);
    for (long i = seed; i < seed + seeds; i++) {
        settings->seed = i;
        struct round_limits limits = {0};
        struct race_figures f;
        struct race *race = race_create(scene, settings);
        while (race_advance(race, &limits)) {
        }
        race_result(race, &f);
        race_destroy(race);
        double pixels = (double)scene->camera.width * scene->camera.height;
        printf("%s,%g,%ld,%s,%.4g,%.4g,\"%s\"\n", label, mpp, i, f.chosen,
               f.equal_paths / pixels / settings->mutations_per_pixel, f.relmse,
               f.reason);
        fflush(stdout);
    }
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        int words;
    } commands[] = {{"render", 8}, {"errors", 3}, {"choose", 7}};
    struct settings settings;
    int c = 0;
    while (c < 3 && (argc < commands[c].words || strcmp(argv[1], commands[c].name) != 0))
        c++;
    if (c == 3) {
        fprintf(stderr,
                "usage: race render SCENE LABEL NAME SEED COUNT FOLDER "
                "integrator=I seconds=S [key=value ...]\n"
                "       race errors FOLDER <ROWS\n"
                "       race choose SCENE LABEL MPP SEED SEEDS [key=value ...]\n");
        return 2;
    }
    if (c == 1) {
        errors(argv[2]);
        return 0;
    }
    settings_init(&settings);
    for (int i = commands[c].words; i < argc; i++)
        program_set(&settings, argv[i]);
    struct scene *scene = program_open_scene(argv[2], &settings);
    if (c == 0)
        render(scene, &settings, argv + 3);
    else
        choose(scene, &settings, argv[3], atof(argv[4]), atol(argv[5]), atol(argv[6]));
    scene_destroy(scene);
    return 0;
}

/* What -i auto's choice is held against: the errors that single methods have at the same
 * CPU time, measured once, and what mixes of two of them would have.
 *
 *   race measure SCENE LABEL SECONDS SEED key=value ...
 *     Renders with each method by RUNS seeds from SEED on, each for about SECONDS of CPU
 *     time. A row for each run: label, method, mutations a pixel, seed, CPU seconds,
 *     relMSE without the worst 1 % of pixels, relMSE. With means R1, R2 of all methods'
 *     runs by two other seeds the expectation of (X - R1)(X - R2) is the variance of X:
 *     no reference, and no noise of one, is in the errors.
 *     Then rows of mixes, label, "independent+chain/side", and the same columns: the
 *     error of w X + (1 - w) Y, which takes twice the time. w is inverse to the variances
 *     in tiles of that side (0: the whole picture), which the runs by the other seeds
 *     tell.
 *   race choose SCENE LABEL MPP SEED SEEDS key=value ...
 *     Runs the pilots only, for a budget of as much work as bdpt has in MPP samples a
 *     pixel. A row for each seed: label, mpp, seed, chosen, share of the pilots, the
 *     predicted relMSE, and the reason. */

#include "program.h"

#include "base/mem.h"
#include "image/metric.h"
#include "integrator/path_work.h"
#include "integrator/race.h"
#include "integrator/registry.h"

#include <math.h>

#define RUNS        3
#define METHODS     4
#define CALIBRATION 32 /* mutations a pixel */

static const char *const methods[METHODS] = {"pt", "bdpt", "pssmlt", "mmlt"};
static const int sides[] = {0, 16, 8, 4};

struct one_run {
    struct image *image;
    double mpp, cpu; /* cpu: seconds */
};

struct cell {
    const char *label;
    int width, height;
    long seed, values; /* values: of a picture */
    struct one_run runs[METHODS][RUNS];
    double variance[METHODS]; /* from differences of runs, trimmed */
    double *scale;            /* [values], of relMSE */
    double *reference[RUNS];  /* [values], mean of all methods by a seed */
};

static struct one_run render(const struct scene *scene, struct settings *settings,
                             const char *method, double mpp, long seed)
{
    settings->integrator = method;
    settings->mutations_per_pixel = mpp;
    settings->seed = seed;
    struct run_result r = program_render(scene, settings);
    struct one_run run = {r.image, mpp, r.seconds_cpu};
    r.image = NULL;
    run_result_deinit(&r);
    return run;
}

static void render_all(const struct scene *scene, struct settings *settings,
                       double seconds, struct cell *cell)
{
    for (int m = 0; m < METHODS; m++) {
        struct one_run first = render(scene, settings, methods[m], CALIBRATION, 99);
        double mpp = fmax(ceil(CALIBRATION * seconds / first.cpu), 4.0);
        image_destroy(first.image);
        for (int i = 0; i < RUNS; i++)
            cell->runs[m][i] = render(scene, settings, methods[m], mpp, cell->seed + i);
    }
}

/* --- references ----------------------------------------------------------------------
 */

/* Means over the channels of a pixel. */
static void means_of(double *errors, const struct cell *cell, double *all,
                     double *trimmed)
{
    long pixels = cell->values / 3;
    for (long j = 0; j < pixels; j++)
        errors[j] = (errors[3 * j] + errors[3 * j + 1] + errors[3 * j + 2]) / 3.0;
    metric_means(errors, pixels, all, trimmed);
}

static double value(const struct cell *cell, int method, int run, long k)
{
    return (double)cell->runs[method][run].image->pixels[k];
}

static void find_scale(struct cell *cell)
{
    for (long k = 0; k < cell->values; k++) {
        double sum = 0.0;
        for (int m = 0; m < METHODS; m++)
            for (int i = 0; i < RUNS; i++)
                sum += value(cell, m, i, k);
        sum /= METHODS * RUNS;
        cell->scale[k] = 1.0 / (sum * sum + METRIC_RELATIVE_FLOOR);
    }
}

static void find_variances(struct cell *cell)
{
    double *errors = mem_alloc((size_t)cell->values, sizeof *errors), all;
    for (int m = 0; m < METHODS; m++) {
        for (long k = 0; k < cell->values; k++) {
            errors[k] = 0.0;
            for (int i = 0; i < RUNS; i++) {
                double d = value(cell, m, i, k) - value(cell, m, (i + 1) % RUNS, k);
                errors[k] += d * d / (2 * RUNS) * cell->scale[k];
            }
        }
        means_of(errors, cell, &all, &cell->variance[m]);
    }
    mem_free(errors);
}

static void find_references(struct cell *cell)
{
    find_scale(cell);
    find_variances(cell);
    for (int i = 0; i < RUNS; i++)
        for (long k = 0; k < cell->values; k++) {
            double sum = 0.0, weights = 0.0;
            for (int m = 0; m < METHODS; m++) {
                double w = 1.0 / fmax(cell->variance[m], 1e-12);
                sum += w * value(cell, m, i, k);
                weights += w;
            }
            cell->reference[i][k] = sum / weights;
        }
    for (long k = 0; k < cell->values; k++) {
        double mean = 0.0;
        for (int i = 0; i < RUNS; i++)
            mean += cell->reference[i][k] / RUNS;
        cell->scale[k] = 1.0 / (mean * mean + METRIC_RELATIVE_FLOOR);
    }
}

/* --- errors --------------------------------------------------------------------------
 */

/* Of a picture by the run of that number; all and without the worst 1 % of pixels, which
 * the squared differences from both references tell. */
static void errors_of(const struct cell *cell, const double *picture, int run,
                      double *all, double *trimmed)
{
    const double *a = cell->reference[(run + 1) % RUNS];
    const double *b = cell->reference[(run + 2) % RUNS];
    long pixels = cell->values / 3;
    double *squares = mem_alloc((size_t)pixels, sizeof *squares);
    double *sorted = mem_alloc((size_t)pixels, sizeof *sorted);
    double ignored, sum = 0.0, left = 0.0;
    for (long k = 0; k < cell->values; k++) {
        double d = picture[k] - 0.5 * (a[k] + b[k]);
        squares[k / 3] += d * d * cell->scale[k];
    }
    memcpy(sorted, squares, (size_t)pixels * sizeof *sorted);
    metric_means(sorted, pixels, &ignored, &ignored);
    double most = sorted[pixels - 1 - pixels / METRIC_TRIM];
    long kept = 0;
    for (long j = 0; j < pixels; j++) {
        double e = 0.0;
        for (long k = 3 * j; k < 3 * j + 3; k++)
            e += (picture[k] - a[k]) * (picture[k] - b[k]) * cell->scale[k] / 3.0;
        sum += e;
        if (squares[j] <= most)
            left += e, kept++;
    }
    *all = sum / (double)pixels;
    *trimmed = left / (double)kept;
    mem_free(squares);
    mem_free(sorted);
}

static void print_row(const struct cell *cell, const char *name, double mpp, int run,
                      double cpu, const double *picture)
{
    double all, trimmed;
    errors_of(cell, picture, run, &all, &trimmed);
    printf("%s,%s,%g,%ld,%.4g,%.5g,%.5g\n", cell->label, name, mpp, cell->seed + run, cpu,
           trimmed, all);
}

/* Mean relative variance in the tile around each pixel, by the other two runs. */
static void tile_variance(const struct cell *cell, int method, int run, int side,
                          double *out)
{
    int across = side > 0 ? (cell->width + side - 1) / side : 1;
    int down = side > 0 ? (cell->height + side - 1) / side : 1;
    double *sum = mem_alloc((size_t)across * (size_t)down, sizeof *sum);
    for (int pass = 0; pass < 2; pass++)
        for (long k = 0; k < cell->values; k++) {
            int x = (int)(k / 3 % cell->width), y = (int)(k / 3 / cell->width);
            int tile = side > 0 ? y / side * across + x / side : 0;
            double d = value(cell, method, (run + 1) % RUNS, k) -
                       value(cell, method, (run + 2) % RUNS, k);
            if (pass == 0)
                sum[tile] += d * d * cell->scale[k];
            else
                out[k] = sum[tile];
        }
    mem_free(sum);
}

static void print_mix(const struct cell *cell, int free, int chain, int side)
{
    size_t count = (size_t)cell->values;
    double *v[2] = {mem_alloc(count, sizeof **v), mem_alloc(count, sizeof **v)};
    double *picture = mem_alloc(count, sizeof *picture);
    char name[64];
    snprintf(name, sizeof name, "%s+%s/%d", methods[free], methods[chain], side);
    for (int i = 0; i < RUNS; i++) {
        tile_variance(cell, free, i, side, v[0]);
        tile_variance(cell, chain, i, side, v[1]);
        for (long k = 0; k < cell->values; k++) {
            double sum = v[0][k] + v[1][k], w = sum > 0.0 ? v[1][k] / sum : 0.5;
            picture[k] = w * value(cell, free, i, k) +
                         (1.0 - w) * value(cell, chain, i, k);
        }
        print_row(cell, name, 0.0, i, cell->runs[free][i].cpu + cell->runs[chain][i].cpu,
                  picture);
    }
    mem_free(v[0]);
    mem_free(v[1]);
    mem_free(picture);
}

static void print_all(const struct cell *cell)
{
    double *picture = mem_alloc((size_t)cell->values, sizeof *picture);
    for (int m = 0; m < METHODS; m++)
        for (int i = 0; i < RUNS; i++) {
            const struct one_run *run = &cell->runs[m][i];
            for (long k = 0; k < cell->values; k++)
                picture[k] = value(cell, m, i, k);
            print_row(cell, methods[m], run->mpp, i, run->cpu, picture);
        }
    mem_free(picture);
    for (int free = 0; free < 2; free++)
        for (int chain = 2; chain < 4; chain++)
            for (size_t s = 0; s < sizeof sides / sizeof *sides; s++)
                print_mix(cell, free, chain, sides[s]);
}

static void measure(const struct scene *scene, struct settings *settings,
                    const char *label, double seconds, long seed)
{
    struct cell cell = {.label = label,
                        .width = scene->camera.width,
                        .height = scene->camera.height,
                        .seed = seed};
    cell.values = 3L * cell.width * cell.height;
    cell.scale = mem_alloc((size_t)cell.values, sizeof *cell.scale);
    for (int i = 0; i < RUNS; i++)
        cell.reference[i] = mem_alloc((size_t)cell.values, sizeof **cell.reference);
    render_all(scene, settings, seconds, &cell);
    find_references(&cell);
    print_all(&cell);
    for (int i = 0; i < RUNS; i++) {
        mem_free(cell.reference[i]);
        for (int m = 0; m < METHODS; m++)
            image_destroy(cell.runs[m][i].image);
    }
    mem_free(cell.scale);
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
    struct settings settings;
    bool measures = argc > 1 && strcmp(argv[1], "measure") == 0;
    int first = measures ? 6 : 7;
    if (argc < first || (!measures && strcmp(argv[1], "choose") != 0)) {
        fprintf(stderr,
                "usage: race measure SCENE LABEL SECONDS SEED [key=value ...]\n"
                "       race choose SCENE LABEL MPP SEED SEEDS [key=value ...]\n");
        return 2;
    }
    settings_init(&settings);
    for (int i = first; i < argc; i++)
        program_set(&settings, argv[i]);
    struct scene *scene = program_open_scene(argv[2], &settings);
    if (measures)
        measure(scene, &settings, argv[3], atof(argv[4]), atol(argv[5]));
    else
        choose(scene, &settings, argv[3], atof(argv[4]), atol(argv[5]), atol(argv[6]));
    scene_destroy(scene);
    return 0;
}

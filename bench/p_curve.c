/* The error of a picture as a function of a constant p_l, and what a rule would choose,
 * so that a change of the rule is judged without rendering whole pictures again.
 *
 *   p_curve measure SCENE LABEL SEED SEEDS key=value ...
 *     Renders with each of the constants by SEEDS seeds from SEED on, to the budget of
 *     the settings. A row for each run: label, integrator, mutations a pixel, seed, p_l,
 *     error, mutations, CPU seconds, relMSE. The error is relMSE without the worst 1 % of
 *     pixels. Both are against the mean of all n runs. A run i is in that mean itself, so
 *     that its error is expected to be
 *       D_i = (1 - 1/n)^2 V_i + sum over the others V_j / n^2,
 *     V the errors against the truth; with T = sum of V = sum of D / (1 - 1/n) this gives
 *     V_i = (D_i - T / n^2) / (1 - 2/n).
 *   p_curve steps SCENE LABEL SEED SEEDS key=value ...
 *     The same with p_l by the settings, for small steps of widths s2 = 1/64 and sigma =
 *     .01 times each of the factors, which stand in place of p_l.
 *   p_curve rule SCENE LABEL SEED SEEDS key=value ...
 *     Measures the start only, as a render would. A row for each: label, integrator,
 *     mutations a pixel, seed, p_l, p_l by zsolnai2013, mutations of a chain in the
 *     start, greatest regret between halves, share clipped, the predicted error and cost
 *     at each value of p (apart by spaces, errors 0 without a curve), and the reason. */

#include "program.h"

#include "image/metric.h"

#include <math.h>

#define VALUES_MOST 7
#define SEEDS_MOST  16

static const double constants[] = {0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9};
static const double factors[] = {0.5, 1.0, 2.0, 4.0, 8.0};

struct job {
    const struct scene *scene;
    struct settings *settings;
    const char *label;
    long seed, seeds;
};

struct one_run {
    struct image *image;
    double error[2];       /* without the worst 1 % of pixels, and with these */
    double mutations, cpu; /* cpu: seconds */
};

static void set_p_large(const struct job *job, double p)
{
    job->settings->p_large = p;
}

static void set_width(const struct job *job, double factor)
{
    job->settings->s2 = factor / 64.0;
    job->settings->sigma = factor * 0.01;
}

static struct one_run measure_one(const struct job *job, long seed)
{
    job->settings->seed = seed;
    struct run_result r = program_render(job->scene, job->settings);
    struct one_run run = {r.image, {0.0}, r.statistics.paths, r.seconds_cpu};
    r.image = NULL;
    run_result_deinit(&r);
    return run;
}

static void find_errors(struct one_run *run, const struct image *reference)
{
    struct metric metric;
    struct err err = {0};
    if (!metric_compare(run->image, reference, &metric, &err))
        program_die(&err);
    run->error[0] = metric.relmse_trimmed;
    run->error[1] = metric.relmse;
}

static struct image *mean_of(const struct one_run *runs, int count)
{
    const struct image *first = runs[0].image;
    struct image *mean = image_create(first->width, first->height);
    long values = 3L * first->width * first->height;
    for (long k = 0; k < values; k++) {
        double sum = 0.0;
        for (int i = 0; i < count; i++)
            sum += (double)runs[i].image->pixels[k];
        mean->pixels[k] = (float)(sum / count);
    }
    return mean;
}

static void measure(const struct job *job, void (*set)(const struct job *job, double v),
                    const double *values, int value_count)
{
    struct one_run runs[SEEDS_MOST * VALUES_MOST] = {{NULL, {0.0}, 0.0, 0.0}};
    int count = (int)job->seeds * value_count;
    double n = count, total[2] = {0.0};
    for (int i = 0; i < count; i++) {
        set(job, values[i % value_count]);
        runs[i] = measure_one(job, job->seed + i / value_count);
    }
    struct image *mean = mean_of(runs, count);
    for (int i = 0; i < count; i++) {
        find_errors(&runs[i], mean);
        for (int k = 0; k < 2; k++)
            total[k] += runs[i].error[k] / (1.0 - 1.0 / n);
        image_destroy(runs[i].image);
    }
    image_destroy(mean);
    for (int i = 0; i < count; i++) {
        double error[2];
        for (int k = 0; k < 2; k++)
            error[k] = (runs[i].error[k] - total[k] / (n * n)) / (1.0 - 2.0 / n);
        printf("%s,%s,%g,%ld,%g,%.5g,%.0f,%.4g,%.5g\n", job->label,
               job->settings->integrator, job->settings->mutations_per_pixel,
               job->seed + i / value_count, values[i % value_count], error[0],
               runs[i].mutations, runs[i].cpu, error[1]);
    }
}

static void print_values(const double *values)
{
    for (int i = 0; i < TOURS_POINTS; i++)
        printf("%s%.4g", i ? " " : ",", values[i]);
}

static void choose(const struct job *job)
{
    for (long seed = job->seed; seed < job->seed + job->seeds; seed++) {
        struct run_options options = {
            .scene = job->scene, .settings = job->settings, .startup_only = true};
        struct run_result r = {0};
        struct err err = {0};
        job->settings->seed = seed;
        if (!run_render(&options, &r, &err))
            program_die(&err);
        const struct run_statistics *s = &r.statistics;
        const struct tours_choice *c = &s->tours;
        printf("%s,%s,%g,%ld,%.5f,%.5f,%.0f,%.4g,%.4g", job->label,
               job->settings->integrator, job->settings->mutations_per_pixel, seed,
               s->plarge.p_l, s->p_l_zsolnai2013, s->start_mutations / (double)s->chains,
               c->halves, c->curve.clipped);
        print_values(c->curve.relmse);
        print_values(c->curve.cost);
        printf(",\"%s\"\n", s->plarge.reason);
        run_result_deinit(&r);
    }
}

int main(int argc, char **argv)
{
    struct settings settings;
    bool rule = argc > 1 && strcmp(argv[1], "rule") == 0;
    bool steps = argc > 1 && strcmp(argv[1], "steps") == 0;
    if (argc < 6 || (!rule && !steps && strcmp(argv[1], "measure") != 0)) {
        fprintf(stderr, "usage: p_curve measure|steps|rule SCENE LABEL SEED SEEDS "
                        "[key=value ...]\n");
        return 2;
    }
    settings_init(&settings);
    if (!rule && !steps)
        program_set(&settings, "large_step_probability=0.5");
    else
        program_set(&settings, "rule=tours");
    for (int i = 6; i < argc; i++)
        program_set(&settings, argv[i]);
    struct err err = {0};
    if (!settings_check(&settings, &err))
        program_die(&err);
    struct scene *scene = program_open_scene(argv[2], &settings);
    struct job job = {scene, &settings, argv[3], atol(argv[4]), atol(argv[5])};
    if (job.seeds < 1 || job.seeds > SEEDS_MOST) {
        fprintf(stderr, "p_curve: 1 to %d seeds\n", SEEDS_MOST);
        return 2;
    }
    if (rule)
        choose(&job);
    else if (steps)
        measure(&job, set_width, factors, sizeof factors / sizeof *factors);
    else
        measure(&job, set_p_large, constants, sizeof constants / sizeof *constants);
    scene_destroy(scene);
    return 0;
}

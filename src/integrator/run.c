#include "integrator/run.h"

#include "base/clock.h"
#include "base/mem.h"
#include "integrator/registry.h"

#define SNAPSHOT_FIRST 0.1  /* s */
#define SNAPSHOT_RATIO 1.25 /* next over last, in time */
#define PROGRESS_EVERY 0.1  /* s */

struct run {
    const struct run_options *options;
    const struct integrator_type *type;
    void *integrator;
    struct image *picture;
    double wall, cpu; /* rendering only */
    double next_snapshot, next_progress;
    double last_row; /* wall at the last row, -1 before the first */
};

static double pixels(const struct run *run)
{
    return (double)run->picture->width * (double)run->picture->height;
}

static bool advance(struct run *run)
{
    struct round_limits limits = {.seconds_used = run->wall};
    double wall = clock_wall(), cpu = clock_cpu();
    bool more = run->type->advance(run->integrator, &limits);
    run->wall += clock_wall() - wall;
    run->cpu += clock_cpu() - cpu;
    return more;
}

static void report_progress(struct run *run)
{
    const struct run_options *o = run->options;
    if (o->on_progress == NULL || run->wall < run->next_progress)
        return;
    run->next_progress = run->wall + PROGRESS_EVERY;
    struct run_statistics s;
    run->type->statistics(run->integrator, &s);
    double share = o->settings->seconds > 0.0 ? run->wall / o->settings->seconds
                                              : run->type->progress(run->integrator);
    struct run_progress p = {
        .share = share < 1.0 ? share : 1.0,
        .wall_s = run->wall,
        .cpu_s = run->cpu,
        .paths = s.paths,
        .acceptance = s.acceptance,
        .p_large = s.plarge.p_l,
        .started = run->type->started(run->integrator),
    };
    o->on_progress(o->hook_ctx, &p);
}

/* Measures the picture against the reference; false to stop. */
static bool error_row(struct run *run, struct err *err)
{
    const struct run_options *o = run->options;
    struct run_statistics s;
    struct error_row row = {.wall_s = run->wall, .cpu_s = run->cpu};
    if (o->reference == NULL || o->on_error_row == NULL || run->last_row == run->wall)
        return true;
    run->last_row = run->wall;
    run->type->picture(run->integrator, run->picture);
    run->type->statistics(run->integrator, &s);
    row.paths = s.paths;
    row.mutations_per_pixel = s.paths / pixels(run);
    return metric_compare(run->picture, o->reference, &row.metric, err) &&
           o->on_error_row(o->hook_ctx, &row);
}

static bool finished(const struct run *run, bool more)
{
    const struct run_options *o = run->options;
    bool out_of_time = o->settings->seconds > 0.0 && run->wall >= o->settings->seconds;
    bool measured = o->startup_only && run->type->started(run->integrator);
    return !more || out_of_time || measured || (o->stop && *o->stop);
}

static bool rounds(struct run *run, struct err *err)
{
    for (bool more = true; more;) {
        more = advance(run);
        report_progress(run);
        if (run->wall >= run->next_snapshot && run->type->started(run->integrator)) {
            while (run->next_snapshot <= run->wall)
                run->next_snapshot *= SNAPSHOT_RATIO;
            if (!error_row(run, err))
                return false;
        }
        if (finished(run, more))
            return error_row(run, err);
    }
    return true;
}

static void conclude(struct run *run, struct run_result *result)
{
    const struct settings *settings = run->options->settings;
    run->type->picture(run->integrator, run->picture);
    run->type->statistics(run->integrator, &result->statistics);
    result->image = run->picture;
    if (run->type->failure_map) {
        result->failure_map = mem_alloc((size_t)pixels(run), sizeof(float));
        run->type->failure_map(run->integrator, result->failure_map);
    }
    if (!run->options->startup_only) {
        struct evidence evidence;
        run->type->evidence(run->integrator, &evidence);
        verdict_find(&evidence, run->picture, &result->verdict);
    }
    result->seconds_total = run->wall;
    result->seconds_cpu = run->cpu;
    result->mutations_per_pixel = result->statistics.paths / pixels(run);
    result->max_depth = settings_depth(settings, run->options->scene);
    result->threads = settings_threads(settings);
    result->interrupted = run->options->stop && *run->options->stop;
}

bool run_render(const struct run_options *options, struct run_result *result,
                struct err *err)
{
    const struct camera *camera = &options->scene->camera;
    struct run run = {
        .options = options,
        .type = integrator_find(options->settings->integrator),
        .picture = image_create(camera->width, camera->height),
        .next_snapshot = SNAPSHOT_FIRST,
        .last_row = -1.0,
    };
    run.integrator = run.type->create(options->scene, options->settings);
    bool ok = rounds(&run, err);
    conclude(&run, result);
    run.type->destroy(run.integrator);
    return ok;
}

void run_result_deinit(struct run_result *result)
{
    image_destroy(result->image);
    mem_free(result->failure_map);
    verdict_deinit(&result->verdict);
    result->image = NULL;
    result->failure_map = NULL;
}

#include "run/run.h"

#include "base/clock.h"
#include "base/machine.h"
#include "base/mem.h"
#include "convergence/past_snapshots.h"
#include "integrator/registry.h"
#include "run/blind_spots.h"

#include <float.h>
#include <limits.h>
#include <math.h>

#define SNAPSHOT_FIRST 0.1  /* s */
#define SNAPSHOT_RATIO 1.25 /* next over last, in time */
#define PROGRESS_EVERY 0.1  /* s */

struct run {
    const struct run_options *options;
    const struct integrator_type *type;
    void *integrator;
    struct image *picture;
    struct past_snapshots past;
    struct until until;
    double wall, cpu; /* s, of rendering only */
    double next_snapshot, next_progress;
    double last_row;        /* `wall` at the last row, -1 before the first */
    bool more;              /* the integrator's budget is not used up */
    double next_checkpoint; /* by the clock, including time that is not rendering */
    struct error_row *rows; /* all rows so far, if there are checkpoints */
    size_t row_count, row_capacity;
};

static double pixels(const struct run *run)
{
    return (double)run->picture->width * (double)run->picture->height;
}

static bool advance(struct run *run)
{
    const struct run_options *o = run->options;
    double wall = clock_wall(), cpu = clock_cpu(), seconds = o->settings->seconds;
    struct round_limits limits = {
        .seconds_used = run->wall,
        .begin = wall,
        .until = seconds > 0.0 ? wall + fmax(seconds - run->wall, DBL_MIN) : 0.0,
        .stop = o->stop,
    };
    bool more = run->type->methods->advance(run->integrator, &limits);
    run->wall += clock_wall() - wall;
    run->cpu += clock_cpu() - cpu;
    return more;
}

/* The length of the run so far, in the unit of its budget. */
static double length(const struct run *run)
{
    const struct settings *s = run->options->settings;
    return s->seconds > 0.0
               ? run->wall
               : s->mutations_per_pixel * run->type->methods->progress(run->integrator);
}

static void look_back(struct run *run)
{
    struct image *wanted = past_snapshots_next(&run->past, length(run));
    if (wanted)
        run->type->methods->picture(run->integrator, wanted);
}

static void report_progress(struct run *run)
{
    const struct run_options *o = run->options;
    if (o->on_progress == NULL || run->wall < run->next_progress)
        return;
    run->next_progress = run->wall + PROGRESS_EVERY;
    struct run_statistics s;
    run->type->methods->statistics(run->integrator, &s);
    double share = o->settings->seconds > 0.0
                       ? run->wall / o->settings->seconds
                       : run->type->methods->progress(run->integrator);
    struct run_progress p = {
        .share = share < 1.0 ? share : 1.0,
        .wall_s = run->wall,
        .cpu_s = run->cpu,
        .paths = s.paths,
        .acceptance = s.acceptance,
        .p_large = s.plarge.p_l,
        .started = run->type->methods->started(run->integrator),
    };
    o->on_progress(o->hook_ctx, &p);
}

/* A checkpoint contains the rows so far: rows that an interrupted run wrote after its
 * last checkpoint are dropped on resume. */
static bool report_row(struct run *run, const struct error_row *row)
{
    const struct run_options *o = run->options;
    if (o->checkpoint || o->resume) {
        run->rows = mem_grow(run->rows, &run->row_capacity, run->row_count + 1,
                             sizeof *run->rows);
        run->rows[run->row_count++] = *row;
    }
    run->last_row = row->wall_s;
    return o->on_error_row(o->hook_ctx, row);
}

static void take_figures(const struct run *run, const struct run_statistics *s,
                         struct error_row *row)
{
    row->paths = s->paths;
    row->mutations_per_pixel = s->paths / pixels(run);
    row->b = s->b;
    row->b_se = s->b_se;
    row->eta_s = run->type->methods->chains ? s->whole.eta_s : (double)NAN;
    row->eta_l = run->type->methods->chains ? s->whole.eta_l : (double)NAN;
    row->eta_0 = run->type->methods->chains ? s->whole.eta_0 : (double)NAN;
    row->acceptance = s->acceptance;
    row->failure_rate = s->failure_rate;
    row->nonfinite = s->nonfinite;
    row->saturated = s->saturated;
}

/* Measures the picture against the reference; false stops the run. */
static bool error_row(struct run *run, struct err *err)
{
    const struct run_options *o = run->options;
    struct run_statistics s;
    struct error_row row = {.wall_s = run->wall, .cpu_s = run->cpu};
    if (o->reference == NULL || o->on_error_row == NULL || run->last_row == run->wall)
        return true;
    run->type->methods->picture(run->integrator, run->picture);
    run->type->methods->statistics(run->integrator, &s);
    take_figures(run, &s, &row);
    return metric_compare(run->picture, o->reference, &row.metric, err) &&
           report_row(run, &row);
}

static void plan_snapshot(struct run *run)
{
    double every = run->options->rows_every;
    if (every > 0.0)
        run->next_snapshot = run->wall + every - fmod(run->wall, every);
    while (every <= 0.0 && run->next_snapshot <= run->wall)
        run->next_snapshot *= SNAPSHOT_RATIO;
}

/* Clamps pixels to the range of float; returns the number of clamped values. */
static double clamp_picture(struct image *picture)
{
    double count = 0.0;
    for (long i = 0; i < 3L * picture->width * picture->height; i++) {
        float *value = &picture->pixels[i];
        if (isfinite(*value))
            continue;
        *value = isnan(*value) ? 0.0f : copysignf(FLT_MAX, *value);
        count += 1.0;
    }
    return count;
}

/* The verdict on the run so far. lost: number of non-finite and clamped values. */
static void find_verdict(struct run *run, double lost, struct verdict *verdict)
{
    struct evidence evidence;
    char blind_to[BLIND_TEXT];
    const struct run_options *o = run->options;
    blind_spots(o->scene->desc, o->settings, settings_depth(o->settings, o->scene),
                blind_to);
    run->type->methods->evidence(run->integrator, &evidence);
    evidence.before = past_snapshots_latest(&run->past, length(run));
    evidence.lost = lost;
    evidence.blind_to = blind_to;
    verdict_find(&evidence, run->picture, verdict);
}

/* Checks whether the run may end before its budget. Does not count as rendering time. */
static void check_until(struct run *run)
{
    const struct settings *settings = run->options->settings;
    struct run_statistics s;
    struct verdict verdict;
    if (!settings_until(settings) || !run->type->methods->started(run->integrator))
        return;
    run->type->methods->statistics(run->integrator, &s);
    double mutations_per_pixel = s.paths / pixels(run);
    if (!until_due(&run->until, mutations_per_pixel))
        return;
    run->type->methods->picture(run->integrator, run->picture);
    double lost = s.nonfinite + s.saturated + clamp_picture(run->picture);
    find_verdict(run, lost, &verdict);
    until_look(&run->until, mutations_per_pixel, &verdict);
    verdict_deinit(&verdict);
}

static bool until_reached(const struct run *run)
{
    return run->until.reached && settings_until(run->options->settings);
}

static bool finished(const struct run *run)
{
    const struct run_options *o = run->options;
    bool out_of_time = o->settings->seconds > 0.0 && run->wall >= o->settings->seconds;
    bool measured = o->startup_only && run->type->methods->started(run->integrator);
    return !run->more || out_of_time || measured || until_reached(run) ||
           mem_exhausted() || (o->stop && *o->stop);
}

/* --- checkpoints ------------------------------------------------------------------ */

static void pack_row(struct pack *pack, struct error_row *row)
{
    struct metric *m = &row->metric;
    double *const values[] = {
        &row->wall_s,       &row->cpu_s,
        &row->paths,        &row->mutations_per_pixel,
        &m->mean_ratio,     &m->mean_ratio_r,
        &m->mean_ratio_g,   &m->mean_ratio_b,
        &m->rmse,           &m->relmse,
        &m->relmse_trimmed, &row->b,
        &row->b_se,         &row->eta_s,
        &row->eta_l,        &row->eta_0,
        &row->acceptance,   &row->failure_rate,
        &row->nonfinite,    &row->saturated,
    };
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        pack_double(pack, "row", values[i]);
    pack_long(pack, "nonfinite", &m->nonfinite, 0, LONG_MAX);
}

static void pack_run(struct run *run, struct pack *pack)
{
    pack_double(pack, "wall", &run->wall);
    pack_double(pack, "cpu", &run->cpu);
    pack_double(pack, "next_snapshot", &run->next_snapshot);
    pack_flag(pack, "more", &run->more);
    past_snapshots_pack(pack, &run->past);
    until_pack(pack, &run->until);
    run->type->methods->pack(run->integrator, pack);
}

static bool write_checkpoint(struct run *run, struct err *err)
{
    const struct settings *settings = run->options->settings;
    struct run_statistics s;
    run->type->methods->statistics(run->integrator, &s);
    struct checkpoint_head head = {
        .budget_seconds = settings->seconds,
        .budget_mutations = settings->mutations_per_pixel,
        .seconds = run->wall,
        .mutations = s.paths / pixels(run),
        .started = run->type->methods->started(run->integrator),
    };
    struct pack *pack = checkpoint_create(run->options->checkpoint, &head, err);
    if (pack == NULL)
        return false;
    long rows = (long)run->row_count;
    pack_long(pack, "rows", &rows, 0, rows);
    for (long i = 0; i < rows; i++)
        pack_row(pack, &run->rows[i]);
    pack_run(run, pack);
    bool ok = pack_close(pack, err);
    run->next_checkpoint = clock_wall() + run->options->checkpoint->every;
    return ok;
}

static bool serve_checkpoint(struct run *run, bool last, struct err *err)
{
    bool due = run->options->checkpoint && (last || clock_wall() >= run->next_checkpoint);
    return !due || write_checkpoint(run, err);
}

/* Reads the state from the file and closes it. */
static bool resume(struct run *run, struct err *err)
{
    const struct run_options *o = run->options;
    struct pack *pack = o->resume->pack;
    struct error_row row;
    long rows = 0;
    bool ok = true;
    pack_long(pack, "rows", &rows, 0, LONG_MAX);
    for (long i = 0; ok && pack_ok(pack) && i < rows; i++) {
        pack_row(pack, &row);
        ok = !pack_ok(pack) || o->on_error_row == NULL || report_row(run, &row);
    }
    pack_run(run, pack);
    o->resume->pack = NULL;
    if (!pack_close(pack, err) || !ok)
        return false;
    if (o->resume->other_budget)
        run->more = run->type->methods->progress(run->integrator) < 1.0;
    return true;
}

/* --- the run ---------------------------------------------------------------------- */

static bool rounds(struct run *run, struct err *err)
{
    for (bool last = run->options->resume && finished(run); !last;) {
        run->more = advance(run);
        look_back(run);
        check_until(run);
        report_progress(run);
        if (run->wall >= run->next_snapshot &&
            run->type->methods->started(run->integrator)) {
            plan_snapshot(run);
            if (!error_row(run, err))
                return false;
        }
        last = finished(run);
        if (!serve_checkpoint(run, last, err))
            return false;
    }
    return error_row(run, err);
}

const char *run_end_name(enum run_end end)
{
    static const char *const names[] = {"budget", "start", "until", "interrupted",
                                        "out of memory"};
    return names[end];
}

static enum run_end end_of(const struct run *run)
{
    const struct run_options *o = run->options;
    if (mem_exhausted())
        return RUN_MEMORY;
    if (until_reached(run))
        return RUN_UNTIL;
    if (o->stop && *o->stop)
        return RUN_INTERRUPTED;
    return o->startup_only ? RUN_START : RUN_BUDGET;
}

static void conclude(struct run *run, struct run_result *result)
{
    const struct settings *settings = run->options->settings;
    run->type->methods->picture(run->integrator, run->picture);
    run->type->methods->statistics(run->integrator, &result->statistics);
    result->statistics.saturated += clamp_picture(run->picture);
    result->image = run->picture;
    if (run->type->methods->layers)
        run->type->methods->layers(run->integrator, &result->layers);
    if (!run->options->startup_only)
        find_verdict(run, result->statistics.nonfinite + result->statistics.saturated,
                     &result->verdict);
    layers_refer(&result->layers, "se.Y", result->verdict.se);
    layers_refer(&result->layers, "rhat.Y", result->verdict.rhat);
    layers_refer(&result->layers, "ess.Y", result->verdict.ess);
    result->seconds_total = run->wall;
    result->seconds_cpu = run->cpu;
    result->mutations_per_pixel = result->statistics.paths / pixels(run);
    result->max_depth = settings_depth(settings, run->options->scene);
    result->threads = settings_threads(settings);
    result->interrupted = run->options->stop && *run->options->stop;
    result->until = run->until;
    result->end = end_of(run);
}

/* Expected length of the run; 0 if it may end at any time, so that snapshots begin at
 * once. */
static double expected_length(const struct settings *s)
{
    if (settings_until(s))
        return 0.0;
    return s->seconds > 0.0 ? s->seconds : s->mutations_per_pixel;
}

static bool reserve_memory(const struct scene *scene, struct err *err)
{
    size_t bytes = run_reserve(scene);
    return mem_reserve(bytes) ||
           err_set(err, ERR_MEMORY, NULL,
                   "out of memory: the picture takes %.0f MB to be written: give a "
                   "smaller --size",
                   (double)bytes / 0x1p20);
}

/* Without a picture there is nothing to write. */
static bool have_memory(const struct run *run, bool begun, struct err *err)
{
    if (!mem_exhausted())
        return true;
    return err_set(err, ERR_MEMORY, NULL, "out of memory %s %.3g s of rendering",
                   begun ? "after" : "before", run->wall);
}

bool run_render(const struct run_options *options, struct run_result *result,
                struct err *err)
{
    const struct camera *camera = &options->scene->camera;
    struct run run = {
        .options = options,
        .type = integrator_find(options->settings->integrator),
        .next_snapshot = options->rows_every > 0.0 ? options->rows_every : SNAPSHOT_FIRST,
        .last_row = -1.0,
    };
    result->memory = run_memory(options->scene, options->settings);
    blind_spots(options->scene->desc, options->settings,
                settings_depth(options->settings, options->scene), result->blind_to);
    if (!run_check_memory(&result->memory, machine_memory_available(), options->settings,
                          err) ||
        !reserve_memory(options->scene, err))
        return false;
    run.picture = image_create(camera->width, camera->height);
    run.integrator = run.type->methods->create(run.type, options->scene,
                                               options->settings);
    run.more = true;
    until_init(&run.until, options->settings->until_converged,
               options->settings->until_relmse);
    past_snapshots_init(&run.past, camera->width, camera->height,
                        expected_length(options->settings));
    if (options->checkpoint)
        run.next_checkpoint = clock_wall() + options->checkpoint->every;
    bool begun = have_memory(&run, false, err) &&
                 (options->resume == NULL || resume(&run, err));
    bool ok = begun && rounds(&run, err) && have_memory(&run, true, err);
    mem_release_reserve(); /* the reserve is for what follows */
    if (begun)
        conclude(&run, result);
    else
        image_destroy(run.picture);
    run.type->methods->destroy(run.integrator);
    past_snapshots_deinit(&run.past);
    mem_free(run.rows);
    return ok;
}

void run_result_deinit(struct run_result *result)
{
    image_destroy(result->image);
    layers_deinit(&result->layers);
    verdict_deinit(&result->verdict);
    result->image = NULL;
}

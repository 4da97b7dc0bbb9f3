#include "run/run.h"

#include "base/clock.h"
#include "base/machine.h"
#include "base/mem.h"
#include "base/ranks.h"
#include "integrator/light_classes.h"
#include "integrator/registry.h"
#include "path/coverage.h"
#include "path/features.h"
#include "run/blind_spots.h"
#include "run/run_pack.h"
#include "run/run_ranks.h"
#include "run/run_rows.h"
#include "run/run_view.h"

#include <float.h>
#include <math.h>

#define SNAPSHOT_FIRST 0.1 /* s */
#define PROGRESS_EVERY 0.1 /* s */

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
    struct fixed_picture picture;
    if (!past_snapshots_due(&run->past, length(run)))
        return;
    run->type->methods->fixed_picture(run->integrator, &picture);
    past_snapshots_take(&run->past, length(run), &picture);
}

static void report_progress(struct run *run)
{
    const struct run_options *o = run->options;
    if (o->on_progress == NULL || run->wall < run->next_progress)
        return;
    run->next_progress = run->wall + PROGRESS_EVERY;
    struct run_counts counts;
    run->type->methods->counts(run->integrator, &counts);
    double share = o->settings->seconds > 0.0
                       ? run->wall / o->settings->seconds
                       : run->type->methods->progress(run->integrator);
    struct run_progress p = {
        .share = share < 1.0 ? share : 1.0,
        .wall_s = run->wall,
        .cpu_s = run->cpu,
        .paths = counts.paths,
        .acceptance = counts.acceptance,
        .p_large = counts.p_large,
        .started = run->type->methods->started(run->integrator),
    };
    o->on_progress(o->hook_ctx, &p);
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
    struct image *now = NULL;
    run->type->methods->evidence(run->integrator, &evidence);
    evidence.before = past_snapshots_latest(&run->past, length(run));
    if (evidence.before) {
        struct fixed_picture picture;
        now = image_create(run->picture->width, run->picture->height);
        run->type->methods->fixed_picture(run->integrator, &picture);
        fixed_picture_write(&picture, now);
    }
    evidence.now = now;
    evidence.lost = lost;
    evidence.edges_cut = (double)*run->options->scene->edges_cut;
    evidence.blind_to = blind_to;
    verdict_find(&evidence, run->picture, verdict);
    image_destroy(now);
}

/* Checks whether the run may end before its budget. Does not count as rendering time. */
static void check_until(struct run *run)
{
    struct run_statistics s;
    struct run_counts counts;
    struct verdict verdict;
    if (!until_wanted(&run->until) || !run->type->methods->started(run->integrator))
        return;
    run->type->methods->counts(run->integrator, &counts);
    double mutations_per_pixel = counts.paths / run_pixels(run);
    if (!until_due(&run->until, mutations_per_pixel))
        return;
    run->type->methods->statistics(run->integrator, &s);
    run->type->methods->picture(run->integrator, run->picture);
    double lost = s.nonfinite + s.saturated + clamp_picture(run->picture);
    find_verdict(run, lost, &verdict);
    until_look(&run->until, mutations_per_pixel, &verdict);
    verdict_deinit(&verdict);
}

static bool finished(const struct run *run)
{
    if (run->ranks)
        return !run->more || run->due & (RANKS_STOP | RANKS_OVER);
    const struct run_options *o = run->options;
    bool out_of_time = o->settings->seconds > 0.0 && run->wall >= o->settings->seconds;
    bool measured = o->startup_only && run->type->methods->started(run->integrator);
    return !run->more || out_of_time || measured || run->until.reached ||
           mem_exhausted() || (o->stop && *o->stop);
}

/* --- the run ---------------------------------------------------------------------- */

/* The measured start belongs to the first part. */
static void leave_start(struct run *run)
{
    if (run->options->part.index > 0)
        past_snapshots_clear(&run->past);
}

/* What is due by this rank; the first one keeps the times of rows and checkpoints. */
static unsigned own_due(struct run *run, bool started)
{
    const struct run_options *o = run->options;
    unsigned due = (o->stop && *o->stop) || mem_exhausted() ? RANKS_STOP : 0;
    if (o->settings->seconds > 0.0 && run->wall >= o->settings->seconds)
        due |= RANKS_OVER;
    if (ranks_own() > 0)
        return due;
    if (run->wall >= run->next_snapshot && started && o->reference && o->on_error_row)
        due |= RANKS_ROW;
    if (o->checkpoint && clock_wall() >= run->next_checkpoint && started)
        due |= RANKS_CHECKPOINT;
    if (started && run_view_due(run))
        due |= RANKS_VIEW;
    return due;
}

/* The rounds of all ranks; the results are those of the first. */
static bool rounds_of_ranks(struct run *run, struct run_result *result, struct err *err)
{
    for (bool last = run->options->resume && !run->more; !last;) {
        bool started = run->type->methods->started(run->integrator);
        run->more = advance(run);
        bool begun = run->type->methods->started(run->integrator);
        if (!started && begun)
            leave_start(run);
        look_back(run);
        if (ranks_own() == 0)
            report_progress(run);
        if (!run_ranks_agree(run, own_due(run, begun), err))
            return false;
        if (run->due & RANKS_ROW)
            run_plan_row(run);
        last = finished(run);
        if (!last && !run_ranks_serve(run, NULL, err))
            return false;
    }
    return run_ranks_serve(run, result, err);
}

static bool rounds(struct run *run, struct err *err)
{
    for (bool last = run->options->resume && finished(run); !last;) {
        bool started = run->type->methods->started(run->integrator);
        run->more = advance(run);
        if (!started && run->type->methods->started(run->integrator))
            leave_start(run);
        look_back(run);
        check_until(run);
        report_progress(run);
        if (run_view_due(run))
            run_view(run, run);
        if (run->wall >= run->next_snapshot &&
            run->type->methods->started(run->integrator)) {
            run_plan_row(run);
            if (!run_error_row(run, err))
                return false;
        }
        last = finished(run);
        if (!run_serve_checkpoint(run, last, err))
            return false;
    }
    return run_error_row(run, err);
}

const char *run_end_name(enum run_end end)
{
    static const char *const names[] = {"budget",      "start",         "until",
                                        "interrupted", "out of memory", "not yet"};
    return names[end];
}

static enum run_end end_of(const struct run *run)
{
    const struct run_options *o = run->options;
    if (mem_exhausted())
        return RUN_MEMORY;
    if (run->until.reached)
        return RUN_UNTIL;
    if (o->stop && *o->stop)
        return RUN_INTERRUPTED;
    return o->startup_only ? RUN_START : RUN_BUDGET;
}

/* What layers by length and technique leave of the picture. */
static void add_rest(const struct run *run, struct layers *layers)
{
    struct light_classes classes;
    const struct run_options *o = run->options;
    light_classes_init(&classes, o->settings, settings_depth(o->settings, o->scene));
    light_classes_add_rest(&classes, run->picture, layers);
}

static void add_alpha(const struct run *run, struct layers *layers)
{
    const struct run_options *o = run->options;
    if (o->scene->hide_emitters && !o->startup_only && part_is_whole(o->part))
        coverage_picture(o->scene, (uint64_t)o->settings->seed,
                         settings_threads(o->settings),
                         layers_add(layers, "A", (size_t)run_pixels(run)));
}

static void add_features(const struct run *run, struct layers *layers)
{
    const struct run_options *o = run->options;
    if ((o->settings->layers & LAYER_FEATURES) && !o->startup_only &&
        part_is_whole(o->part))
        features_add(o->scene, (uint64_t)o->settings->seed, settings_threads(o->settings),
                     layers);
}

void run_take_results(struct run *run, bool verdict, struct run_result *result)
{
    const struct settings *settings = run->options->settings;
    run->type->methods->picture(run->integrator, run->picture);
    run->type->methods->statistics(run->integrator, &result->statistics);
    result->statistics.saturated += clamp_picture(run->picture);
    result->statistics.edges_cut = (double)*run->options->scene->edges_cut;
    result->image = run->picture;
    if (verdict)
        find_verdict(run, result->statistics.nonfinite + result->statistics.saturated,
                     &result->verdict);
    result->seconds_total = run->wall;
    result->seconds_cpu = run->cpu;
    result->mutations_per_pixel = result->statistics.paths / run_pixels(run);
    result->max_depth = settings_depth(settings, run->options->scene);
    result->threads = settings_threads(settings);
    result->interrupted = run->options->stop && *run->options->stop;
    result->until = run->until;
    result->end = end_of(run);
}

void run_conclude(struct run *run, struct run_result *result)
{
    const struct run_options *o = run->options;
    run_take_results(run, !o->startup_only && part_is_whole(o->part), result);
    if (run->type->methods->layers)
        run->type->methods->layers(run->integrator, &result->layers);
    add_rest(run, &result->layers);
    layers_refer(&result->layers, "se.Y", result->verdict.se);
    layers_refer(&result->layers, "rhat.Y", result->verdict.rhat);
    layers_refer(&result->layers, "ess.Y", result->verdict.ess);
    add_alpha(run, &result->layers);
    add_features(run, &result->layers);
}

/* Expected length of the run; 0 if it may end at any time, so that snapshots begin at
 * once. */
static double expected_length(const struct settings *s)
{
    if (settings_until(s))
        return 0.0;
    return s->seconds > 0.0 ? s->seconds : s->mutations_per_pixel;
}

static bool reserve_memory(const struct scene *scene, const struct settings *settings,
                           struct err *err)
{
    size_t bytes = run_reserve(scene, settings);
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

bool run_begin(struct run *run, struct run_result *result, struct err *err)
{
    const struct run_options *o = run->options;
    const struct camera *camera = &o->scene->camera;
    struct fixed_picture picture;
    run->type = integrator_find(o->settings->integrator);
    result->memory = run_memory(o->scene, o->settings);
    blind_spots(o->scene->desc, o->settings, settings_depth(o->settings, o->scene),
                result->blind_to);
    if (!run_check_memory(&result->memory, machine_memory_available(), o->settings,
                          err) ||
        !reserve_memory(o->scene, o->settings, err))
        return false;
    run->picture = image_create(camera->width, camera->height);
    run->picture->x = camera->crop_x;
    run->picture->y = camera->crop_y;
    run->picture->whole_width = camera->whole_width;
    run->picture->whole_height = camera->whole_height;
    run->integrator = run->type->methods->create(run->type, o->scene, o->settings);
    run->more = true;
    run->last_row = -1.0;
    *o->scene->edges_cut = 0;
    until_init(&run->until, o->settings->until_converged, o->settings->until_relmse);
    run->type->methods->fixed_picture(run->integrator, &picture);
    past_snapshots_init(&run->past, camera->width, camera->height,
                        expected_length(o->settings), run->parts ? picture.count : 0);
    return true;
}

void run_end(struct run *run)
{
    run->type->methods->destroy(run->integrator);
    past_snapshots_deinit(&run->past);
    mem_free(run->rows);
}

/* A part goes on from its own state, or from the end of the measured start of all. */
static bool resume(struct run *run, struct err *err)
{
    const struct run_options *o = run->options;
    bool part = !part_is_whole(o->part);
    bool whole = o->resume && part_is_whole(o->resume->head.part);
    if (part && !whole)
        run->type->methods->set_part(run->integrator, o->part);
    if (o->resume && !run_resume(run, err))
        return false;
    if (part && whole) {
        run->type->methods->set_part(run->integrator, o->part);
        leave_start(run);
    }
    return true;
}

/* A rank that ends early leaves the others without its part. */
static bool render_ranks(struct run *run, struct run_result *result, struct err *err)
{
    run->ranks = true;
    bool ok = run_begin(run, result, err);
    if (!ok)
        return false;
    run->next_checkpoint =
        clock_wall() + (run->options->checkpoint ? run->options->checkpoint->every : 0.0);
    ok = resume(run, err);
    run->view.resumed_cpu = run->cpu;
    ok = ok && rounds_of_ranks(run, result, err);
    mem_release_reserve();
    image_destroy(run->picture);
    run_end(run);
    return ok;
}

bool run_render(const struct run_options *options, struct run_result *result,
                struct err *err)
{
    struct run run = {
        .options = options,
        .parts = !part_is_whole(options->part),
        .next_snapshot = options->rows_every > 0.0 ? options->rows_every : SNAPSHOT_FIRST,
    };
    if (ranks_count() > 1)
        return render_ranks(&run, result, err);
    if (!run_begin(&run, result, err))
        return false;
    if (options->checkpoint)
        run.next_checkpoint = clock_wall() + options->checkpoint->every;
    bool begun = have_memory(&run, false, err) && resume(&run, err);
    run.view.resumed_cpu = run.cpu;
    bool ok = begun && rounds(&run, err) && have_memory(&run, true, err);
    mem_release_reserve(); /* the reserve is for what follows */
    if (begun)
        run_conclude(&run, result);
    else
        image_destroy(run.picture);
    run_end(&run);
    return ok;
}

void run_result_deinit(struct run_result *result)
{
    image_destroy(result->image);
    layers_deinit(&result->layers);
    verdict_deinit(&result->verdict);
    result->image = NULL;
}

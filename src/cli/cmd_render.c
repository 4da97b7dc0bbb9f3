/* etalon render: checks everything that can be checked, renders, writes. */

#include "base/mem.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/fail.h"
#include "cli/interrupt.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/progress.h"
#include "cli/resume.h"
#include "cli/session.h"
#include "cli/summary.h"
#include "image/exr.h"
#include "image/preview.h"
#include "lab/error_log.h"
#include "lab/fingerprint.h"
#include "lab/statistics.h"

#include <string.h>
#include <unistd.h>

#define EXIT_NOT_CONVERGED 3
#define EXIT_BLIND         4

struct render {
    const char *out, *stats, *errors, *reference_path; /* NULL: not asked for */
    char *preview, *failures;                          /* paths of the PNGs */
    bool require_converged;
    struct session session;
    struct resume resume;
    double errors_every; /* s; 0: log-spaced */
    struct image *reference;
    struct error_log *log;
    struct run_result result;
    struct err *err;
};

/* The files to be written, in the order of the options; room for the NULL at the end. */
#define WRITTEN 7

static void list_written(const struct render *r, struct output_file written[WRITTEN])
{
    const struct output_file list[WRITTEN] = {
        {"-o", r->out},
        {"the picture to look at beside -o", r->preview},
        {"the map of failures beside -o", r->failures},
        {"--stats", r->stats},
        {"--errors", r->errors},
        {"--checkpoint", r->resume.options.path},
    };
    memcpy(written, list, sizeof list);
}

/* A checkpoint may replace the one that the run is resumed from. */
static bool check_apart(const struct render *r, const char *scene, struct err *err)
{
    const struct output_file read[] = {
        {"the scene", scene},
        {"the reference", r->reference_path},
        {0},
    };
    const struct output_file from[] = {{"--resume", r->resume.from}, {0}};
    struct output_file written[WRITTEN];
    list_written(r, written);
    if (!output_apart(written, read, err))
        return false;
    for (int i = 0; written[i].what; i++)
        if (text_equal(written[i].what, "--checkpoint"))
            written[i].path = NULL;
    return output_apart(written, from, err);
}

/* Refuses to overwrite files that the scene names (meshes, textures), once the scene is
 * loaded. */
static bool spare_scene(const struct render *r, const char *scene, struct err *err)
{
    struct output_file written[WRITTEN];
    list_written(r, written);
    for (int i = 0; written[i].what; i++) {
        bool named = false;
        if (written[i].path && access(written[i].path, F_OK) == 0 &&
            !fingerprint_names(scene, written[i].path, &named, err))
            return false;
        if (named)
            return err_set(err, ERR_USAGE, NULL,
                           "%s '%s' would overwrite a file that the scene names: give "
                           "another name",
                           written[i].what, written[i].path);
    }
    return true;
}

static bool take_errors(struct render *r, const struct args *args, struct err *err)
{
    const char *every = args_value(args, "errors-every");
    r->errors = args_value(args, "errors");
    r->reference_path = args_value(args, "reference");
    if (r->errors && r->reference_path == NULL)
        return err_set(err, ERR_USAGE, NULL,
                       "--errors needs a picture to measure against: --reference "
                       "REF.exr");
    if (every == NULL)
        return true;
    if (r->errors == NULL)
        return err_set(err, ERR_USAGE, NULL,
                       "--errors-every needs a file to write: --errors OUT.csv");
    if (!text_to_double(every, &r->errors_every) || !(r->errors_every > 0.0))
        return err_set(err, ERR_USAGE, NULL,
                       "--errors-every '%s': give a number of seconds above 0", every);
    return true;
}

static bool take_args(struct render *r, const struct args *args, struct err *err)
{
    r->out = args_value(args, "output");
    r->stats = args_value(args, "stats");
    r->require_converged = args_value(args, "require-converged") != NULL;
    if (r->out == NULL)
        return err_set(err, ERR_USAGE, NULL, "render needs -o OUT.exr");
    if (!text_ends_with(r->out, ".exr"))
        return err_set(err, ERR_USAGE, NULL, "-o '%s': the picture's name ends in .exr",
                       r->out);
    if (!take_errors(r, args, err))
        return false;
    r->preview = output_with_ending(r->out, ".png");
    r->failures = output_with_ending(r->out, ".failures.png");
    return output_check(r->out, err) && output_check(r->preview, err) &&
           output_check(r->failures, err) && output_check(r->stats, err) &&
           output_check(r->errors, err) && resume_take_args(&r->resume, args, err) &&
           check_apart(r, args->operands[0], err);
}

static bool check_reference(const struct render *r, struct err *err)
{
    const struct camera *camera = &r->session.scene->camera;
    const struct image *ref = r->reference;
    struct place at = {r->reference_path, 0, 0};
    if (ref == NULL)
        return true;
    if (ref->width != camera->width || ref->height != camera->height)
        return err_set(err, ERR_VALUE, &at,
                       "the reference has %dx%d pixels, the picture %dx%d: give another, "
                       "or another --size",
                       ref->width, ref->height, camera->width, camera->height);
    if (image_nonfinite(ref) > 0)
        return err_set(err, ERR_VALUE, &at,
                       "%ld pixels of the reference are not finite: give another",
                       image_nonfinite(ref));
    return true;
}

/* All checks that can fail early. The error log comes last, as it creates a file. */
static bool prepare(struct render *r, const struct args *args, struct err *err)
{
    if (!take_args(r, args, err))
        return false;
    if (r->reference_path) {
        r->reference = exr_read(r->reference_path, NULL, err);
        if (r->reference == NULL)
            return false;
    }
    if (!session_open(&r->session, args->operands[0], args, err) ||
        !check_reference(r, err) || !spare_scene(r, args->operands[0], err) ||
        !resume_open(&r->resume, args->operands[0], &r->session,
                     r->errors ? r->reference_path : NULL, err))
        return false;
    if (r->errors) {
        r->log = error_log_create(r->errors, err);
        if (r->log == NULL)
            return false;
    }
    session_warn(&r->session);
    resume_tell(&r->resume);
    return true;
}

static void on_progress(void *ctx, const struct run_progress *progress)
{
    (void)ctx;
    progress_show(progress);
}

static bool on_error_row(void *ctx, const struct error_row *row)
{
    struct render *r = ctx;
    return r->log == NULL || error_log_append(r->log, row, r->err);
}

static bool render(struct render *r, struct err *err)
{
    bool terminal = progress_wanted();
    struct run_options options = {
        .scene = r->session.scene,
        .settings = &r->session.settings,
        .reference = r->log ? r->reference : NULL,
        .stop = interrupt_install(),
        .on_progress = terminal ? on_progress : NULL,
        .on_error_row = on_error_row,
        .hook_ctx = r,
        .rows_every = r->errors_every,
    };
    resume_give(&r->resume, &options);
    bool ok = run_render(&options, &r->result, err);
    if (terminal)
        progress_clear();
    return ok;
}

static void warn_of_result(const struct render *r)
{
    const struct run_statistics *s = &r->result.statistics;
    if (settings_until(&r->session.settings) && r->result.end == RUN_BUDGET)
        fprintf(stderr, "warning: the budget ended before the until condition "
                        "was met: give it more\n");
    if (r->result.interrupted)
        fprintf(stderr, "interrupted: the picture so far was written\n");
    if (s->unsampled > 0.0)
        fprintf(stderr,
                "warning: the run ended before each pixel had a sample: %.2g %% of them "
                "are black; give it more time\n",
                100.0 * s->unsampled);
    else if (!(s->b > 0.0))
        fprintf(stderr, "warning: no light-carrying path found in %.0f samples\n",
                s->paths + s->bootstrap_paths);
    else if (s->start_mutations < 1.0 && s->plain_lengths > 0 && !s->plain_only)
        fprintf(stderr,
                "warning: the run ended before its chains began: path lengths beyond %d "
                "are missing; give it more time, or fewer paths: --set bootstrap=N\n",
                s->plain_lengths);
    else if (s->paths < 1.0)
        fprintf(stderr, "warning: the run ended during the bootstrap and the picture is "
                        "black; give it more time, or fewer paths: --set bootstrap=N\n");
}

/* The share of failed proposals as a picture: black for none, white for all, blue where
 * no state was. */
static bool write_failure_map(const struct render *r, struct err *err)
{
    const struct image *like = r->result.image;
    const float *shares = layers_find(&r->result.layers, "failures.Y");
    if (shares == NULL)
        return true;
    struct image *map = image_create(like->width, like->height);
    for (long i = 0; i < (long)like->width * like->height; i++) {
        float share = shares[i];
        for (int channel = 0; channel < 3; channel++)
            map->pixels[3 * i + channel] = share >= 0.0f ? share
                                                         : (channel == 2 ? 0.2f : 0.0f);
    }
    bool ok = preview_write_png(r->failures, map, 0.0, err);
    image_destroy(map);
    return ok;
}

static bool write_picture(const struct render *r, const struct statistics_record *record,
                          struct err *err)
{
    int count;
    struct exr_attribute *attributes = statistics_attributes(record, &count);
    bool ok = exr_write(r->out, r->result.image, attributes, count, &r->result.layers,
                        err) &&
              preview_write_png(r->preview, r->result.image, (double)NAN, err) &&
              write_failure_map(r, err);
    statistics_attributes_destroy(attributes, count);
    return ok;
}

static bool deliver(const struct render *r, struct err *err)
{
    struct statistics_record record;
    struct metric metric;
    statistics_record_init(&record, &r->result, &r->session.settings, r->session.scene,
                           r->session.left_out);
    record.seconds_load = r->session.load_seconds;
    if (!write_picture(r, &record, err) ||
        (r->stats && !statistics_write(r->stats, &record, err)))
        return false;
    if (r->reference && !metric_compare(r->result.image, r->reference, &metric, err))
        return false;
    warn_of_result(r);
    bool failures = layers_find(&r->result.layers, "failures.Y") != NULL;
    summary_print(&record, r->reference ? &metric : NULL, stdout);
    printf("%-12s %s, %s%s%s\n", "written", r->out, r->preview, failures ? ", " : "",
           failures ? r->failures : "");
    return true;
}

static int status_of(const struct render *r)
{
    enum verdict_call call = r->result.verdict.call;
    if (!r->require_converged || call == VERDICT_CONVERGED)
        return 0;
    return call == VERDICT_BLIND ? EXIT_BLIND : EXIT_NOT_CONVERGED;
}

static int run(const struct args *args)
{
    struct err err = {0};
    struct render r = {.err = &err};
    bool ok = prepare(&r, args, &err);
    int status = 0;
    if (ok) {
        /* The picture is written even if, for example, the disk of the error log is full.
         */
        bool rendered = render(&r, &err);
        ok = r.result.image && deliver(&r, &err) && rendered;
        status = status_of(&r);
        run_result_deinit(&r.result);
    }
    error_log_destroy(r.log);
    image_destroy(r.reference);
    resume_close(&r.resume);
    session_close(&r.session);
    mem_free(r.preview);
    mem_free(r.failures);
    return ok ? status : fail(&err);
}

static const struct arg_option own[] = {
    {"output", 'o', "OUT.exr", NULL, "the picture; a tone-mapped OUT.png goes beside it"},
    {"reference", 0, "REF.exr", NULL,
     "picture of the same size to measure errors against; alone, only the final error is "
     "printed"},
    {"errors", 0, "OUT.csv", NULL, "error against time; needs --reference"},
    {"errors-every", 0, "S", NULL,
     "a row of it every S seconds of rendering (default: log-spaced in time)"},
    {"stats", 0, "OUT.yaml", NULL, "statistics of the run"},
    {"checkpoint", 0, "FILE", NULL, "where the state of the run is kept, to go on from"},
    {"every", 0, "S", NULL, "seconds between two checkpoints (default 60)"},
    {"resume", 0, "FILE", NULL,
     "goes on from a checkpoint of this scene, these settings and this program"},
    {"until-converged", 0, NULL, "until_converged",
     "ends before the budget does once the verdict is \"converged\" at two looks in "
     "succession"},
    {"until-relmse", 0, "X", "until_relmse",
     "ends before the budget does once relMSE (of luminance) is below X by the run's own "
     "error bars"},
    {"require-converged", 0, NULL, NULL,
     "exit status 3, with all written, unless the verdict is \"converged\"; 4 if that is "
     "\"converged, but blind\""},
    {0},
};

const struct command command_render = {
    .name = "render",
    .summary = "renders a scene",
    .operands = "SCENE -o OUT.exr [options]",
    .operand_count = 1,
    .groups = {own, options_run, options_scene},
    .lists_settings = true,
    .notes =
        "SCENE is a .yaml, .pbrt, .lxs or .xml file. Options override its settings.\n"
        "SIGINT (Ctrl-C) or SIGTERM ends the run early: the picture so far is "
        "written, and\nthe exit status is 0. A second one kills.\n"
        "With --checkpoint the state is kept too, before that and at the end of every "
        "run.\nA resumed run with a budget in mutations gives the same bits as an "
        "uninterrupted one,\nwith any --threads. A finished one continues if it is given "
        "a larger budget."
        "\nWith --until-converged and --until-relmse the run is checked after 8, 12, "
        "18, ...\n"
        "mutations per pixel, and ends once the condition is met (with both: once both "
        "are), at\nthe latest with its budget; the status is 0 in either case, and "
        "ended_by in the\nstatistics says which it was."
        "\nExit status 3: --require-converged, and the verdict is another. 4: it is "
        "\"converged, but\nblind\": the picture may lack light that the integrator "
        "cannot "
        "sample; a warning before the\nrun says which.",
    .run = run,
};

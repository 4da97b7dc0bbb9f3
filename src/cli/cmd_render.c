/* etalon render: checks everything that can be checked, renders, writes. */

#include "base/ranks.h"
#include "base/text.h"
#include "cli/commands.h"
#include "cli/delivery.h"
#include "cli/fail.h"
#include "cli/interrupt.h"
#include "cli/live.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/progress.h"
#include "cli/render_all.h"
#include "cli/resume.h"
#include "cli/session.h"
#include "image/exr.h"
#include "lab/error_log.h"
#include "lab/fingerprint.h"

#include <string.h>
#include <unistd.h>

#define EXIT_NOT_CONVERGED 3
#define EXIT_BLIND         4

struct render {
    const char *errors, *reference_path; /* NULL: not asked for */
    const char *out;                     /* the picture, or with --part its file */
    struct delivery delivery;            /* of a whole run */
    bool require_converged;
    struct session session;
    struct resume resume;
    struct live *live;   /* NULL: nobody looks at the run */
    double errors_every; /* s; 0: log-spaced */
    struct image *reference;
    struct error_log *log;
    struct run_result result;
    struct err *err;
};

static bool is_part(const struct render *r)
{
    return !part_is_whole(r->resume.part);
}

/* The files to be written, in the order of the options; room for the NULL at the end. */
#define WRITTEN 7

static void list_written(const struct render *r, struct output_file written[WRITTEN])
{
    const struct output_file list[WRITTEN] = {
        {"-o", r->delivery.out},
        {"the picture to look at beside -o", r->delivery.preview},
        {"the map of failures beside -o", r->delivery.failures},
        {"--stats", r->delivery.stats},
        {"--errors", r->errors},
        {is_part(r) ? "-o" : "--checkpoint", r->resume.options.path},
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
        if (written[i].path == r->resume.options.path)
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

/* What only a whole run can give. */
static bool check_part_args(const struct args *args, struct err *err)
{
    static const char *const whole[] = {
        "stats",           "errors",       "reference", "require-converged",
        "until-converged", "until-relmse", "tev",       "live"};
    for (size_t i = 0; i < sizeof whole / sizeof *whole; i++)
        if (args_value(args, whole[i]))
            return err_set(err, ERR_USAGE, NULL,
                           "--%s needs the whole run: it is not for a part%s", whole[i],
                           i < 3 ? "; give it to 'etalon merge'" : "");
    return true;
}

static bool take_args(struct render *r, const struct args *args, struct err *err)
{
    bool part = args_value(args, "part") != NULL;
    r->out = args_value(args, "output");
    r->require_converged = args_value(args, "require-converged") != NULL;
    if (r->out == NULL)
        return err_set(err, ERR_USAGE, NULL, "render needs -o OUT.%s",
                       part ? "part" : "exr");
    if (part && !text_ends_with(r->out, ".part"))
        return err_set(err, ERR_USAGE, NULL,
                       "-o '%s': the name of a part's file ends in .part", r->out);
    if (!take_errors(r, args, err) || (part && !check_part_args(args, err)) ||
        (!part && !delivery_init(&r->delivery, r->out, args_value(args, "stats"), err)))
        return false;
    return output_check(r->errors, err) && resume_take_args(&r->resume, args, err) &&
           check_apart(r, args->operands[0], err) &&
           (ranks_own() > 0 || live_open(&r->live, args, r->out, err));
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
        !delivery_check_reference(r->reference, r->reference_path,
                                  &r->session.scene->camera, err) ||
        !spare_scene(r, args->operands[0], err) ||
        !resume_open(&r->resume, args->operands[0], &r->session,
                     r->errors ? r->reference_path : NULL, err))
        return false;
    if (r->errors && ranks_own() == 0) {
        r->log = error_log_create(r->errors, err);
        if (r->log == NULL)
            return false;
    }
    if (ranks_own() > 0)
        return true;
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
    bool terminal = progress_wanted() && ranks_own() == 0;
    struct run_options options = {
        .scene = r->session.scene,
        .settings = &r->session.settings,
        .reference = r->errors ? r->reference : NULL,
        .stop = interrupt_install(),
        .on_progress = terminal ? on_progress : NULL,
        .on_error_row = on_error_row,
        .hook_ctx = r,
        .rows_every = r->errors_every,
    };
    resume_give(&r->resume, &options);
    live_give(r->live, &r->session, r->reference, &options);
    bool ok = run_render(&options, &r->result, err);
    if (terminal)
        progress_clear();
    return ok;
}

static void tell_part(const struct render *r)
{
    const struct run_part *part = &r->resume.part;
    const struct run_result *result = &r->result;
    if (result->interrupted)
        fprintf(stderr, "interrupted: go on with --resume %s\n", r->out);
    printf("%-12s %d/%d, %.2f s (start %.2f s), %.2f s CPU on %d threads\n", "part",
           part->index + 1, part->count, result->seconds_total,
           result->statistics.seconds_startup, result->seconds_cpu, result->threads);
    printf("%-12s %s\n", "written", r->out);
}

static bool deliver(struct render *r, struct err *err)
{
    if (!is_part(r)) {
        r->delivery.reference = r->reference;
        bool ok = delivery_write(&r->delivery, &r->session, &r->result, err);
        if (ranks_count() > 1)
            printf("%-12s %d, %.0f bytes to the first one for a picture\n", "ranks",
                   ranks_count(), r->result.ranks_bytes);
        return ok;
    }
    tell_part(r);
    return true;
}

static int status_of(const struct render *r)
{
    enum verdict_call call = r->result.verdict.call;
    if (!r->require_converged || call == VERDICT_CONVERGED)
        return 0;
    return call == VERDICT_BLIND ? EXIT_BLIND : EXIT_NOT_CONVERGED;
}

/* Whether all ranks are prepared. One that is not, for example since rank 0 cannot have
 * the port of --live, must not leave the others waiting for it. Who did not fail itself
 * has no error to tell. */
static bool all_prepared(bool own, struct err *err)
{
    enum { FIRST_FAILED = 1, OTHER_FAILED = 2 };
    unsigned failed = own ? 0 : ranks_own() > 0 ? OTHER_FAILED : FIRST_FAILED;
    bool there = ranks_agree(&failed, NULL);
    if (own && !there)
        return err_set(err, ERR_IO, NULL, "rank %d: another rank is gone", ranks_own());
    if (!own && ranks_own() > 0 && failed & FIRST_FAILED)
        *err = (struct err){0}; /* the first rank says why */
    return failed == 0;
}

static int run(const struct args *args)
{
    struct err err = {0};
    struct render r = {.err = &err};
    if (render_all_wanted(args))
        return render_all(args);
    ranks_begin();
    bool ok = all_prepared(prepare(&r, args, &err), &err), prepared = ok;
    int status = 0;
    if (ok) {
        /* The picture is written even if, for example, the disk of the error log is full.
         */
        bool rendered = render(&r, &err);
        if (r.result.image)
            live_conclude(r.live, &r.result);
        ok = (ranks_own() > 0 || (r.result.image && deliver(&r, &err))) && rendered;
        status = ranks_own() > 0 ? 0 : status_of(&r);
        run_result_deinit(&r.result);
    }
    bool free_to_close = live_close(r.live, ok ? NULL : &err);
    error_log_destroy(r.log);
    resume_close(&r.resume);
    if (free_to_close) { /* else a look that takes too long goes on to use them */
        image_destroy(r.reference);
        session_close(&r.session);
    }
    delivery_deinit(&r.delivery);
    if (!ok) /* before the ranks part: mpirun ends all with the first that fails */
        status = err.code == ERR_NONE ? 1 : fail(&err); /* ERR_NONE: another rank tells */
    if (ok || !prepared) /* else a rank that waits for this one must not be kept */
        ranks_end();
    return status;
}

static const struct arg_option own[] = {
    {"output", 'o', "OUT.exr", NULL,
     "the picture; a tone-mapped OUT.png goes beside it (-i all: a folder)"},
    {"reference", 0, "REF.exr", NULL,
     "picture of the same size to measure errors against; alone, only the final error is "
     "printed"},
    {"errors", 0, "OUT.csv", NULL, "error against time; needs --reference"},
    {"errors-every", 0, "S", NULL,
     "a row of it every S seconds of rendering (default: log-spaced in time)"},
    {"stats", 0, "OUT.yaml", NULL, "statistics of the run"},
    {"live", 0, "DIR|PORT", NULL,
     "a page of the run as it goes, for any browser: files in a folder, or served at a "
     "port of 127.0.0.1 (HOST:PORT: of that address)"},
    {"tev", 0, "HOST:PORT", NULL,
     "the picture as it goes, to tev or another display server of its protocol"},
    {"view-every", 0, "S", NULL,
     "least time between two looks of these (default 2); they take below 1 % of the "
     "run's"},
    {"checkpoint", 0, "FILE", NULL, "where the state of the run is kept, to go on from"},
    {"every", 0, "S", NULL, "seconds between two checkpoints (default 60)"},
    {"part", 0, "I/N", NULL,
     "computes part I of N and writes -o OUT.part: 'etalon merge' makes the picture of "
     "all "
     "parts; that file is the part's checkpoint, too"},
    {"resume", 0, "FILE", NULL,
     "goes on from a checkpoint of this scene, these settings and this program"},
    {"layers", 0, "LIST", "layers",
     "layers of OUT.exr that explain the run: of acceptance, failures, work, visits, "
     "lengths, techniques, unweighted, features, with commas between them"},
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
        "Parts of a run with a budget in mutations give the same bits as the whole run. "
        "Each "
        "makes\nthe measured start anew, unless it goes on from one: etalon startup "
        "SCENE "
        "--save FILE,\nand --resume FILE. A budget in seconds needs such a file.\n"
        "-i all -o DIR renders by every integrator, each with the whole budget, and "
        "writes "
        "a page\nthat compares them, DIR/report.html: which one for this scene, and why. "
        "Without\n--reference errors are those of each run's own error bars.\n"
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

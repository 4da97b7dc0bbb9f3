/* etalon startup: the measured start alone. */

#include "base/mem.h"
#include "cli/commands.h"
#include "cli/curve_text.h"
#include "cli/fail.h"
#include "cli/interrupt.h"
#include "cli/options.h"
#include "cli/output.h"
#include "cli/session.h"
#include "integrator/registry.h"
#include "lab/identity.h"
#include "lab/statistics.h"

#include <math.h>

static bool check_integrator(const struct settings *settings, struct err *err)
{
    if (integrator_find(settings->integrator)->methods->chains)
        return true;
    return err_set(err, ERR_USAGE, NULL,
                   "%s has no large steps to measure; give an integrator with chains, "
                   "such as -i pssmlt",
                   settings->integrator);
}

static bool deliver(const struct session *session, const struct run_result *result,
                    const char *stats, struct err *err)
{
    struct statistics_record record;
    statistics_record_init(&record, result, &session->settings, session->scene,
                           session->left_out);
    record.seconds_load = session->load_seconds;
    char *yaml = statistics_yaml(&record);
    fputs(yaml, stdout);
    mem_free(yaml);
    curve_print(&result->statistics, stdout);
    if (result->statistics.b > 0.0 && result->statistics.start_looks == 0 &&
        !result->statistics.plain_only)
        fprintf(stderr, "warning: the budget ended before the measured start did; give "
                        "it more time, or fewer paths: --set bootstrap=N\n");
    return stats == NULL || statistics_write(stats, &record, err);
}

static bool measure(const struct session *session, const struct checkpoint_options *save,
                    const char *stats, struct err *err)
{
    struct run_result result = {0};
    struct run_options options = {
        .scene = session->scene,
        .settings = &session->settings,
        .startup_only = true,
        .stop = interrupt_install(),
        .checkpoint = save->path ? save : NULL,
    };
    bool ok = run_render(&options, &result, err) && deliver(session, &result, stats, err);
    run_result_deinit(&result);
    return ok;
}

static int run(const struct args *args)
{
    struct err err = {0};
    struct session session = {0};
    const char *stats = args_value(args, "stats"), *scene = args->operands[0];
    struct identity identity = {0};
    struct checkpoint_options save = {.path = args_value(args, "save"),
                                      .every = (double)INFINITY,
                                      .identity = &identity,
                                      .scene = scene};
    const struct output_file written[] = {{"--stats", stats}, {"--save", save.path}, {0}};
    const struct output_file read[] = {{"the scene", args->operands[0]}, {0}};
    bool ok = output_check(stats, &err) && output_apart(written, read, &err) &&
              (save.path == NULL || pack_writable(save.path, &err)) &&
              session_open(&session, scene, args, &err) &&
              check_integrator(&session.settings, &err) &&
              (save.path == NULL || identity_init(&identity, scene, session.scene,
                                                  &session.settings, NULL, &err));
    if (ok) {
        session_warn(&session);
        ok = measure(&session, &save, stats, &err);
    }
    identity_deinit(&identity);
    session_close(&session);
    return ok ? 0 : fail(&err);
}

static const struct arg_option own[] = {
    {"stats", 0, "OUT.yaml", NULL, "writes the statistics to a file too"},
    {"save", 0, "FILE", NULL,
     "keeps the state at the end of the start, from which 'etalon render --resume FILE' "
     "goes "
     "on, also with --part"},
    {0},
};

const struct command command_startup = {
    .name = "startup",
    .summary = "measures a scene's statistics and the p_l that a render would use",
    .operands = "SCENE [options]",
    .operand_count = 1,
    .groups = {own, options_run, options_scene},
    .lists_settings = true,
    .notes =
        "The statistics go to standard output as YAML. The length of the measurement "
        "is a share\nof the budget, as it is in a render.",
    .run = run,
};

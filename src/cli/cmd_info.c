/* etalon info: the contents of a scene, the features it needs, and what is left out and
 * why. */

#include "base/mem.h"
#include "cli/commands.h"
#include "cli/fail.h"
#include "cli/info.h"
#include "cli/options.h"

static void print(const struct info *info, bool json)
{
    if (!json) {
        info_text(info, stdout);
        return;
    }
    char *text = info_json(info);
    fputs(text, stdout);
    mem_free(text);
}

static int run(const struct args *args)
{
    struct err err = {0};
    struct session session;
    struct info info;
    if (!session_open(&session, args->operands[0], args, &err))
        return fail(&err);
    info_gather(&info, &session);
    print(&info, args_value(args, "json") != NULL);
    session_close(&session);
    return 0;
}

static const struct arg_option own[] = {
    {"json", 0, NULL, NULL, "one JSON object, for machines"},
    {"integrator", 'i', "NAME", "integrator", "whose films are counted; see below"},
    {0},
};

const struct command command_info = {
    .name = "info",
    .summary = "what is in a scene, what it needs, what is left out and why",
    .operands = "SCENE [options]",
    .operand_count = 1,
    .groups = {own, options_scene},
    .lists_settings = true,
    .run = run,
};

/* etalon info: the contents of a scene, the features it needs, and what is left out and
 * why. */

#include "base/mem.h"
#include "cli/commands.h"
#include "cli/fail.h"
#include "cli/info.h"
#include "cli/options.h"

#define STATUS_LEFT_OUT 4

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

/* Whether all of the file is in the scene; what is not, or otherwise, is listed. */
static int check(const struct info *info, bool json)
{
    if (json)
        print(info, true);
    else
        info_check(info, stdout);
    return info_is_complete(info) ? 0 : STATUS_LEFT_OUT;
}

static int run(const struct args *args)
{
    struct err err = {0};
    struct session session;
    struct info info;
    if (!session_open(&session, args->operands[0], args, &err))
        return fail(&err);
    info_gather(&info, &session);
    int status = 0;
    if (args_value(args, "check"))
        status = check(&info, args_value(args, "json") != NULL);
    else
        print(&info, args_value(args, "json") != NULL);
    session_close(&session);
    return status;
}

static const struct arg_option own[] = {
    {"check", 0, NULL, NULL,
     "lists what of the file is left out or taken otherwise; exit status 4 if anything "
     "is"},
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

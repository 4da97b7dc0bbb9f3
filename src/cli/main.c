/* etalon: the table of commands. */

#include "base/libraries.h"
#include "base/text.h"
#include "build_info.h"
#include "cli/commands.h"
#include "cli/fail.h"
#include "cli/help.h"

#include <signal.h>

static const struct command *const commands[] = {
    &command_render, &command_startup, &command_info,  &command_bench, &command_compare,
    &command_report, &command_regress, &command_merge, NULL,
};

static const struct command *find(const char *name)
{
    for (int i = 0; commands[i]; i++)
        if (text_equal(commands[i]->name, name))
            return commands[i];
    return NULL;
}

static int unknown_command(const char *name)
{
    const char *names[sizeof commands / sizeof commands[0]] = {NULL};
    struct err err = {0};
    for (int i = 0; commands[i]; i++)
        names[i] = commands[i]->name;
    const char *near = text_nearest(name, names);
    if (near)
        err_set(&err, ERR_USAGE, NULL, "unknown command '%s' (did you mean '%s'?)", name,
                near);
    else
        err_set(&err, ERR_USAGE, NULL, "unknown command '%s'; see 'etalon --help'", name);
    return fail(&err);
}

static int run(const struct command *command, int argc, char *const *argv)
{
    struct args args;
    struct err err = {0};
    int status = 0;
    if (!args_parse(command, argc, argv, &args, &err))
        status = fail(&err);
    else if (args.help)
        help_command(command, stdout);
    else
        status = command->run(&args);
    args_deinit(&args);
    return status;
}

static int dispatch(int argc, char **argv)
{
    struct err err = {0};
    if (argc < 2) {
        err_set(&err, ERR_USAGE, NULL, "no command; see 'etalon --help'");
        return fail(&err);
    }
    if (text_equal(argv[1], "--help") || text_equal(argv[1], "-h")) {
        help_program(commands, stdout);
        return 0;
    }
    if (text_equal(argv[1], "--version")) {
        printf("etalon %s (%s, %s)\n", BUILD_COMMIT, BUILD_VARIANT, BUILD_COMPILER);
        return 0;
    }
    const struct command *command = find(argv[1]);
    return command ? run(command, argc - 2, argv + 2) : unknown_command(argv[1]);
}

int main(int argc, char **argv)
{
    struct err err = {0};
    /* Exceeding the file size limit shall be an ordinary write error, not a signal. */
    signal(SIGXFSZ, SIG_IGN);
    libraries_prepare(argv);
    int status = dispatch(argc, argv);
    if ((fflush(stdout) != 0 || ferror(stdout)) && status == 0) {
        err_set(&err, ERR_IO, NULL, "cannot write to standard output");
        status = fail(&err);
    }
    return status;
}

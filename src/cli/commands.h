#ifndef ETALON_CLI_COMMANDS_H
#define ETALON_CLI_COMMANDS_H

/* The commands, one file cmd_<name>.c each. */

#include "cli/args.h"

extern const struct command command_render, command_startup, command_info, command_bench,
    command_compare, command_report, command_regress, command_merge;

#endif

#ifndef ETALON_CLI_HELP_H
#define ETALON_CLI_HELP_H

#include "cli/args.h"

#include <stdio.h>

/* Usage, options, and every setting where the command takes them. */
void help_command(const struct command *command, FILE *out);
/* commands: NULL-terminated. */
void help_program(const struct command *const *commands, FILE *out);

#endif

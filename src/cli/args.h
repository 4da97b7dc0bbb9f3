#ifndef ETALON_CLI_ARGS_H
#define ETALON_CLI_ARGS_H

/* The command line of one command, read by tables of options: --name VALUE, --name=VALUE,
 * -n VALUE, -nVALUE; "--" ends the options. */

#include "base/err.h"

#include <stdbool.h>

struct arg_option {
    const char *name;    /* without dashes; NULL ends a table */
    char letter;         /* short form, or 0 */
    const char *value;   /* what the help calls the value; NULL: a flag */
    const char *setting; /* key of the setting that it gives, or NULL */
    const char *help;
};

#define ARGS_GROUPS 3

struct args;

struct command {
    const char *name;
    const char *summary;
    const char *operands;                         /* as the usage line shows them */
    int operand_count;                            /* exactly, */
    bool takes_more;                              /* or at least */
    const struct arg_option *groups[ARGS_GROUPS]; /* tables; unused ones NULL */
    bool lists_settings;                          /* --help lists what --set takes */
    const char *notes;                            /* end of the help, or NULL */
    int (*run)(const struct args *args);          /* exit status */
};

struct arg {
    const struct arg_option *option;
    const char *value; /* "" for flags */
};

struct args {
    const struct command *command;
    struct arg *given; /* options in the order of the command line */
    int given_count;
    const char **operands;
    int operand_count;
    bool help; /* --help or -h: nothing else was checked */
};

/* argv: what follows the command's name. args borrows argv's strings. */
bool args_parse(const struct command *command, int argc, char *const *argv,
                struct args *args, struct err *err);
void args_deinit(struct args *args);

/* The last value given, or NULL. */
const char *args_value(const struct args *args, const char *name);

#endif

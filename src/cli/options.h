#ifndef ETALON_CLI_OPTIONS_H
#define ETALON_CLI_OPTIONS_H

/* Option tables that several commands share. */

#include "cli/args.h"

extern const struct arg_option options_scene[]; /* how a scene is loaded */
extern const struct arg_option options_run[];   /* how it is rendered or measured */

#endif

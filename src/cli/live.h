#ifndef ETALON_CLI_LIVE_H
#define ETALON_CLI_LIVE_H

/* The options by which a run is looked at while it goes: --tev HOST:PORT,
 * --live DIR|PORT, --view-every S. */

#include "cli/args.h"
#include "cli/session.h"
#include "run/run.h"

struct live;

/* Opens the viewers that the options ask for, and tells where; *live is NULL if there is
 * none. out: the picture's path, its name in viewers. Fails if they cannot be reached at
 * all: a port in use, a host without an address, a folder that cannot be written to. */
bool live_open(struct live **live, const struct args *args, const char *out,
               struct err *err);
/* Has the run shown to them. All is borrowed; reference: or NULL. */
void live_give(struct live *live, const struct session *session,
               const struct image *reference, struct run_options *options);
/* Shows the end of the run. */
void live_conclude(struct live *live, const struct run_result *result);
/* Waits some seconds for viewers that are there, and leaves them. failure: why the run
 * has no result, or NULL. False if a look that takes too long goes on to use what
 * live_give() was given, until the process ends. */
bool live_close(struct live *live, const struct err *failure);

#endif

#ifndef ETALON_CLI_RENDER_ALL_H
#define ETALON_CLI_RENDER_ALL_H

/* `etalon render SCENE -i all -o DIR`: a batch of one run by each integrator with the
 * same settings, and its report: which one for this scene, and why. */

#include "cli/args.h"

/* Whether the options ask for it. */
bool render_all_wanted(const struct args *args);
/* Exit status. */
int render_all(const struct args *args);

#endif

#ifndef ETALON_RUN_RUN_VIEW_H
#define ETALON_RUN_RUN_VIEW_H

/* Shows a run to viewers as it goes (struct run_viewer). There are looks at the picture,
 * and looks for which the verdict is found, too, which takes far longer. Either kind may
 * take the viewer's share of the CPU time of the rendering so far; a look that would take
 * more, if it takes what the last one did, is put off. */

#include "run/run_state.h"

bool run_view_due(struct run *run);
/* Shows `whole`, which is `run` or, of several ranks, the sum of all. After
 * run_view_due(run). */
void run_view(struct run *run, struct run *whole);

#endif

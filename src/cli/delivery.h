#ifndef ETALON_CLI_DELIVERY_H
#define ETALON_CLI_DELIVERY_H

/* What a run gives at its end: picture, statistics, warnings, summary. */

#include "cli/session.h"
#include "run/run.h"

struct delivery {
    const char *out, *stats;       /* NULL: not asked for */
    char *preview, *failures;      /* paths of the PNGs beside the picture */
    const struct image *reference; /* or NULL */
};

/* Whether all can be written. out, stats are borrowed. */
bool delivery_init(struct delivery *d, const char *out, const char *stats,
                   struct err *err);
void delivery_deinit(struct delivery *d);
/* Whether it has the size of the picture, and is finite. NULL passes. */
bool delivery_check_reference(const struct image *reference, const char *path,
                              const struct camera *camera, struct err *err);
bool delivery_write(const struct delivery *d, const struct session *session,
                    const struct run_result *result, struct err *err);

#endif

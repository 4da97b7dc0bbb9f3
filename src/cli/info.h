#ifndef ETALON_CLI_INFO_H
#define ETALON_CLI_INFO_H

/* What `etalon info` reports, and its two formats. */

#include "cli/session.h"
#include "run/run.h"
#include "scene/memory.h"

#include <stdio.h>

#define INFO_KINDS 40

/* Counts by kind. */
struct info_counts {
    struct {
        const char *name;
        long count;
    } rows[INFO_KINDS];
    int kinds;
    long total;
};

struct info {
    const struct session *session;
    struct info_counts shapes, materials, lights;
    size_t triangles;
    struct memory memory;
    struct run_memory run; /* the most that the chosen integrator will take */
    double peak_bytes;     /* of the process, so far */
    double now_bytes;      /* and now */
    double available_bytes;
};

void info_gather(struct info *info, const struct session *session);
/* Predicted peak memory of a process that renders the scene. */
double info_render_peak(const struct info *info);
/* Nothing of the file was left out, nor taken for something else. */
bool info_is_complete(const struct info *info);
void info_check(const struct info *info, FILE *out);
void info_text(const struct info *info, FILE *out);
/* One object; owned by the caller. */
char *info_json(const struct info *info);

#endif

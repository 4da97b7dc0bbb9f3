#ifndef ETALON_CLI_SESSION_H
#define ETALON_CLI_SESSION_H

/* What every command that works on a scene starts with: settings (defaults, then the
 * scene file's, then the command line's) and the built scene. */

#include "cli/args.h"
#include "settings/settings.h"

struct session {
    struct settings settings;
    struct scene *scene;
    double load_seconds; /* reading and building */
    size_t note_count;   /* notes of reading the file; those of building follow */
    char left_out[512];
};

/* Options first, so that a slip in them is told before a large scene is read. On failure
 * the notes of reading are told, to stderr, and all errors but the one in *err. */
bool session_open(struct session *session, const char *path, const struct args *args,
                  struct err *err);
void session_close(struct session *session);

/* Counted notes of loading, to stderr. */
void session_warn(const struct session *session);

#endif

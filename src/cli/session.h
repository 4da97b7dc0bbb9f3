#ifndef ETALON_CLI_SESSION_H
#define ETALON_CLI_SESSION_H

/* The common begin of all commands that work on a scene: settings (defaults, then the
 * scene file, then the command line) and the built scene. */

#include "cli/args.h"
#include "run/checkpoint.h"

struct session {
    struct settings settings;
    struct scene *scene;
    double load_seconds; /* reading and building */
    size_t note_count;   /* notes of reading the file; those of building follow */
    char left_out[512];
};

/* The setting that an option of the command line gives: key (owned by the caller,
 * mem_free; NULL: it gives none) and value. */
bool session_given(const struct arg *arg, char **key, const char **value,
                   struct err *err);

/* Checks the options first, so that a mistake is reported before a large scene is read.
 * On failure the notes of reading go to stderr, and all errors but the one in *err. */
bool session_open(struct session *session, const char *path, const struct args *args,
                  struct err *err);
/* The same with settings, and definitions for the scene's file, from the label of a
 * checkpoint; options override them. NULL: none. */
bool session_open_again(struct session *session, const char *path,
                        const struct checkpoint_label *label, const struct args *args,
                        struct err *err);
void session_close(struct session *session);

/* Prints the notes of loading to stderr. */
void session_warn(const struct session *session);

#endif

#ifndef ETALON_LAB_IDENTITY_H
#define ETALON_LAB_IDENTITY_H

/* Everything that determines the bits of a run, by name: the program (commit, compiler,
 * flags, ray code), the contents of the scene's files, and every resolved setting that
 * the table of settings marks RESUME_SAME. */

#include "run/checkpoint.h"

/* reference: the picture that the error log compares with, NULL without a log. Release
 * with identity_deinit, also after failure. */
bool identity_init(struct identity *identity, const char *scene_path,
                   const struct scene *scene, const struct settings *settings,
                   const char *reference, struct err *err);

#endif

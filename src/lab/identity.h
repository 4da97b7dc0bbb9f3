#ifndef ETALON_LAB_IDENTITY_H
#define ETALON_LAB_IDENTITY_H

/* What decides the bits of a run, by name: the program (commit, compiler, flags, rays),
 * the content of the scene's files, and every setting, as resolved, of which the table of
 * settings says RESUME_SAME. */

#include "run/checkpoint.h"

/* reference: the picture that an error log measures against, NULL without a log. Release
 * with identity_deinit, on failure too. */
bool identity_init(struct identity *identity, const char *scene_path,
                   const struct scene *scene, const struct settings *settings,
                   const char *reference, struct err *err);

#endif

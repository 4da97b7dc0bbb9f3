#ifndef ETALON_LAB_FINGERPRINT_H
#define ETALON_LAB_FINGERPRINT_H

/* What a scene is made of, in 64 bits: the bytes of its file and of every file that it
 * names and that exists (meshes, spectra, included files and what those name), whatever
 * the format. A word of the file that only happens to be a file's name counts too, which
 * costs a run at worst; a name that is put together from parts is missed. */

#include "base/err.h"
#include "base/hash.h"

/* at: who asked for the file; may be NULL. */
bool fingerprint_scene(const char *path, const struct place *at, struct hash *hash,
                       struct err *err);

/* Whether `file` is one of those. Only files that name others are read. */
bool fingerprint_names(const char *scene, const char *file, bool *named, struct err *err);

/* The bytes of one file, added to *hash. */
bool fingerprint_file(const char *path, const struct place *at, struct hash *hash,
                      struct err *err);

#endif

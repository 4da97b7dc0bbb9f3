#ifndef ETALON_LAB_FINGERPRINT_H
#define ETALON_LAB_FINGERPRINT_H

/* What a scene is made of, in 64 bits: the bytes of its file and of every file that it
 * names and that exists (meshes, spectra, included files and what those name), whatever
 * the format. A word that happens to be the name of a file counts too; that costs an
 * unnecessary run at worst. A name that is composed from parts is missed. */

#include "base/err.h"
#include "base/hash.h"

/* at: place for errors, or NULL. */
bool fingerprint_scene(const char *path, const struct place *at, struct hash *hash,
                       struct err *err);

/* Whether `file` is one of these files. Reads only files that can name others. */
bool fingerprint_names(const char *scene, const char *file, bool *named, struct err *err);

/* The bytes of one file, added to *hash. */
bool fingerprint_file(const char *path, const struct place *at, struct hash *hash,
                      struct err *err);

#endif

#ifndef ETALON_IMPORT_AHEAD_H
#define ETALON_IMPORT_AHEAD_H

/* Meshes and pictures that a scene file names, decoded by all threads before the file is
 * read in earnest. What comes out is the same as without: the importer still asks for one
 * file after the other, and gets what lies ready. A file that is missing or wrong is not
 * kept, so that the importer meets the error, or makes the note, in its own order. */

#include "import/import.h"

struct ahead;

/* Looks through `path`, and the scene files that it names, for names of files in
 * `directory`: whatever stands between two of `separators` (or ends of lines) and ends as
 * such files do. NULL, which is legal below, with neither threads nor progress. */
struct ahead *ahead_read(const char *path, const char *directory, const char *separators,
                         struct texture_set *textures,
                         const struct import_options *options);
/* Also drops pictures that nobody asked for. */
void ahead_destroy(struct ahead *ahead);

typedef struct mesh *(*ahead_reader)(const char *path, const struct place *at,
                                     struct err *err);

/* The mesh that `read` (import_ply, import_obj) makes of the file. */
struct mesh *ahead_mesh(struct ahead *ahead, ahead_reader read, const char *path,
                        const struct place *at, struct err *err);

#endif

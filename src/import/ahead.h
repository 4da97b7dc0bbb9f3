#ifndef ETALON_IMPORT_AHEAD_H
#define ETALON_IMPORT_AHEAD_H

/* Meshes and pictures that a scene file names, decoded by all threads before the importer
 * reads the file. The result does not change: the importer still asks for one file after
 * the other and receives the decoded data. A missing or invalid file is not kept, so that
 * the importer reports it in its own order. */

#include "import/import.h"

struct ahead;

/* Looks through `path`, and the scene files that it names, for names of files in
 * `directory`: whatever stands between two of `separators` (or ends of lines) and ends as
 * such files do. NULL, which is legal below, with neither threads nor progress. */
struct ahead *ahead_read(const char *path, const char *directory, const char *separators,
                         struct texture_set *textures,
                         const struct import_options *options);
/* Also frees pictures that were not asked for. */
void ahead_destroy(struct ahead *ahead);

typedef struct mesh *(*ahead_reader)(const char *path, const struct place *at,
                                     struct err *err);

/* The mesh that `read` (import_ply, import_obj) makes of the file. */
struct mesh *ahead_mesh(struct ahead *ahead, ahead_reader read, const char *path,
                        const struct place *at, struct err *err);

#endif

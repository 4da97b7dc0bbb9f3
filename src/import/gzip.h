#ifndef ETALON_IMPORT_GZIP_H
#define ETALON_IMPORT_GZIP_H

/* Files read piece by piece, unpacked on the way where gzip packed them (zlib's gzread).
 * The first bytes of the file say so; one that is named .gz and does not is an error. A
 * kilobyte can expand to a megabyte, so readers detect errors before everything is in
 * memory; and decoded data need not be in memory twice. */

#include "base/err.h"

#include <stddef.h>

/* DEFLATE makes at most that many bytes of one. */
#define GZIP_RATIO 1032

struct gzip;

/* NULL if the file cannot be opened, or is none. The path, and at's, must outlive it. */
struct gzip *gzip_open(const char *path, const struct place *at, struct err *err);
void gzip_close(struct gzip *gzip);

/* Upper bound of the unpacked size. */
size_t gzip_size_most(const struct gzip *gzip);

/* Returns the last `keep` bytes of the previous piece (NULL and 0 at first) followed by
 * at most a megabyte of new data; zero-terminated, valid until the next call. *size ==
 * keep: end of the file. NULL if the file is damaged. */
const char *gzip_more(struct gzip *gzip, size_t keep, size_t *size, struct err *err);

#endif

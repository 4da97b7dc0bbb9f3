#ifndef ETALON_IMPORT_GZIP_H
#define ETALON_IMPORT_GZIP_H

/* Files read piece by piece, unpacked on the way where gzip packed them (zlib's gzread).
 * The first bytes of the file say so; one that is named .gz and does not is an error. A
 * kilobyte can stand for a megabyte, so that whoever reads is to find out what is wrong
 * before all of it lies in memory; and what is decoded need not lie in memory twice. */

#include "base/err.h"

#include <stddef.h>

/* DEFLATE makes at most that many bytes of one. */
#define GZIP_RATIO 1032

struct gzip;

/* NULL if the file cannot be opened, or is none. The path, and at's, must outlive it. */
struct gzip *gzip_open(const char *path, const struct place *at, struct err *err);
void gzip_close(struct gzip *gzip);

/* No more than that many bytes can come out. */
size_t gzip_size_most(const struct gzip *gzip);

/* The last `keep` bytes of the piece before (NULL and 0 at first) and behind them at most
 * a megabyte that follows; zero-terminated, good until the next call. *size == keep: that
 * was all. NULL if the file is damaged. */
const char *gzip_more(struct gzip *gzip, size_t keep, size_t *size, struct err *err);

#endif

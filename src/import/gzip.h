#ifndef ETALON_IMPORT_GZIP_H
#define ETALON_IMPORT_GZIP_H

/* Files that may be packed by gzip. */

#include "base/err.h"

#include <stddef.h>

/* As text_read_file, and unpacked if the name ends in .gz. */
char *gzip_read_file(const char *path, size_t *size, const struct place *at,
                     struct err *err);

#endif

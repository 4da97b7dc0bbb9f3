#ifndef ETALON_IMPORT_SUGGEST_H
#define ETALON_IMPORT_SUGGEST_H

#include "base/err.h"

/* Fails with: unknown <what> "<name>"; did you mean "<nearest>"? (known: a, b, c).
 * known ends with NULL. Returns false. */
bool suggest_fail(struct err *err, const struct place *at, const char *what,
                  const char *name, const char *const *known);

#endif

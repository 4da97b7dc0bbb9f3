#ifndef ETALON_IMPORT_SUGGEST_H
#define ETALON_IMPORT_SUGGEST_H

#include "base/err.h"

/* Fails with: unknown <what> "<name>"; did you mean "<nearest>"? Or, if none is near:
 * (known: a, b, c), as many as a message holds. known ends with NULL. Returns false. */
bool suggest_fail(struct err *err, const struct place *at, const char *what,
                  const char *name, const char *const *known);

#endif

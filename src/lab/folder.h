#ifndef ETALON_LAB_FOLDER_H
#define ETALON_LAB_FOLDER_H

/* Folders of results. */

#include "base/err.h"

#include <stdbool.h>

/* Makes the folder and those above it, unless they are there. */
bool folder_make(const char *path, struct err *err);

/* Locks the folder by a file "lock" in it, for as long as the process lives or until the
 * descriptor is closed; -1 on failure, which *busy tells from another process holding the
 * lock. wait: until that one is done. */
int folder_lock(const char *path, bool wait, bool *busy, struct err *err);

/* Removes NAME.part<number>: what a process that died was writing. */
void folder_remove_parts(const char *path);

#endif

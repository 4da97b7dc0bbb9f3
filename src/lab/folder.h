#ifndef ETALON_LAB_FOLDER_H
#define ETALON_LAB_FOLDER_H

/* Folders of results. */

#include "base/err.h"

#include <stdbool.h>

/* Creates the folder and its parents if they do not exist. */
bool folder_make(const char *path, struct err *err);

/* Locks the folder by a file "lock" in it, until the descriptor is closed or the process
 * ends. -1 on failure; *busy: another process holds the lock. wait: waits for that
 * process instead. */
int folder_lock(const char *path, bool wait, bool *busy, struct err *err);

/* Removes NAME.part<number>, unfinished files of processes that died. */
void folder_remove_parts(const char *path);

#endif

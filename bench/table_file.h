#ifndef ETALON_BENCH_TABLE_FILE_H
#define ETALON_BENCH_TABLE_FILE_H

/* CSV files that bench programs leave for plots. */

#include <stdio.h>
#include <stdlib.h>

/* FOLDER/NAME, its header line written; ends the program with 1 if that cannot be. */
static inline FILE *table_file_open(const char *folder, const char *name,
                                    const char *header)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *f = fopen(path, "w");
    if (f == NULL) {
        fprintf(stderr, "cannot write %s\n", path);
        exit(1);
    }
    fprintf(f, "%s\n", header);
    return f;
}

#endif

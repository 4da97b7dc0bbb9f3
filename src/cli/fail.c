#include "cli/fail.h"

#include <stdio.h>

int fail(const struct err *err)
{
    char line[sizeof err->file + sizeof err->message + 64];
    err_format(err, line, (int)sizeof line);
    fflush(stdout);
    fprintf(stderr, "etalon: error: %s\n", line);
    return err->code == ERR_USAGE ? 2 : 1;
}

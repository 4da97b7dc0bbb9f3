#include "base/libraries.h"

#include <stdlib.h>
#include <unistd.h>

void libraries_prepare(char *const *argv)
{
    static const char *const names[] = {"OMP_WAIT_POLICY", "GOMP_SPINCOUNT",
                                        "KMP_BLOCKTIME"};
    for (int i = 0; i < 3; i++)
        if (getenv(names[i]))
            return;
    setenv("GOMP_SPINCOUNT", "1000", 1); /* of gcc's runtime; some tens of microseconds */
    setenv("KMP_BLOCKTIME", "0", 1);     /* clang's */
    setenv("GLIBC_TUNABLES", "glibc.malloc.hugetlb=1", 0);
    execv("/proc/self/exe", argv); /* if that fails, the program runs with the defaults */
}

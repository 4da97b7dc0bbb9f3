#ifndef ETALON_TESTS_SUPPORT_TEST_FILE_H
#define ETALON_TESTS_SUPPORT_TEST_FILE_H

/* Names of files that a test writes. */

#include "base/text.h"

#include <stdlib.h>
#include <unistd.h>

/* In the folder that tests/run_tests.sh makes for each test, else in /tmp. The number of
 * the process keeps two runs of a test apart. The caller frees it. */
static inline char *test_file(const char *name)
{
    const char *folder = getenv("TEST_TMP");
    return text_format("%s/etalon-test-%ld-%s", folder ? folder : "/tmp", (long)getpid(),
                       name);
}

#endif

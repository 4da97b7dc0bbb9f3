#ifndef ETALON_TESTS_SUPPORT_SHARED_SCENES_H
#define ETALON_TESTS_SUPPORT_SHARED_SCENES_H

/* Scenes that others made: beside the repository, where they are present at all. */

#include <stdbool.h>
#include <stdio.h>

#define SHARED_SCENES "../shared/scenes/"

/* Says so if they are not. */
static inline bool shared_scenes_there(void)
{
    FILE *readme = fopen(SHARED_SCENES "README.md", "r");
    if (!readme) {
        printf("no " SHARED_SCENES "\n");
        return false;
    }
    fclose(readme);
    return true;
}

#endif

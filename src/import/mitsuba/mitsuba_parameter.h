#ifndef ETALON_IMPORT_MITSUBA_PARAMETER_H
#define ETALON_IMPORT_MITSUBA_PARAMETER_H

/* The $parameters of a Mitsuba file: those that the options define, then those of its
 * <default>s; of each name the first counts. Zero-initialised is empty. */

#include "import/import.h"

#define MITSUBA_VALUE_MAX 65536 /* bytes of an attribute that $parameters made */

struct mitsuba_parameter;

struct mitsuba_parameters {
    struct mitsuba_parameter *list;
    size_t count, capacity;
};

void mitsuba_parameters_deinit(struct mitsuba_parameters *parameters);
/* "name=value" of the options; NULL: none. */
bool mitsuba_parameters_define(struct mitsuba_parameters *parameters,
                               const struct import_options *options, struct err *err);
/* A <default> of the file. */
void mitsuba_parameters_default(struct mitsuba_parameters *parameters, const char *name,
                                const char *value);
/* A copy with every $name replaced; NULL after an error. Values were replaced when they
 * were defined, so that each could double the one before. */
char *mitsuba_parameters_replace(const struct mitsuba_parameters *parameters,
                                 const char *text, const struct place *at,
                                 struct err *err);
/* Fails if the file never asked for what the options define: a slip of the pen. */
bool mitsuba_parameters_check(const struct mitsuba_parameters *parameters,
                              const char *path, struct err *err);

#endif

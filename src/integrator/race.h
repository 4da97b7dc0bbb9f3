#ifndef ETALON_INTEGRATOR_RACE_H
#define ETALON_INTEGRATOR_RACE_H

/* A choice among integrators by the measured error of short pilot runs; see race.c. The
 * pilots are no part of the picture, so the choice makes no bias. */

#include "integrator/integrator.h"

struct race;

struct race *race_create(const struct scene *scene, const struct settings *settings);
void race_destroy(struct race *race); /* NULL is legal */
/* Adds the memory of the pilots, of which one runs at a time. */
void race_memory(const struct scene *scene, struct run_memory *out);
/* The integrators that may win: pt, if it can sample all that bdpt can; NULL past the
 * end. */
const char *race_candidate(const struct scene *scene, int index);

/* Runs the next pilot. False once the race is over. Under a budget of paths nothing
 * depends on the clock. */
bool race_advance(struct race *race, const struct round_limits *limits);
double race_paths(const struct race *race); /* of all pilots so far */
/* The choice, after the end. */
void race_result(const struct race *race, struct race_figures *out);

#endif

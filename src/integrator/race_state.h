#ifndef ETALON_INTEGRATOR_RACE_STATE_H
#define ETALON_INTEGRATOR_RACE_STATE_H

/* The internals of a race; included by race*.c only. */

#include "integrator/race.h"
#include "integrator/race_error.h"

/* pt, bdpt, pssmlt, mmlt; bdpt is the one that does without a race. */
enum { RACE_PT, RACE_BDPT, RACE_PSSMLT, RACE_MMLT, RACE_CANDIDATES };
extern const char *const race_names[RACE_CANDIDATES];

/* Share of the budget's work: pilots that need more are not run. */
#define RACE_SHARE_ALL 0.15

struct entry {
    const struct integrator_type *type; /* NULL: no candidate */
    double work;                        /* of a path */
    double paths;                       /* of a pilot */
    struct race_halves halves;
    double spent; /* work of both pilots */
    double seeds; /* chains: effective number of paths at which they begin, the lesser */
    double score; /* error times work; INFINITY: of no use */
    double least; /* chains: a bound of the score, by which they cannot win; else 0 */
};

struct race {
    const struct scene *whole;
    struct scene scene; /* `whole` with the film of the pilots */
    const struct settings *settings;
    struct entry entries[RACE_CANDIDATES];
    struct image *image;
    float *scale;   /* of errors, by pt and bdpt; race_weigh() */
    long edges_cut; /* by pilots, which are no part of the picture */
    int next, half; /* of the pilot to come */
    bool begun, over, judged;
    double budget;      /* work of the whole run */
    double pace;        /* work a second, and */
    double time;        /* that there is time for, under a time budget */
    double paths, work; /* of all pilots */
};

static inline double race_pixels(const struct scene *scene)
{
    return (double)scene->camera.width * scene->camera.height;
}

/* race_choice.c: which chains cannot win, once the pilots of pt and bdpt have run;
 * scores, once all have run; and the work of the samples that it takes for this. */
void race_screen(struct race *race);
void race_judge(struct race *race);
double race_moment_work(const struct race *race);

#endif

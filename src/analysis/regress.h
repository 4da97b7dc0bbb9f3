#ifndef ETALON_ANALYSIS_REGRESS_H
#define ETALON_ANALYSIS_REGRESS_H

/* Statistics of an experiment against those of a baseline.
 *
 * The hypothesis is that both come from one program, with other seeds. Then the runs of
 * either side spread alike, so a difference of means is held against the spread of all of
 * them together: Student's t with n1 + n2 - 2 degrees of freedom, which serves a single
 * run beside a baseline too. Where the two sides clearly do not spread alike (a rare
 * event among few runs, say), Welch's t has to agree before anything is called moved.
 * With one run on either side there is no spread, and only a run's own standard error is
 * left. What does not vary at all must be equal, up to the rounding of float.
 *
 * relmse is compared as a logarithm. The level is that of the whole table: each of m
 * tests has 1 - (1 - level)^(1/m) (Sidak). */

#include "analysis/cells.h"

enum regress_verdict {
    REGRESS_SAME,
    REGRESS_MOVED,   /* a figure, by chance with less than the level's probability */
    REGRESS_DIFFERS, /* a setting or what the cell is made of: nothing else of the cell is
                      * compared */
    REGRESS_GONE,    /* the cell, or the statistic in all of its runs */
};

enum regress_test {
    REGRESS_NONE,
    REGRESS_STUDENT, /* one spread for both sides */
    REGRESS_WELCH,   /* one for each */
    REGRESS_WITHIN,  /* normal, by the standard error that single runs tell */
    REGRESS_EQUAL,   /* nothing varies */
    REGRESS_MISSING, /* how many runs lack it: Fisher's exact test */
};

struct regress_row {
    const struct cell *cell; /* of the baseline */
    const char *statistic;   /* "" for the cell as a whole */
    enum regress_verdict verdict;
    enum regress_test test;
    const struct cell_statistic *base, *now; /* NULL: there is none */
    const char *base_text, *now_text;        /* of what differs, or NULL */
    double change; /* now - base; of logarithms for a CELL_LOG */
    double se;     /* of the change */
    double freedom;
    double p; /* two-sided */
    /* A change of this size is seen with probability 0.9. NAN where nothing varies. */
    double detectable;
};

struct regress {
    struct regress_row *rows; /* in the order of the baseline */
    size_t count, capacity;
    size_t tests;   /* that chance can make fail */
    size_t changes; /* rows that are not REGRESS_SAME */
    double level_each;
};

/* level: in (0,1). What is new, not tested, or tested with less force than it seems
 * becomes notes. The rows borrow from both tables. */
void regress_compare(const struct cells *base, const struct cells *now, double level,
                     struct regress *out, struct log *log);
void regress_deinit(struct regress *regress);

const char *regress_test_name(enum regress_test test);
const char *regress_verdict_name(enum regress_verdict verdict);

/* As a table, one line a row. The file is replaced as a whole or not at all. */
bool regress_write(const char *path, const struct regress *regress, struct err *err);

#endif

#ifndef ETALON_ANALYSIS_REGRESS_H
#define ETALON_ANALYSIS_REGRESS_H

/* Statistics of an experiment against those of a baseline.
 *
 * The null hypothesis is that both come from the same program with other seeds. Then the
 * variances of both sides are equal, and the difference of means is tested with their
 * pooled variance: Student's t with n1 + n2 - 2 degrees of freedom, which also works for
 * a single run against a baseline. Where the variances clearly differ (for example a rare
 * event in few runs), Welch's t [Welch47] has to agree before a statistic is called
 * moved. With one run on either side, the standard error that the run itself states is
 * used. A statistic that does not vary at all must be equal up to the rounding of float.
 *
 * relmse is compared as a logarithm. The level is that of the whole table: each of m
 * tests has 1 - (1 - level)^(1/m) (Sidak). */

#include "analysis/cells.h"

enum regress_verdict {
    REGRESS_SAME,
    REGRESS_MOVED,   /* a figure: the change is significant at this level */
    REGRESS_DIFFERS, /* a setting or the contents: nothing else of the cell is compared */
    REGRESS_GONE,    /* the cell, or the statistic in all of its runs, is missing now */
};

enum regress_test {
    REGRESS_NONE,
    REGRESS_STUDENT, /* pooled variance */
    REGRESS_WELCH,   /* separate variances */
    REGRESS_WITHIN,  /* normal, with the standard error that runs state */
    REGRESS_EQUAL,   /* nothing varies */
    REGRESS_MISSING, /* number of runs without the statistic: Fisher's exact test */
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
    size_t tests;   /* number of tests */
    size_t changes; /* rows that are not REGRESS_SAME */
    double level_each;
};

/* level: in (0,1). New and untested statistics, and tests with little power, become
 * notes. The rows borrow from both tables. */
void regress_compare(const struct cells *base, const struct cells *now, double level,
                     struct regress *out, struct log *log);
void regress_deinit(struct regress *regress);

const char *regress_test_name(enum regress_test test);
const char *regress_verdict_name(enum regress_verdict verdict);

/* Writes the rows as a table. The file is replaced as a whole or not at all. */
bool regress_write(const char *path, const struct regress *regress, struct err *err);

#endif

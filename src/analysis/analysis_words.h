#ifndef ETALON_ANALYSIS_ANALYSIS_WORDS_H
#define ETALON_ANALYSIS_ANALYSIS_WORDS_H

/* The outcome of an experiment in words: one sentence each, plain text without an end of
 * line. */

#include "base/text.h"
#include "analysis/analysis_ranking.h"
#include "analysis/analysis_summary.h"

/* "relMSE without the worst 1 % of pixels", "relMSE of all pixels", "MSE", ... */
const char *analysis_error_words(enum results_error error);

/* "coffee, 5 s": scene and budget of the cell. */
void analysis_append_group(struct text *text, const struct results_cell *group);

/* Who is best and by how much: "pt is best; pssmlt has 2.9 [2.5, 3.3] times its error; 8
 * seeds". Brackets: 95 % interval. One whose interval contains 1 is not told apart. */
void analysis_append_best(struct text *text, const struct analysis_ranking *ranking);

/* "automatic, zsolnai2013: 1.053 in the geometric mean of 14 cells, 1.096 at worst
 * (coffee, 5 s, pssmlt); best constant p_l = 0.5: ...". Nothing without a policy. */
void analysis_append_regret(struct text *text, const struct analysis_summary *summary);

#endif

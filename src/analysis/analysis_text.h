#ifndef ETALON_ANALYSIS_ANALYSIS_TEXT_H
#define ETALON_ANALYSIS_ANALYSIS_TEXT_H

/* The analysis as tables of plain text; where a figure is missing, the reason in words.
 */

#include "analysis/results.h"

#include <stdio.h>

struct analysis_text_options {
    enum results_axis axis;
    enum results_error error;
    bool pictures; /* read them, for the split of error into bias and variance */
};

void analysis_text_print(FILE *out, const struct results *results,
                         const struct analysis_text_options *options);

#endif

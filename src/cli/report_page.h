#ifndef ETALON_CLI_REPORT_PAGE_H
#define ETALON_CLI_REPORT_PAGE_H

/* The page of a folder of results, as `etalon report` and `etalon render -i all` write
 * it.
 */

#include "report/report.h"

/* The error to compare by if none is asked for: trimmed relMSE; relMSE in tables of older
 * programs; without references that by the runs' own error bars. */
enum results_error report_page_error(const struct results *results);
/* Writes FOLDER/report.html, and says so. */
bool report_page_write(struct results *results, const struct report_options *options,
                       struct err *err);

#endif

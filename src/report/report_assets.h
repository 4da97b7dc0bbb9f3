#ifndef ETALON_REPORT_REPORT_ASSETS_H
#define ETALON_REPORT_REPORT_ASSETS_H

/* report.css, report.html, report_live.html and the scripts, line by line with NULL at
 * the end, as .ci/embed puts them into the program. */

extern const char *const report_style[], *const report_comparer[], *const report_script[];
extern const char *const report_live_body[], *const report_live_script[];

#endif

#ifndef ETALON_CLI_LIVE_PAGE_H
#define ETALON_CLI_LIVE_PAGE_H

/* The page of a run that is still going (report/report_live.h), made on a thread of its
 * own and published in a folder or at a port (live/site.h). */

#include "cli/session.h"
#include "run/run.h"

struct live_page;

/* name: of the run. every: s between two looks. */
struct live_page *live_page_open(const char *where, const char *name, double every,
                                 struct err *err);
const char *live_page_address(const struct live_page *page);
/* Before the first look, once the scene is read; all is borrowed. reference: or NULL. */
void live_page_begin(struct live_page *page, const struct session *session,
                     const struct image *reference);
/* The last look is published. */
bool live_page_ready(struct live_page *page);
/* Publishes a look at the run; copies what it needs. */
void live_page_show(struct live_page *page, const struct run_result *now, bool ended);
double live_page_cpu(struct live_page *page); /* CPU time so far, in s */
/* Waits some seconds for viewers that have not seen the end. */
void live_page_close(struct live_page *page);

#endif

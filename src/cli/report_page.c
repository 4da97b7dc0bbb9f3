#include "cli/report_page.h"

#include "base/mem.h"
#include "cli/output.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static bool has_error(const struct results *results, enum results_error error)
{
    for (size_t c = 0; c < results->cell_count; c++)
        for (size_t i = 0; i < results->cells[c].run_count; i++)
            if (isfinite(results->cells[c].runs[i].error[error]))
                return true;
    return false;
}

enum results_error report_page_error(const struct results *results)
{
    if (has_error(results, RESULTS_RELMSE_TRIMMED))
        return RESULTS_RELMSE_TRIMMED;
    if (has_error(results, RESULTS_RELMSE) || !has_error(results, RESULTS_ESTIMATED))
        return RESULTS_RELMSE;
    return RESULTS_ESTIMATED;
}

bool report_page_write(struct results *results, const struct report_options *options,
                       struct err *err)
{
    struct log log;
    log_init(&log);
    char *path = text_join(results->folder, "report.html");
    char *page = output_check(path, err) ? report_html(results, options, &log, err)
                                         : NULL;
    bool ok = page && text_write_file(path, page, strlen(page), err);
    log_print(&log, stderr);
    if (ok)
        printf("%s (%.1f MB)\n", path, (double)strlen(page) * 1e-6);
    mem_free(page);
    mem_free(path);
    log_deinit(&log);
    return ok;
}

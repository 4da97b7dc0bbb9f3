#include "lab/parts.h"

#include "base/mem.h"
#include "base/text.h"

#include <math.h>
#include <unistd.h>

static char *folder_of(const char *results, const struct job *job)
{
    return text_format("%s/parts/%s", results, job->id);
}

static bool is_there(const char *folder)
{
    return access(folder, F_OK) == 0;
}

static void read_outcome(const struct csv *runs, size_t row, struct outcome *outcome)
{
    outcome->seconds = csv_number(runs, row, csv_column(runs, "seconds_total"));
    outcome->paths = csv_number(runs, row, csv_column(runs, "paths"));
    outcome->relmse = csv_number(runs, row, csv_column(runs, "relmse"));
    outcome->noise = csv_number(runs, row, csv_column(runs, "reference_relmse"));
    outcome->black = !(csv_number(runs, row, csv_column(runs, "b")) > 0.0);
}

static bool find_row(const char *folder, const struct job *job, struct outcome *outcome)
{
    /* A table that cannot be read is no finished part; part_run reports why. */
    struct err ignored = {0};
    struct csv *runs = store_read_runs(folder, &ignored);
    bool found = false;
    for (size_t row = 1; runs && row < runs->rows && !found; row++) {
        found = text_equal(csv_cell(runs, row, csv_column(runs, "job")), job->id);
        if (found && outcome)
            read_outcome(runs, row, outcome);
    }
    csv_destroy(runs);
    return found;
}

bool part_is_finished(const char *results, const struct job *job, struct outcome *outcome)
{
    char *folder = folder_of(results, job);
    bool finished = find_row(folder, job, outcome);
    mem_free(folder);
    return finished;
}

bool part_run(struct job_context *context, const char *results, const struct job *job,
              struct outcome *outcome, struct err *err)
{
    char *folder = folder_of(results, job);
    struct store *store = store_open(folder, true, err);
    bool ok = store && (find_row(folder, job, outcome) ||
                        job_context_run(context, job, store, outcome, err));
    store_close(store);
    mem_free(folder);
    return ok;
}

/* The process that holds the lock of a finished part is about to release it. */
bool part_join(struct store *store, const char *results, const struct job *job,
               struct err *err)
{
    char *folder = folder_of(results, job);
    struct store *part = store_open(folder, true, err);
    bool ok = part && store_take(store, part, job->id, err);
    if (ok)
        store_remove(part);
    else
        store_close(part);
    mem_free(folder);
    return ok;
}

void part_drop(const char *results, const struct job *job)
{
    char *folder = folder_of(results, job);
    struct err ignored = {0};
    struct store *part = is_there(folder) ? store_open(folder, false, &ignored) : NULL;
    if (part) {
        char *picture = store_picture_path(part, job->id);
        unlink(picture);
        mem_free(picture);
        store_remove(part);
    }
    mem_free(folder);
}

void parts_tidy(const char *results)
{
    char *folder = text_join(results, "parts");
    rmdir(folder);
    mem_free(folder);
}

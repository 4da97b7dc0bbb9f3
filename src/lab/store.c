#include "lab/store.h"

#include "base/mem.h"
#include "lab/folder.h"
#include "lab/reference_noise.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct store {
    char *folder, *images, *runs, *curves;
    int lock; /* file descriptor; closing it frees the lock */
    bool upgraded;
};

/* --- columns --------------------------------------------------------------------- */

static const char *const cell_columns[] = {"experiment", "cell", NULL};
static const char *const first_columns[] = {"job", "label", "scene_label", NULL};
static const char *const last_columns[] = {"rmse",
                                           "relmse",
                                           "relmse_trimmed",
                                           "mean_ratio",
                                           "reference",
                                           "reference_rmse",
                                           "reference_relmse",
                                           "rmse_corrected",
                                           "relmse_corrected",
                                           "reference_relmse_trimmed",
                                           "relmse_trimmed_corrected",
                                           "relmse_trim",
                                           "smape",
                                           "flip",
                                           NULL};

static void append_all(struct text *line, const char *const *values)
{
    for (; *values; values++)
        csv_append(line, *values);
}

static char *runs_header(void)
{
    struct text line = {0};
    append_all(&line, first_columns);
    for (int i = 0; i < statistics_count(); i++)
        csv_append(&line, statistics_name(i));
    append_all(&line, cell_columns);
    append_all(&line, last_columns);
    text_append(&line, "\n");
    return line.data;
}

static char *curves_header(void)
{
    struct text line = {0};
    csv_append(&line, "job");
    text_append(&line, ",");
    error_log_append_header(&line);
    return line.data;
}

/* The error and the reference's noise are independent, so their squares add. The
 * corrected error is an estimate and may be negative; clamping it at 0 would bias means
 * over runs. */
static void append_reference(struct text *line, const struct store_result *result,
                             const struct metric *metric)
{
    const struct reference *reference = result->reference;
    struct noise noise = reference ? reference->noise : reference_noise_unknown();
    double square = metric->rmse * metric->rmse - noise.rmse * noise.rmse;
    csv_append(line, reference ? result->reference_path : "");
    csv_append_number(line, noise.rmse);
    csv_append_number(line, noise.relmse);
    csv_append_number(line, copysign(sqrt(fabs(square)), square));
    csv_append_number(line, metric->relmse - noise.relmse);
    csv_append_number(line, noise.relmse_trimmed);
    csv_append_number(line, metric->relmse_trimmed - noise.relmse_trimmed);
    csv_append_number(line, reference ? 1.0 / METRIC_TRIM : (double)NAN);
}

static char *runs_row(const struct store_result *result)
{
    const double nan = (double)NAN;
    const struct metric none = {.rmse = nan,
                                .relmse = nan,
                                .relmse_trimmed = nan,
                                .mean_ratio = nan,
                                .smape = nan};
    const struct metric *metric = result->metric ? result->metric : &none;
    struct text line = {0};
    int count;
    /* Attribute values are not quoted; the table adds its own quotes. */
    struct exr_attribute *values = statistics_attributes(result->record, &count);
    append_all(&line, (const char *const[]){result->job, result->label,
                                            result->scene_label, NULL});
    for (int i = 0; i < count; i++)
        csv_append(&line, values[i].value);
    statistics_attributes_destroy(values, count);
    append_all(&line, (const char *const[]){result->experiment, result->cell, NULL});
    csv_append_number(&line, metric->rmse);
    csv_append_number(&line, metric->relmse);
    csv_append_number(&line, metric->relmse_trimmed);
    csv_append_number(&line, metric->mean_ratio);
    append_reference(&line, result, metric);
    csv_append_number(&line, metric->smape);
    csv_append_number(&line, result->metric ? result->flip : nan);
    text_append(&line, "\n");
    return line.data;
}

static char *curve_rows(const struct store_result *result)
{
    struct text lines = {0};
    for (size_t i = 0; i < result->curve_count; i++) {
        text_append(&lines, "%s,", result->job);
        error_log_append_row(&lines, &result->curve[i]);
    }
    return lines.data;
}

/* --- opening --------------------------------------------------------------------- */

static bool is_removed(int file)
{
    struct stat info;
    return fstat(file, &info) == 0 && info.st_nlink == 0;
}

/* Creates the folder again if another process removed it with its lock (store_remove). */
static bool take_lock(struct store *store, bool wait, struct err *err)
{
    bool busy = false, gone;
    do {
        if (!folder_make(store->folder, err))
            return false;
        store->lock = folder_lock(store->folder, wait, &busy, err);
        gone = store->lock >= 0 && is_removed(store->lock);
        if (gone)
            close(store->lock);
    } while (gone);
    if (busy)
        err_set(err, ERR_IO, NULL,
                "another batch is at work in '%s'; wait for it, or give another "
                "folder: -o DIR",
                store->folder);
    return store->lock >= 0;
}

/* Upgrades the table of an older program whose columns are all among today's: new columns
 * are filled in as unknown. */
static bool upgrade(const char *path, const char *header, struct err *err)
{
    struct csv *csv = csv_read(path, err);
    if (csv == NULL)
        return false;
    struct text text = {0};
    bool ok = csv_fits(csv, header) ||
              err_set(err, ERR_VALUE, &(struct place){path, 1, 0},
                      "its columns are not those of this program: it was written by "
                      "another version; move the folder away, or give another: -o DIR");
    text_append(&text, "%s", header);
    for (size_t row = 1; ok && row < csv->rows; row++)
        csv_append_row(&text, csv, row, header);
    ok = ok && text_write_file(path, text.data, text.length, err);
    mem_free(text.data);
    csv_destroy(csv);
    return ok;
}

/* Opens a table: creates it, or checks or upgrades its columns. */
static bool open_table(struct store *store, const char *path, const char *header,
                       struct err *err)
{
    if (access(path, F_OK) != 0)
        return text_write_file(path, header, strlen(header), err);
    size_t size, length = strlen(header);
    char *text = text_read_file(path, &size, NULL, err);
    if (text == NULL)
        return false;
    bool same = size >= length && memcmp(text, header, length) == 0;
    mem_free(text);
    if (access(path, W_OK) != 0)
        return err_set(err, ERR_IO, NULL, "cannot write '%s': %s", path, strerror(errno));
    store->upgraded = store->upgraded || !same;
    return same || upgrade(path, header, err);
}

/* --- what a dead batch left ------------------------------------------------------ */

static bool cut(const char *path, size_t size, struct err *err)
{
    return truncate(path, (off_t)size) == 0 ||
           err_set(err, ERR_IO, NULL, "cannot write '%s': %s", path, strerror(errno));
}

static bool keep_finished(const struct csv *curves, const struct csv *runs,
                          struct err *err)
{
    struct text kept = {0};
    size_t count = 0;
    char *header = curves_header();
    for (size_t row = 0; row < curves->rows; row++) {
        if (row > 0 && !store_has_job(runs, csv_cell(curves, row, 0)))
            continue;
        csv_append_row(&kept, curves, row, header);
        count++;
    }
    bool ok = count == curves->rows ||
              text_write_file(curves->path, kept.data, kept.length, err);
    mem_free(kept.data);
    mem_free(header);
    return ok;
}

static bool mend(struct store *store, struct err *err)
{
    struct csv *runs = csv_read(store->runs, err);
    struct csv *curves = runs ? csv_read(store->curves, err) : NULL;
    bool ok = curves && cut(store->runs, runs->whole, err) &&
              cut(store->curves, curves->whole, err) && keep_finished(curves, runs, err);
    csv_destroy(runs);
    csv_destroy(curves);
    folder_remove_parts(store->folder);
    folder_remove_parts(store->images);
    return ok;
}

static bool open_all(struct store *store, bool wait, struct err *err)
{
    char *header = runs_header(), *curves = curves_header();
    bool ok = take_lock(store, wait, err) && folder_make(store->images, err) &&
              open_table(store, store->runs, header, err) &&
              open_table(store, store->curves, curves, err) && mend(store, err);
    mem_free(header);
    mem_free(curves);
    return ok;
}

struct store *store_open(const char *folder, bool wait, struct err *err)
{
    struct store *store = mem_alloc(1, sizeof *store);
    *store = (struct store){
        .folder = text_copy(folder),
        .images = text_format("%s/images", folder),
        .runs = text_format("%s/runs.csv", folder),
        .curves = text_format("%s/curves.csv", folder),
        .lock = -1,
    };
    if (open_all(store, wait, err))
        return store;
    store_close(store);
    return NULL;
}

void store_close(struct store *store)
{
    if (store == NULL)
        return;
    if (store->lock >= 0)
        close(store->lock);
    mem_free(store->folder);
    mem_free(store->images);
    mem_free(store->runs);
    mem_free(store->curves);
    mem_free(store);
}

bool store_upgraded(const struct store *store)
{
    return store->upgraded;
}

/* --- rows ------------------------------------------------------------------------ */

char *store_picture_path(const struct store *store, const char *job)
{
    return text_format("%s/%s.exr", store->images, job);
}

static bool write_lines(int fd, const char *lines, size_t size)
{
    while (size > 0) {
        ssize_t n = write(fd, lines, size);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            return false;
        lines += n;
        size -= (size_t)n;
    }
    return fdatasync(fd) == 0 || errno == EINVAL;
}

/* Writes lines in one call and syncs. If the system writes only a part, that is cut off
 * again (or by the next batch). Keeps errno. */
static bool append_lines(int fd, const char *lines, size_t size)
{
    struct stat before;
    if (fstat(fd, &before) != 0)
        return false;
    if (write_lines(fd, lines, size))
        return true;
    int cause = errno;
    errno = ftruncate(fd, before.st_size) == 0 ? cause : errno;
    return false;
}

static bool append(const char *path, const char *lines, struct err *err)
{
    int fd = open(path, O_WRONLY | O_APPEND | O_CLOEXEC);
    bool ok = fd >= 0 && append_lines(fd, lines, strlen(lines));
    if (!ok)
        err_set(err, ERR_IO, NULL, "cannot write '%s': %s", path, strerror(errno));
    if (fd >= 0)
        close(fd);
    return ok;
}

static bool append_both(struct store *store, const char *curves, const char *row,
                        struct err *err)
{
    return (curves == NULL || append(store->curves, curves, err)) &&
           append(store->runs, row, err);
}

bool store_append(struct store *store, const struct store_result *result, struct err *err)
{
    char *curves = curve_rows(result), *row = runs_row(result);
    bool ok = append_both(store, curves, row, err);
    mem_free(curves);
    mem_free(row);
    return ok;
}

/* Moves the picture here. If it is here already, a batch moved it and died before it
 * wrote the row. */
static bool take_picture(struct store *store, struct store *other, const char *job,
                         struct err *err)
{
    char *from = store_picture_path(other, job), *to = store_picture_path(store, job);
    bool ok = rename(from, to) == 0 || (errno == ENOENT && access(to, F_OK) == 0) ||
              err_set(err, ERR_IO, NULL, "cannot move '%s' to '%s': %s", from, to,
                      strerror(errno));
    mem_free(from);
    mem_free(to);
    return ok;
}

/* All rows of that job, NULL if there are none. */
static char *rows_of(const char *path, const char *job, const char *header,
                     struct err *err)
{
    struct text lines = {0};
    struct csv *csv = csv_read(path, err);
    int column = csv ? csv_column(csv, "job") : -1;
    for (size_t row = 1; csv && row < csv->rows; row++)
        if (text_equal(csv_cell(csv, row, column), job))
            csv_append_row(&lines, csv, row, header);
    csv_destroy(csv);
    return lines.data;
}

bool store_take(struct store *store, struct store *other, const char *job,
                struct err *err)
{
    struct err inner = {0};
    char *runs = runs_header(), *curves = curves_header();
    char *row = rows_of(other->runs, job, runs, &inner);
    char *points = rows_of(other->curves, job, curves, &inner);
    bool ok = inner.code == ERR_NONE && row && take_picture(store, other, job, &inner) &&
              append_both(store, points, row, &inner);
    if (!ok && err)
        *err = inner;
    mem_free(runs);
    mem_free(curves);
    mem_free(row);
    mem_free(points);
    return ok;
}

void store_remove(struct store *store)
{
    unlink(store->runs);
    unlink(store->curves);
    rmdir(store->images);
    char *lock = text_join(store->folder, "lock");
    unlink(lock);
    mem_free(lock);
    rmdir(store->folder);
    store_close(store);
}

struct csv *store_read_runs(const char *folder, struct err *err)
{
    char *path = text_format("%s/runs.csv", folder);
    struct csv *runs = access(path, F_OK) == 0 ? csv_read(path, err) : NULL;
    mem_free(path);
    return runs;
}

bool store_has_job(const struct csv *runs, const char *job)
{
    int column = csv_column(runs, "job");
    for (size_t row = 1; row < runs->rows; row++)
        if (text_equal(csv_cell(runs, row, column), job))
            return true;
    return false;
}

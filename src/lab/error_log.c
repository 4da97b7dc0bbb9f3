#include "lab/error_log.h"

#include "base/mem.h"
#include "base/text.h"
#include "lab/scalar.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <unistd.h>

struct error_log {
    int fd;
    char *path;
};

struct column {
    const char *name;
    size_t offset; /* of a double in struct error_row */
};

#define AT(field) offsetof(struct error_row, field)

static const struct column columns[] = {
    {"wall_s", AT(wall_s)},
    {"cpu_s", AT(cpu_s)},
    {"paths", AT(paths)},
    {"mutations_per_pixel", AT(mutations_per_pixel)},
    {"rmse", AT(metric.rmse)},
    {"relmse", AT(metric.relmse)},
    {"relmse_trimmed", AT(metric.relmse_trimmed)},
    {"mean_ratio", AT(metric.mean_ratio)},
    {"b", AT(b)},
    {"b_se", AT(b_se)},
    {"eta_s_run", AT(eta_s)},
    {"eta_l_run", AT(eta_l)},
    {"eta_0_run", AT(eta_0)},
    {"acceptance", AT(acceptance)},
    {"failure_rate", AT(failure_rate)},
    {"n_nonfinite", AT(nonfinite)},
    {"n_saturated", AT(saturated)},
};

#define COLUMN_COUNT (sizeof columns / sizeof columns[0])

/* Writes a line in one call, so that the file has no partial rows. */
static bool write_line(struct error_log *log, const struct text *line, struct err *err)
{
    for (size_t done = 0; done < line->length;) {
        ssize_t n = write(log->fd, line->data + done, line->length - done);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            return err_set(err, ERR_IO, NULL, "cannot write '%s': %s", log->path,
                           strerror(errno));
        done += (size_t)n;
    }
    return true;
}

void error_log_append_header(struct text *line)
{
    for (size_t i = 0; i < COLUMN_COUNT; i++)
        text_append(line, "%s%s", i ? "," : "", columns[i].name);
    text_append(line, "\n");
}

void error_log_append_row(struct text *line, const struct error_row *row)
{
    for (size_t i = 0; i < COLUMN_COUNT; i++) {
        double value;
        memcpy(&value, (const char *)row + columns[i].offset, sizeof value);
        text_append(line, i ? "," : "");
        scalar_append_number(line, value);
    }
    text_append(line, "\n");
}

static bool write_header(struct error_log *log, struct err *err)
{
    struct text line = {0};
    error_log_append_header(&line);
    bool ok = write_line(log, &line, err);
    mem_free(line.data);
    return ok;
}

struct error_log *error_log_create(const char *path, struct err *err)
{
    int fd = open(path, O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0666);
    if (fd < 0) {
        err_set(err, ERR_IO, NULL, "cannot write '%s': %s", path, strerror(errno));
        return NULL;
    }
    struct error_log *log = mem_alloc(1, sizeof *log);
    log->fd = fd;
    log->path = text_copy(path);
    if (write_header(log, err))
        return log;
    error_log_destroy(log);
    return NULL;
}

bool error_log_append(struct error_log *log, const struct error_row *row, struct err *err)
{
    struct text line = {0};
    error_log_append_row(&line, row);
    bool ok = write_line(log, &line, err);
    mem_free(line.data);
    return ok;
}

void error_log_destroy(struct error_log *log)
{
    if (log == NULL)
        return;
    fsync(log->fd); /* not after each row, which would cost time; not every device
                       supports it */
    close(log->fd);
    mem_free(log->path);
    mem_free(log);
}

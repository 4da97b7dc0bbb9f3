#include "cli/output.h"

#include "base/mem.h"
#include "base/text.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool folder_exists(const char *path)
{
    struct stat info;
    const char *slash = strrchr(path, '/');
    char *folder = slash ? text_copy_n(path, (size_t)(slash - path) + 1) : text_copy(".");
    bool exists = stat(folder, &info) == 0;
    mem_free(folder);
    return exists;
}

/* Files are written under a temporary name in the same folder, which must be writable. */
static bool check_beside(const char *path, struct err *err)
{
    char *trial = text_format("%s.part%ld", path, (long)getpid());
    int fd = open(trial, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (fd < 0) {
        const char *why = strerror(errno);
        err_set(err, ERR_IO, NULL, "cannot write '%s': %s", path,
                folder_exists(path) ? why : "there is no such folder");
    } else {
        close(fd);
        unlink(trial);
    }
    mem_free(trial);
    return fd >= 0;
}

bool output_check(const char *path, struct err *err)
{
    struct stat info;
    if (path == NULL)
        return true;
    if (stat(path, &info) != 0 || S_ISREG(info.st_mode))
        return check_beside(path, err);
    if (S_ISDIR(info.st_mode))
        return err_set(err, ERR_IO, NULL, "cannot write '%s': it is a directory", path);
    if (access(path, W_OK) != 0)
        return err_set(err, ERR_IO, NULL, "cannot write '%s': %s", path, strerror(errno));
    return true;
}

static bool is_same_file(const struct output_file *a, const struct output_file *b)
{
    return a->path && b->path && text_same_file(a->path, b->path);
}

bool output_apart(const struct output_file *written, const struct output_file *read,
                  struct err *err)
{
    for (const struct output_file *w = written; w->what; w++) {
        for (const struct output_file *other = written; other < w; other++)
            if (is_same_file(w, other))
                return err_set(err, ERR_USAGE, NULL,
                               "%s and %s are one file, '%s': give each its own",
                               other->what, w->what, w->path);
        for (const struct output_file *r = read; r->what; r++)
            if (is_same_file(w, r))
                return err_set(err, ERR_USAGE, NULL,
                               "%s '%s' would overwrite %s: give another name", w->what,
                               w->path, r->what);
    }
    return true;
}

char *output_with_ending(const char *path, const char *ending)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
    size_t length = dot && (slash == NULL || dot > slash) ? (size_t)(dot - path)
                                                          : strlen(path);
    return text_format("%.*s%s", (int)length, path, ending);
}

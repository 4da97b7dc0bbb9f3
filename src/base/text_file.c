#include "base/mem.h"
#include "base/text.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

static bool read_fd(int fd, struct text *text)
{
    for (;;) {
        text->data = mem_grow(text->data, &text->capacity, text->length + 65536, 1);
        ssize_t n = read(fd, text->data + text->length,
                         text->capacity - text->length - 1);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            return false;
        if (n == 0)
            break;
        text->length += (size_t)n;
    }
    text->data[text->length] = '\0';
    return true;
}

int text_open_file(const char *path, size_t *size, const struct place *at,
                   struct err *err)
{
    struct stat info;
    /* Opening a FIFO would otherwise wait for a writer. */
    int fd = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (fd < 0) {
        err_set(err, ERR_IO, at, "cannot open '%s': %s", path, strerror(errno));
        return -1;
    }
    if (fstat(fd, &info) != 0 || !S_ISREG(info.st_mode)) {
        err_set(err, ERR_IO, at, "cannot read '%s': not a regular file%s", path,
                S_ISDIR(info.st_mode) ? " but a directory" : "");
        close(fd);
        return -1;
    }
    *size = (size_t)info.st_size;
    return fd;
}

char *text_read_file(const char *path, size_t *size, const struct place *at,
                     struct err *err)
{
    struct text text = {0};
    size_t expected;
    int fd = text_open_file(path, &expected, at, err);
    if (fd < 0)
        return NULL;
    /* One allocation for the usual file; growing serves one that changes meanwhile. */
    text.data = mem_grow(text.data, &text.capacity, expected + 65537, 1);
    bool read = read_fd(fd, &text) ||
                err_set(err, ERR_IO, at, "cannot read '%s': %s", path, strerror(errno));
    close(fd);
    if (!read) {
        mem_free(text.data);
        return NULL;
    }
    *size = text.length;
    return text.data;
}

const char *text_skip_mark(const char *text)
{
    static const char mark[] = "\xef\xbb\xbf";
    return strncmp(text, mark, 3) == 0 ? text + 3 : text;
}

static bool write_fd(int fd, const char *data, size_t size)
{
    while (size > 0) {
        ssize_t n = write(fd, data, size);
        if (n < 0 && errno == EINTR)
            continue;
        if (n < 0)
            return false;
        data += n;
        size -= (size_t)n;
    }
    return true;
}

/* Syncs to the disk if the file system supports it. */
static bool sync_fd(int fd)
{
    return fsync(fd) == 0 || errno == EINVAL || errno == EROFS || errno == ENOTSUP;
}

/* The new name is durable once the folder is synced. */
static bool sync_folder_of(const char *path)
{
    char *folder = text_directory(path);
    int fd = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    mem_free(folder);
    bool ok = fd < 0 || sync_fd(fd); /* a folder may be written to, but not read */
    if (fd >= 0)
        close(fd);
    return ok;
}

bool text_commit_file(int fd, const char *temporary, const char *path)
{
    bool synced = sync_fd(fd);
    int cause = errno;
    bool closed = close(fd) == 0;
    if (!synced)
        errno = cause;
    return synced && closed && rename(temporary, path) == 0 && sync_folder_of(path);
}

/* Leaves errno on failure. */
static bool write_direct(const char *path, const char *data, size_t size)
{
    int fd = open(path, O_WRONLY | O_CLOEXEC);
    if (fd < 0)
        return false;
    bool written = write_fd(fd, data, size);
    int cause = errno;
    bool closed = close(fd) == 0;
    if (!written)
        errno = cause;
    return written && closed;
}

static bool write_whole(const char *path, const char *data, size_t size)
{
    char *temporary = text_format("%s.part%ld", path, (long)getpid());
    int fd = open(temporary, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    bool written = fd >= 0 && write_fd(fd, data, size);
    bool ok = written && text_commit_file(fd, temporary, path);
    int cause = errno;
    if (fd >= 0 && !written)
        close(fd);
    if (fd >= 0 && !ok)
        unlink(temporary);
    mem_free(temporary);
    errno = cause;
    return ok;
}

bool text_write_file(const char *path, const char *data, size_t size, struct err *err)
{
    struct stat info;
    /* A device or pipe (/dev/null) is written to: renaming would replace it. */
    bool direct = stat(path, &info) == 0 && !S_ISREG(info.st_mode);
    bool ok = direct ? write_direct(path, data, size) : write_whole(path, data, size);
    return ok ||
           err_set(err, ERR_IO, NULL, "cannot write '%s': %s", path, strerror(errno));
}

/* The real path of a file that exists or is to be made; NULL if its folder does not
 * exist. */
static char *resolve(const char *path)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    char *folder = slash ? text_copy_n(path, (size_t)(name - path)) : text_copy(".");
    char *real = realpath(folder, NULL);
    char *whole = real ? text_join(real, name) : NULL;
    free(real);
    mem_free(folder);
    return whole;
}

bool text_same_file(const char *a, const char *b)
{
    struct stat of_a, of_b;
    bool has_a = stat(a, &of_a) == 0, has_b = stat(b, &of_b) == 0;
    if (has_a && has_b)
        return S_ISREG(of_a.st_mode) && of_a.st_dev == of_b.st_dev &&
               of_a.st_ino == of_b.st_ino;
    if (has_a || has_b)
        return false;
    char *real_a = resolve(a), *real_b = resolve(b);
    bool same = real_a && real_b && text_equal(real_a, real_b);
    mem_free(real_a);
    mem_free(real_b);
    return same;
}

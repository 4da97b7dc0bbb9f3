#include "lab/folder.h"

#include "base/mem.h"
#include "base/text.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool folder_make(const char *path, struct err *err)
{
    struct stat info;
    char *parent = text_directory(path);
    bool ok = text_equal(parent, path) || text_equal(parent, ".") ||
              stat(parent, &info) == 0 || folder_make(parent, err);
    mem_free(parent);
    if (!ok || mkdir(path, 0777) == 0 ||
        (errno == EEXIST && stat(path, &info) == 0 && S_ISDIR(info.st_mode)))
        return ok;
    return err_set(err, ERR_IO, NULL, "cannot make the folder '%s': %s", path,
                   strerror(errno));
}

int folder_lock(const char *path, bool wait, bool *busy, struct err *err)
{
    struct flock lock = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    char *file = text_format("%s/lock", path);
    int fd = open(file, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    bool held = fd >= 0 && fcntl(fd, wait ? F_SETLKW : F_SETLK, &lock) == 0;
    *busy = fd >= 0 && !held && (errno == EACCES || errno == EAGAIN);
    if (!held && !*busy)
        err_set(err, ERR_IO, NULL, "cannot %s '%s': %s", fd < 0 ? "write" : "lock", file,
                strerror(errno));
    if (!held && fd >= 0)
        close(fd);
    mem_free(file);
    return held ? fd : -1;
}

void folder_remove_parts(const char *path)
{
    DIR *directory = opendir(path);
    for (struct dirent *entry; directory && (entry = readdir(directory));) {
        const char *part = strstr(entry->d_name, ".part");
        if (part == NULL || part[5 + strspn(part + 5, "0123456789")] != '\0')
            continue;
        char *file = text_format("%s/%s", path, entry->d_name);
        unlink(file);
        mem_free(file);
    }
    if (directory)
        closedir(directory);
}

#include "live/site.h"

#include "base/clock.h"
#include "base/mem.h"
#include "live/http.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

struct site {
    struct http *http; /* NULL: a folder */
    char *folder, *address;
};

static bool all_digits(const char *text)
{
    return *text && strspn(text, "0123456789") == strlen(text);
}

/* A folder with a colon and a number at its end is written "./a:1". */
static bool is_port(const char *where)
{
    const char *colon = strrchr(where, ':');
    return all_digits(where) ||
           (colon && colon > where && !strchr(where, '/') && all_digits(colon + 1));
}

static bool check_name(const char *where, struct err *err)
{
    return !strchr(where, ':') || strchr(where, '/') ||
           err_set(err, ERR_USAGE, NULL,
                   "--live '%s': this is neither PORT nor HOST:PORT; a folder of that "
                   "name is './%s'",
                   where, where);
}

static bool make_folder(const char *folder, struct err *err)
{
    struct stat info;
    if (mkdir(folder, 0777) != 0 && errno != EEXIST)
        return err_set(err, ERR_IO, NULL, "--live '%s': cannot make this folder: %s",
                       folder, strerror(errno));
    if (stat(folder, &info) == 0 && !S_ISDIR(info.st_mode))
        return err_set(err, ERR_IO, NULL, "--live '%s': this is no folder", folder);
    if (access(folder, W_OK | X_OK) == 0)
        return true;
    return err_set(err, ERR_IO, NULL, "--live '%s': cannot write to this folder: %s",
                   folder, strerror(errno));
}

struct site *site_open(const char *where, struct err *err)
{
    struct site site = {0};
    if (is_port(where)) {
        site.http = http_open(where, err);
        if (site.http == NULL)
            return NULL;
        site.address = text_copy(http_url(site.http));
    } else {
        if (!check_name(where, err) || !make_folder(where, err))
            return NULL;
        site.folder = text_copy(where);
        site.address = text_format("%s/index.html", where);
    }
    struct site *heap = mem_alloc(1, sizeof *heap);
    *heap = site;
    return heap;
}

const char *site_address(const struct site *site)
{
    return site->address;
}

bool site_publish(struct site *site, const char *name, const char *type,
                  struct text *text, struct err *err)
{
    if (site->http) {
        http_publish(site->http, name, type, text);
        return true;
    }
    char *path = text_format("%s/%s", site->folder, name);
    bool ok = text_write_file(path, text->data, text->length, err);
    mem_free(path);
    mem_free(text->data);
    *text = (struct text){0};
    return ok;
}

bool site_watched(struct site *site, const char *name, double seconds)
{
    return site->http == NULL || http_asked(site->http, name) <= seconds;
}

void site_linger(struct site *site, const char *const *names, double seconds)
{
    struct timespec moment = {.tv_nsec = 20000000};
    double begin = clock_wall();
    while (site->http && *names && clock_wall() < begin + seconds) {
        nanosleep(&moment, NULL); /* also for what is being sent */
        names += http_sent(site->http, *names);
    }
}

double site_cpu(struct site *site)
{
    return site->http ? http_cpu(site->http) : 0.0;
}

void site_close(struct site *site)
{
    if (site == NULL)
        return;
    http_close(site->http);
    mem_free(site->folder);
    mem_free(site->address);
    mem_free(site);
}

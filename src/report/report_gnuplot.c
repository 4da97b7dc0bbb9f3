#include "report/report_gnuplot.h"

#include "base/mem.h"

#include <errno.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

/* --- the process ----------------------------------------------------------------- */

/* Unnamed files, so that nothing is left behind and neither side waits for the other. */
struct streams {
    FILE *in, *out, *complaints;
};

static bool streams_open(struct streams *s, struct err *err)
{
    s->in = tmpfile();
    s->out = tmpfile();
    s->complaints = tmpfile();
    return (s->in && s->out && s->complaints) ||
           err_set(err, ERR_IO, NULL, "cannot make a temporary file: %s",
                   strerror(errno));
}

static void streams_close(const struct streams *s)
{
    FILE *const all[] = {s->in, s->out, s->complaints};
    for (int i = 0; i < 3; i++)
        if (all[i])
            fclose(all[i]);
}

static char *contents(FILE *file)
{
    struct text text = {0};
    char block[4096];
    size_t n;
    rewind(file);
    text_append(&text, "%s", "");
    while ((n = fread(block, 1, sizeof block, file)) > 0)
        text_append(&text, "%.*s", (int)n, block);
    return text.data;
}

static int start(const struct streams *s, pid_t *child)
{
    char name[] = "gnuplot", from_input[] = "-";
    char *const argv[] = {name, from_input, NULL};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, fileno(s->in), STDIN_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(s->out), STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, fileno(s->complaints), STDERR_FILENO);
    /* Threads that draw may block signals; the child shall not. */
    posix_spawnattr_t attributes;
    sigset_t none;
    sigemptyset(&none);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
    posix_spawnattr_setsigmask(&attributes, &none);
    int status = posix_spawnp(child, name, &actions, &attributes, argv, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return status;
}

static bool fail_with_first_line(const struct streams *s, struct err *err)
{
    char *said = contents(s->complaints);
    char *line = said + strspn(said, " \t\r\n");
    line[strcspn(line, "\r\n")] = '\0';
    err_set(err, ERR_IO, NULL, "gnuplot failed%s%s", *line ? ": " : "", line);
    mem_free(said);
    return false;
}

/* Runs gnuplot and returns its standard output; NULL on failure. */
static char *run(const struct streams *s, struct err *err)
{
    pid_t child, ended;
    int status;
    rewind(s->in);
    int cause = start(s, &child);
    if (cause != 0) {
        err_set(err, ERR_IO, NULL, "cannot run gnuplot: %s%s", strerror(cause),
                cause == ENOENT ? "; install it (gnuplot-nox)" : "");
        return NULL;
    }
    do
        ended = waitpid(child, &status, 0);
    while (ended < 0 && errno == EINTR);
    if (ended == child && WIFEXITED(status) && WEXITSTATUS(status) == 0)
        return contents(s->out);
    fail_with_first_line(s, err);
    return NULL;
}

/* --- what it draws ---------------------------------------------------------------- */

struct filter {
    struct text *to;
    const struct report_plot *plot;
    size_t number; /* of the plot in the page */
};

static bool skip_prefix(const char **at, const char *prefix)
{
    size_t length = strlen(prefix);
    if (strncmp(*at, prefix, length) != 0)
        return false;
    *at += length;
    return true;
}

/* rgb(n,n,n), with blanks, n small. */
static bool colour(struct filter *f, const char **at)
{
    int r, g, b, length = 0;
    if (sscanf(*at, "rgb(%d,%d,%d)%n", &r, &g, &b, &length) < 3 || length == 0 ||
        r != g || r != b)
        return false;
    text_append(f->to, "var(--plot-%d)", r);
    *at += length;
    return true;
}

/* An element's group, and the name that browsers would show beside the pointer. */
static bool element(struct filter *f, const char **at)
{
    int number, length = 0;
    if (sscanf(*at, "id=\"gnuplot_plot_%d\" >%n", &number, &length) < 1 || length == 0)
        return false;
    *at += length;
    bool known = number >= 1 && number <= f->plot->elements;
    text_append(f->to, "data-series=\"%d\">", known ? f->plot->series[number - 1] : -1);
    const char *end = strstr(*at, "</title>");
    if (strncmp(*at, "<title>", 7) == 0 && end)
        *at = end + strlen("</title>");
    return true;
}

/* Names of shapes that plots share, defined in each. */
static bool name(struct filter *f, const char **at)
{
    static const char *const names[] = {"gpPt", "gpDot", "textbox", "greybox",
                                        "gnuplot_canvas"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++)
        if (skip_prefix(at, names[i])) {
            text_append(f->to, "plot%zu-%s", f->number, names[i]);
            return true;
        }
    return false;
}

static bool replaced(struct filter *f, const char **at)
{
    static const char *const pairs[][2] = {
        {"color=\"black\"", "color=\"var(--plot-1)\""},
        {"color=\"gray\"", "color=\"var(--plot-3)\""},
        {"'white'", "'var(--plot-0)'"},
        {"'black'", "'var(--plot-1)'"},
        {"fill=\"black\"", "fill=\"var(--plot-1)\""},
    };
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++)
        if (skip_prefix(at, pairs[i][0])) {
            text_append(f->to, "%s", pairs[i][1]);
            return true;
        }
    return false;
}

/* Copies the document without its head, which is only for separate files. */
static char *filtered(const struct report_plot *plot, size_t number, const char *from,
                      const char *end)
{
    struct text to = {0};
    struct filter f = {&to, plot, number};
    const char *at = strstr(from, "<g id=\"gnuplot_canvas\">");
    const char *definitions = strstr(from, "<defs>");
    if (at == NULL || at >= end || definitions == NULL)
        return NULL;
    text_append(&to,
                "<svg viewBox=\"0 0 %d %d\" role=\"img\" "
                "aria-labelledby=\"plot%zu-title\">",
                plot->width, plot->height, number);
    while (at < end)
        if (!colour(&f, &at) && !element(&f, &at) && !name(&f, &at) && !replaced(&f, &at))
            text_append(&to, "%c", *at++);
    text_append(&to, "</svg>");
    return to.data;
}

static bool split(struct report_plot *plots, size_t count, const char *drawn,
                  struct err *err)
{
    for (size_t i = 0; i < count; i++) {
        const char *begin = strstr(drawn, "<svg"), *end = strstr(drawn, "</svg>");
        plots[i].svg = begin && end && begin < end ? filtered(&plots[i], i, begin, end)
                                                   : NULL;
        if (plots[i].svg == NULL)
            return err_set(err, ERR_IO, NULL, "gnuplot drew %zu of %zu plots", i, count);
        drawn = end + strlen("</svg>");
    }
    return true;
}

static void send(FILE *to, const struct report_plot *plot)
{
    fprintf(to,
            "reset\nset terminal svg size %d,%d font 'sans-serif,14' noenhanced\n%s\n",
            plot->width, plot->height, plot->script.data);
}

bool report_gnuplot(struct report_plot *plots, size_t count, struct err *err)
{
    struct streams s = {0};
    if (count == 0)
        return true;
    bool ok = streams_open(&s, err);
    for (size_t i = 0; ok && i < count; i++)
        send(s.in, &plots[i]);
    if (ok && (fflush(s.in) != 0 || ferror(s.in)))
        ok = err_set(err, ERR_IO, NULL, "cannot write a temporary file: %s",
                     strerror(errno));
    char *drawn = ok ? run(&s, err) : NULL;
    ok = drawn && split(plots, count, drawn, err);
    mem_free(drawn);
    streams_close(&s);
    return ok;
}

/* Runs a program and looks at its memory now and then.
 *
 *   heap_watch HEAP_COUNT.so SAMPLES.csv SECONDS COMMAND ...
 *
 * A row every SECONDS: wall time since the start; CPU time of the program, all threads;
 * resident bytes, of them anonymous ones; mapped private bytes (VmData); live bytes and
 * blocks of the heap, calls of malloc and its kin since the row before (heap_count.c);
 * page faults since then (minor, major); CPU seconds that a fixed piece of work of our
 * own takes: on a machine that others use as well, its speed. The status is the
 * program's. */

#include "heap_count.h"

#include "base/clock.h"

#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

struct sample {
    double cpu;                           /* s */
    long long resident, anonymous, data;  /* bytes */
    long long minor_faults, major_faults; /* since the beginning */
    long long calls;
};

static _Noreturn void die(const char *what)
{
    perror(what);
    exit(1);
}

static struct heap_count *map_counts(const char *path)
{
    struct heap_count none = {0};
    int fd = open(path, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (fd < 0 || write(fd, &none, sizeof none) != (ssize_t)sizeof none)
        die(path);
    void *at = mmap(NULL, sizeof none, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    if (at == MAP_FAILED)
        die(path);
    close(fd);
    return at;
}

static pid_t start(const char *library, const char *counts, char **command)
{
    pid_t child = fork();
    if (child < 0)
        die("fork");
    if (child > 0)
        return child;
    setenv("LD_PRELOAD", library, 1);
    setenv("HEAP_COUNT", counts, 1);
    execvp(command[0], command);
    die(command[0]);
}

/* Whole pages of text: files of /proc have no size. False once the process is gone. */
static bool read_proc(pid_t pid, const char *name, char *text, size_t size)
{
    char path[64];
    snprintf(path, sizeof path, "/proc/%d/%s", (int)pid, name);
    FILE *file = fopen(path, "r");
    if (file == NULL)
        return false;
    size_t n = fread(text, 1, size - 1, file);
    fclose(file);
    text[n] = '\0';
    return n > 0;
}

/* kB of a line of /proc/PID/status, as bytes. */
static long long bytes_of(const char *status, const char *key)
{
    const char *at = strstr(status, key);
    return at ? 1024 * atoll(at + strlen(key)) : 0;
}

static bool look(pid_t pid, struct sample *s)
{
    char text[8192];
    unsigned long user, system;
    if (!read_proc(pid, "status", text, sizeof text))
        return false;
    s->resident = bytes_of(text, "\nVmRSS:");
    s->anonymous = bytes_of(text, "\nRssAnon:");
    s->data = bytes_of(text, "\nVmData:");
    if (s->resident == 0 || !read_proc(pid, "stat", text, sizeof text))
        return false;
    /* Behind the name in brackets, which may hold blanks: fields 3 on of proc(5). */
    int n = sscanf(strrchr(text, ')') + 1,
                   " %*c %*d %*d %*d %*d %*d %*u %lld %*d %lld %*d %lu %lu",
                   &s->minor_faults, &s->major_faults, &user, &system);
    s->cpu = (double)(user + system) / (double)sysconf(_SC_CLK_TCK);
    return n == 4;
}

static void write_row(FILE *out, double wall, const struct sample *now,
                      const struct sample *before, const struct heap_count *count)
{
    fprintf(out, "%.3f,%.2f,%lld,%lld,%lld,%lld,%lld,%lld,%lld,%lld\n", wall, now->cpu,
            now->resident, now->anonymous, now->data, (long long)count->bytes,
            (long long)count->blocks, now->calls - before->calls,
            now->minor_faults - before->minor_faults,
            now->major_faults - before->major_faults);
    fflush(out);
}

static int watch(pid_t child, FILE *out, double every, const struct heap_count *count)
{
    struct sample now = {0}, before = {0};
    double begin = clock_wall();
    int status;
    for (long i = 1; waitpid(child, &status, WNOHANG) == 0; i++) {
        double left = begin + (double)i * every - clock_wall();
        if (left > 0.0)
            nanosleep(&(struct timespec){(time_t)left,
                                         (long)(1e9 * (left - (double)(time_t)left))},
                      NULL);
        now.calls = count->calls;
        if (look(child, &now))
            write_row(out, clock_wall() - begin, &now, &before, count);
        before = now;
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

int main(int argc, char **argv)
{
    char counts[4096];
    if (argc < 5) {
        fprintf(stderr, "heap_watch HEAP_COUNT.so SAMPLES.csv SECONDS COMMAND ...\n");
        return 2;
    }
    snprintf(counts, sizeof counts, "%s.counts", argv[2]);
    struct heap_count *count = map_counts(counts);
    FILE *out = fopen(argv[2], "w");
    if (out == NULL)
        die(argv[2]);
    fprintf(out, "wall_s,cpu_s,resident,anonymous,data,live_bytes,live_blocks,calls,"
                 "minor_faults,major_faults\n");
    signal(SIGINT, SIG_IGN); /* the program's business */
    int status = watch(start(argv[1], counts, argv + 4), out, strtod(argv[3], NULL),
                       count);
    fclose(out);
    unlink(counts);
    return status;
}

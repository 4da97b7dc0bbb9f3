#include "base/machine.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>

/* The number behind `key` at the start of a line of a file of the system; NAN if there is
 * none ("max" is none). An empty key: the first line. */
static double number_of(const char *path, const char *key)
{
    char line[256];
    double value = (double)NAN, found;
    size_t length = strlen(key);
    FILE *file = fopen(path, "re");
    while (file && isnan(value) && fgets(line, sizeof line, file)) {
        bool there = strncmp(line, key, length) == 0;
        if (there && sscanf(line + length, "%32lf", &found) == 1)
            value = found;
        if (length == 0)
            break;
    }
    if (file)
        fclose(file);
    return value;
}

static double kilobytes_of(const char *path, const char *key)
{
    return 1024.0 * number_of(path, key);
}

/* Memory left to a control group; its inactive file pages count as free. NAN without a
 * limit. */
static double left_to_group(const char *folder)
{
    char path[768];
    snprintf(path, sizeof path, "%s/memory.max", folder);
    double most = number_of(path, "");
    snprintf(path, sizeof path, "%s/memory.current", folder);
    double used = number_of(path, "");
    snprintf(path, sizeof path, "%s/memory.stat", folder);
    double idle = number_of(path, "inactive_file ");
    return most - used + (isnan(idle) ? 0.0 : idle);
}

/* The least over this process's control group and all groups above it; INFINITY without a
 * limit. */
static double left_to_groups(void)
{
    char line[512], folder[640];
    double left = (double)INFINITY;
    FILE *file = fopen("/proc/self/cgroup", "re");
    while (file && fgets(line, sizeof line, file)) {
        if (strncmp(line, "0::/", 4) != 0)
            continue;
        line[strcspn(line, "\n")] = '\0';
        snprintf(folder, sizeof folder, "/sys/fs/cgroup%s", line + 3);
        for (char *slash; (slash = strrchr(folder + strlen("/sys/fs"), '/')) != NULL;) {
            left = fmin(left, left_to_group(folder)); /* fmin ignores a NaN */
            *slash = '\0';
        }
    }
    if (file)
        fclose(file);
    return left;
}

static double left_to_addresses(void)
{
    struct rlimit limit;
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
        return (double)INFINITY;
    return (double)limit.rlim_cur - kilobytes_of("/proc/self/status", "VmSize:");
}

double machine_memory_available(void)
{
    double left = fmin(kilobytes_of("/proc/meminfo", "MemAvailable:"), left_to_groups());
    return fmax(fmin(left, left_to_addresses()), 0.0);
}

double machine_memory_peak(void)
{
    double peak = kilobytes_of("/proc/self/status", "VmHWM:");
    struct rusage usage = {0};
    if (isnan(peak) && getrusage(RUSAGE_SELF, &usage) == 0)
        peak = 1024.0 * (double)usage.ru_maxrss;
    return isnan(peak) ? 0.0 : peak;
}

double machine_memory_now(void)
{
    double now = kilobytes_of("/proc/self/status", "VmRSS:");
    return isnan(now) ? machine_memory_peak() : now;
}

#include "base/machine.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

/* "model name : NAME"; other architectures than x86 may call it "Processor" or so. */
static const char *value_of(const char *line)
{
    static const char *const keys[] = {"model name", "Processor", "cpu model", "cpu"};
    const char *colon = strchr(line, ':');
    for (size_t i = 0; colon && i < sizeof keys / sizeof keys[0]; i++) {
        size_t length = strlen(keys[i]);
        if (strncmp(line, keys[i], length) == 0 &&
            strspn(line + length, " \t") == (size_t)(colon - line) - length)
            return colon + 1 + strspn(colon + 1, " \t");
    }
    return NULL;
}

void machine_cpu_model(char *name, size_t size)
{
    char line[512];
    FILE *file = fopen("/proc/cpuinfo", "re");
    const char *value = NULL;
    while (file && value == NULL && fgets(line, sizeof line, file))
        value = value_of(line);
    if (file)
        fclose(file);
    snprintf(name, size, "%s", value && *value != '\n' ? value : "unknown");
    for (size_t end = strlen(name); end > 0 && isspace((unsigned char)name[end - 1]);)
        name[--end] = '\0';
}

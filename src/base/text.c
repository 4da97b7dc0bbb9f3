#include "base/text.h"

#include "base/mem.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

char *text_copy(const char *s)
{
    return text_copy_n(s, strlen(s));
}

char *text_copy_n(const char *s, size_t n)
{
    char *copy = mem_alloc(n + 1, 1);
    memcpy(copy, s, n);
    return copy;
}

static size_t formatted_length(const char *format, va_list args)
    __attribute__((format(printf, 1, 0)));
static size_t formatted_length(const char *format, va_list args)
{
    int n = vsnprintf(NULL, 0, format, args);
    return n > 0 ? (size_t)n : 0;
}

char *text_format(const char *format, ...)
{
    va_list args;
    va_start(args, format);
    size_t n = formatted_length(format, args);
    va_end(args);
    char *s = mem_alloc(n + 1, 1);
    va_start(args, format);
    vsnprintf(s, n + 1, format, args);
    va_end(args);
    return s;
}

void text_append(struct text *text, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    size_t n = formatted_length(format, args);
    va_end(args);
    text->data = mem_grow(text->data, &text->capacity, text->length + n + 1, 1);
    va_start(args, format);
    vsnprintf(text->data + text->length, n + 1, format, args);
    va_end(args);
    text->length += n;
}

bool text_equal(const char *a, const char *b)
{
    return strcmp(a, b) == 0;
}

bool text_ends_with(const char *s, const char *ending)
{
    size_t n = strlen(s), m = strlen(ending);
    return n >= m && strcasecmp(s + n - m, ending) == 0;
}

static bool starts_a_number(const char *s)
{
    return *s != '\0' && !isspace((unsigned char)*s);
}

bool text_to_double(const char *s, double *value)
{
    if (!starts_a_number(s))
        return false;
    char *end;
    double x = strtod(s, &end);
    if (*end != '\0' || !isfinite(x))
        return false;
    *value = x;
    return true;
}

bool text_to_long(const char *s, long *value)
{
    if (!starts_a_number(s))
        return false;
    char *end;
    errno = 0;
    long x = strtol(s, &end, 10);
    if (*end != '\0' || errno == ERANGE)
        return false;
    *value = x;
    return true;
}

char *text_directory(const char *path)
{
    const char *slash = strrchr(path, '/');
    if (!slash)
        return text_copy(".");
    return text_copy_n(path, slash == path ? 1 : (size_t)(slash - path));
}

char *text_join(const char *directory, const char *path)
{
    if (path[0] == '/' || text_equal(directory, "."))
        return text_copy(path);
    const char *between = text_ends_with(directory, "/") ? "" : "/";
    return text_format("%s%s%s", directory, between, path);
}

#define NEAREST_LENGTH 64

static char lower(char c)
{
    return (char)tolower((unsigned char)c);
}

static int min_int(int a, int b)
{
    return a < b ? a : b;
}

/* Optimal string alignment: insertions, deletions, substitutions and swaps of neighbours,
 * ASCII case ignored. Both strings are below NEAREST_LENGTH. */
static int edit_distance(const char *a, const char *b)
{
    int rows[3][NEAREST_LENGTH + 1];
    int *before = rows[0], *above = rows[1], *row = rows[2];
    int n = (int)strlen(a), m = (int)strlen(b);
    for (int j = 0; j <= m; j++)
        above[j] = before[j] = j;
    for (int i = 1; i <= n; i++) {
        row[0] = i;
        for (int j = 1; j <= m; j++) {
            bool same = lower(a[i - 1]) == lower(b[j - 1]);
            row[j] = min_int(above[j - 1] + !same, 1 + min_int(above[j], row[j - 1]));
            if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
                lower(a[i - 2]) == lower(b[j - 1]))
                row[j] = min_int(row[j], before[j - 2] + 1);
        }
        int *oldest = before;
        before = above;
        above = row;
        row = oldest;
    }
    return above[m];
}

const char *text_nearest(const char *s, const char *const *candidates)
{
    const char *nearest = NULL;
    size_t length = strlen(s);
    if (length >= NEAREST_LENGTH)
        return NULL;
    int limit = length < 3 ? 1 : (int)length / 3 + 1;
    for (; *candidates; candidates++) {
        if (strlen(*candidates) >= NEAREST_LENGTH)
            continue;
        int distance = edit_distance(s, *candidates);
        if (distance <= limit && (size_t)distance < length) {
            nearest = *candidates;
            limit = distance - 1;
        }
    }
    return nearest;
}

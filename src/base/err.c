#include "base/err.h"

#include <stdarg.h>
#include <stdio.h>

/* What files hold must neither break the line nor command a terminal. */
static void make_printable(char *text)
{
    for (; *text; text++)
        if ((unsigned char)*text < ' ' || *text == '\x7f')
            *text = '?';
}

bool err_set(struct err *err, enum err_code code, const struct place *at,
             const char *format, ...)
{
    if (!err || err->code != ERR_NONE)
        return false;
    err->code = code;
    err->line = at ? at->line : 0;
    err->col = at ? at->col : 0;
    snprintf(err->file, sizeof err->file, "%s", at && at->file ? at->file : "");
    va_list args;
    va_start(args, format);
    vsnprintf(err->message, sizeof err->message, format, args);
    va_end(args);
    make_printable(err->file);
    make_printable(err->message);
    return false;
}

void err_format(const struct err *err, char *text, int size)
{
    char position[32] = "";
    if (err->line > 0 && err->col > 0)
        snprintf(position, sizeof position, ":%d:%d", err->line, err->col);
    else if (err->line > 0)
        snprintf(position, sizeof position, ":%d", err->line);
    if (err->file[0])
        snprintf(text, (size_t)size, "%s%s: %s", err->file, position, err->message);
    else
        snprintf(text, (size_t)size, "%s", err->message);
}

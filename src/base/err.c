#include "base/err.h"

#include <stdarg.h>
#include <stdio.h>

/* Bytes of the UTF-8 character that begins here; 0 for an invalid one or a control
 * character, including U+0080 to U+009F, which terminals obey too. Overlong forms and
 * surrogates pass: they are harmless. */
static int printable(const unsigned char *c)
{
    int more = *c >= 0xf0 ? 3 : *c >= 0xe0 ? 2 : *c >= 0xc2 ? 1 : 0;
    if (*c < 0x80)
        return *c >= ' ' && *c != 0x7f;
    if (more == 0 || *c > 0xf4 || (*c == 0xc2 && c[1] < 0xa0))
        return 0;
    for (int i = 1; i <= more; i++)
        if ((c[i] & 0xc0) != 0x80)
            return 0;
    return more + 1;
}

/* Text from files must neither break the line nor control the terminal. */
static void make_printable(char *text)
{
    for (int length; *text; text += length ? length : 1) {
        length = printable((const unsigned char *)text);
        if (length == 0)
            *text = '?';
    }
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

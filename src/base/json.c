#include "base/json.h"

#include <math.h>

static void indent(struct json *json)
{
    text_append(&json->text, "\n%*s", 2 * json->depth, "");
}

/* Bytes of the UTF-8 character at s; 0 if it is none. */
static int character(const unsigned char *s)
{
    static const unsigned lowest[] = {0, 0, 0x80, 0x800, 0x10000};
    int bytes = s[0] < 0x80 ? 1 : s[0] >> 5 == 6 ? 2 : s[0] >> 4 == 14 ? 3 : 4;
    if (bytes == 1)
        return 1;
    if (bytes == 4 && s[0] >> 3 != 30)
        return 0;
    unsigned code = s[0] & (0x7fu >> bytes);
    for (int i = 1; i < bytes; i++) {
        if (s[i] >> 6 != 2) /* the final zero too */
            return 0;
        code = code << 6 | (s[i] & 0x3fu);
    }
    bool surrogate = code >= 0xd800 && code < 0xe000;
    return code >= lowest[bytes] && code < 0x110000 && !surrogate ? bytes : 0;
}

static void quote(struct text *to, const char *value)
{
    const unsigned char *s = (const unsigned char *)value;
    text_append(to, "\"");
    while (*s) {
        int bytes = character(s);
        if (*s == '"' || *s == '\\')
            text_append(to, "\\%c", *s);
        else if (*s < 0x20 || *s == 0x7f)
            text_append(to, "\\u%04x", *s);
        else if (bytes == 0)
            text_append(to, "\\ufffd");
        else
            text_append(to, "%.*s", bytes, (const char *)s);
        s += bytes > 0 ? bytes : 1;
    }
    text_append(to, "\"");
}

static void begin(struct json *json, const char *key)
{
    if (json->follows)
        text_append(&json->text, ",");
    if (json->depth > 0)
        indent(json);
    if (key) {
        quote(&json->text, key);
        text_append(&json->text, ": ");
    }
    json->follows = true;
}

void json_open(struct json *json, const char *key, char bracket)
{
    begin(json, key);
    text_append(&json->text, "%c", bracket);
    json->depth++;
    json->follows = false;
}

void json_close(struct json *json, char bracket)
{
    bool empty = !json->follows;
    json->depth--;
    if (!empty)
        indent(json);
    text_append(&json->text, "%c%s", bracket == '{' ? '}' : ']',
                json->depth == 0 ? "\n" : "");
    json->follows = true;
}

void json_text(struct json *json, const char *key, const char *value)
{
    begin(json, key);
    if (value)
        quote(&json->text, value);
    else
        text_append(&json->text, "null");
}

void json_number(struct json *json, const char *key, double value)
{
    begin(json, key);
    if (isfinite(value))
        text_append(&json->text, "%.9g", value);
    else
        text_append(&json->text, "null");
}

void json_count(struct json *json, const char *key, long value)
{
    begin(json, key);
    text_append(&json->text, "%ld", value);
}

void json_flag(struct json *json, const char *key, bool value)
{
    begin(json, key);
    text_append(&json->text, "%s", value ? "true" : "false");
}

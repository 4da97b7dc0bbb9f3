#include "lab/scalar.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

static void shortest(char *digits, size_t size, double value)
{
    for (int precision = 15; precision <= 17; precision++) {
        snprintf(digits, size, "%.*g", precision, value);
        if (strtod(digits, NULL) == value)
            return;
    }
}

void scalar_append_number(struct text *text, double value)
{
    char digits[40];
    if (isnan(value)) {
        text_append(text, ".nan");
        return;
    }
    if (isinf(value)) {
        text_append(text, value < 0.0 ? "-.inf" : ".inf");
        return;
    }
    shortest(digits, sizeof digits, value);
    const char *exponent = strchr(digits, 'e');
    if (exponent == NULL || strchr(digits, '.') != NULL)
        text_append(text, "%s", digits);
    else
        text_append(text, "%.*s.0%s", (int)(exponent - digits), digits, exponent);
}

/* Words that YAML 1.1 or 1.2 readers take for something other than a string. */
static bool is_reserved(const char *value)
{
    static const char *const words[] = {"true", "false", "yes", "no",   "on",
                                        "off",  "y",     "n",   "null", NULL};
    for (int i = 0; words[i]; i++)
        if (strcasecmp(value, words[i]) == 0)
            return true;
    return false;
}

/* Whether the value begins with a letter and has only characters without a meaning in
 * YAML; stricter than the grammar. */
static bool is_plain(const char *value)
{
    if (!isalpha((unsigned char)value[0]) && value[0] != '/' && value[0] != '_')
        return false;
    for (const char *c = value; *c; c++)
        if (!isalnum((unsigned char)*c) && strchr("_./+-", *c) == NULL)
            return false;
    return !is_reserved(value);
}

void scalar_append_string(struct text *text, const char *value)
{
    if (is_plain(value)) {
        text_append(text, "%s", value);
        return;
    }
    text_append(text, "\"");
    for (const char *c = value; *c; c++) {
        if (*c == '"' || *c == '\\')
            text_append(text, "\\%c", *c);
        else if ((unsigned char)*c < 0x20 || *c == 0x7f)
            text_append(text, "\\x%02x", (unsigned)*c);
        else
            text_append(text, "%c", *c);
    }
    text_append(text, "\"");
}
